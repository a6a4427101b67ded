"""Tables and summary of a collection."""

from __future__ import annotations

import csv
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from collecting import done, plan_of, write_collection
from kfmaps.batch.layout import Pair
from kfmaps.batch.page import PAGE, _error_limit, summary_page
from kfmaps.batch.results import (
    Result,
    all_results,
    read_result,
    result_path,
    summarize,
    worst_first,
    write_csv,
    write_result,
)
from kfmaps.batch.run import run_batch
from serving import Page


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_collection(tmp_path_factory.mktemp("shapes"))


def some_results() -> list[Result]:
    curve = tuple(min(1.0, i / 50) for i in range(101))
    base = Result("a", "b", "done", "s", "i", error_mean=0.02, error_median=0.01, error_max=0.1, curve=curve)
    evil = '<img src=x onerror="alert(1)">'
    return [
        replace(base, seconds={"point map": 1.0, "total": 3.0}, verdict="sure", confidence=0.5, mirrored_mean=0.3),
        replace(base, target=evil, error_mean=0.2, mirrored_mean=0.1, seconds={"total": 5.0}, verdict="ambiguous"),
        Result("c", evil, "failed", "s", "i", reason="<script>alert(2)</script>", notes=("one", "two")),
    ]


def test_tables_have_a_row_a_pair(tmp_path: Path) -> None:
    results = some_results()
    write_csv(tmp_path / "t.csv", results)
    with open(tmp_path / "t.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [r["target"] for r in rows] == [r.target for r in results]
    assert [r["error_mean"] for r in rows] == ["0.02", "0.2", ""]
    assert rows[0]["seconds_point_map"] == "1.0"
    assert rows[2]["notes"] == "one; two"


def test_the_summary_escapes_and_needs_no_network() -> None:
    page = summary_page(
        "<b>name</b>", some_results(), {"seed": "</pre><script>"}, {"<i>a</i>": "data:image/png;base64,cG5n"}, 5
    )
    found = Page(page)
    tags, named = [tag for tag, _ in found.tags], [pair for _, own in found.tags for pair in own.items()]
    assert not any(name.startswith("on") for name, _ in named)
    assert not {"b", "i", "iframe", "link", "object"} & set(tags)
    assert tags.count("script") == 1  # its own, which sorts
    assert "script-src &#39;sha256-" in page
    assert tags.count("img") == 2  # the curve and the picture, not those of names
    addresses = [value or "" for name, value in named if name in ("src", "href", "srcset", "action", "data")]
    assert all(address.startswith(("data:image/", "#")) for address in addresses)
    assert "default-src &#39;none&#39;" in page
    text = " ".join(part for parts in found.text.values() for part in parts)
    for output in ("<b>name</b>", "<script>alert(2)</script>", "2 not done yet", "</pre><script>", "11.00", "1 failed"):
        assert output in text


def test_columns_of_which_nothing_is_known_are_left_out() -> None:
    plain = [replace(r, error_mean=None, error_median=None, error_max=None, mirrored_mean=None) for r in some_results()]
    page = summary_page("c", plain, {}, {}, 3)
    assert "mirrored" not in page
    assert '<th class="n">mean' not in page
    assert "<th>verdict</th>" in page
    assert "geodesic" not in page
    changed = [replace(some_results()[0], changed="alternative 1", why="<why>", error_before=0.4, agreement=0.99)]
    page = summary_page(
        "c", changed, {}, {}, 1, pages={Pair("a", "b"): "pages/a-b.html"}, agreement={"doubted": ["<x> → y"]}
    )
    assert "Replaced maps" in page
    assert "&lt;why&gt;" in page
    assert "40.00" in page
    assert "&lt;x&gt; → y" in page
    assert page.count('href="pages/a-b.html"') == 2


def test_colours_end_where_the_errors_do() -> None:
    base = some_results()[0]
    assert _error_limit([replace(base, error_mean=0.012)]) == pytest.approx(0.04)
    assert _error_limit([replace(base, error_mean=0.012), replace(base, error_mean=0.6)]) == pytest.approx(0.04)
    assert _error_limit([replace(base, error_mean=0.6)]) == pytest.approx(2)
    assert _error_limit([]) is None


def test_numbers_of_the_summary() -> None:
    numbers = summarize(some_results())
    assert [numbers[name] for name in ("done", "failed", "evaluated", "bad", "flipped")] == [2, 1, 2, 1, 1]
    assert numbers["error_mean"] == pytest.approx(0.11)
    assert numbers["seconds_total"] == pytest.approx(8)
    assert numbers["verdicts"] == {"ambiguous": 1, "sure": 1}
    assert [r.error_mean for r in worst_first(some_results())] == [0.2, 0.02]
    unknown = [replace(r, error_mean=None) for r in some_results()]
    assert [r.confidence for r in worst_first(unknown)] == [0.5, None]
    assert summarize([])["error_mean"] is None


def test_outputs_come_from_the_result_files(folder: Path, tmp_path: Path) -> None:
    plan = plan_of(folder, tmp_path)
    done(plan)
    write_result(result_path(tmp_path, "foreign"), Result("x", "y", "done", "of other settings", "i"))
    result_path(tmp_path, "broken").write_text("{")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        again = plan_of(folder, tmp_path)
        assert again.todo == ()
        outcome = run_batch(again, name="c", worst=1)
    assert len(outcome.results) == 6
    assert all_results(tmp_path, plan.spec.digest) == list(outcome.results)
    # A worker killed between writing a result and renaming it leaves the whole text under its temporary name.
    one = next((tmp_path / "pairs").glob("[!.]*.json"))
    (tmp_path / "pairs" / ".unfinished-0123456789ab.json").write_bytes(one.read_bytes())
    assert all_results(tmp_path, plan.spec.digest) == list(outcome.results)
    page = (tmp_path / PAGE).read_text(encoding="utf-8")
    assert page.count("data:image/png;base64,") == 1
    mean = np.mean([float(r.error_mean or 0) for r in outcome.results])
    assert f"{100 * mean:.2f}" in page
    assert read_result(result_path(tmp_path, "broken")) is None
