"""The review of landmarks and the summary of a collection in a real browser."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from chromium import NASTY, Browser, Keys, needs_browser
from kfmaps.batch.page import summary_page
from kfmaps.batch.results import Result
from kfmaps.io import read_mesh
from kfmaps.viz.landmark_review import ReviewServer
from reviewing import N, rows_of

pytest_plugins = ["chromium", "reviewing"]
pytestmark = needs_browser


def test_a_specimen_is_reviewed_in_a_browser(browser: Browser, study: Path, serving: ReviewServer) -> None:
    def flags() -> list[str]:
        return browser.run(
            "return [...document.querySelectorAll('#pairs tbody tr')].map((row) => row.cells[2].textContent)"
        )

    browser.open(serving.address)
    assert "2 of 5 flagged" in browser.text("facts")
    browser.element("#next").click()
    assert browser.text("readout").startswith("b: low confidence")
    browser.element("#accept").click()
    assert browser.text("readout").startswith("e: no counterpart. Click its place on b")
    browser.element("#reset").click()
    mesh = read_mesh(study.parent / "scans" / "b.ply")
    vertex = browser.visible("target", np.arange(N), N)[0]
    browser.point("target", vertex, click=True)
    assert flags() == ["", "checked", "", "", "corrected"]
    browser.element("#view-target").send_keys(Keys.CONTROL, "z")
    assert flags() == ["", "checked", "", "", "no counterpart"]
    browser.point("target", vertex, click=True)
    browser.element("#save").click()
    browser.until(lambda: browser.text("readout").startswith("Saved"))
    row = rows_of(study, "b")["e"]
    off = np.linalg.norm([float(row[axis]) for axis in "xyz"] - mesh.vertices[vertex])
    edges = mesh.vertices[mesh.faces] - mesh.vertices[np.roll(mesh.faces, 1, axis=1)]
    assert off < 0.2 * np.linalg.norm(edges, axis=2).mean()
    assert browser.text("specimen").count("flagged") == 0
    browser.element("#after").click()
    browser.until(lambda: browser.text("name-target") == "c")
    assert browser.complaints() == []
    browser.leave()


COLUMN = (
    "return Array.from(document.querySelectorAll('table.sorts tbody tr')).map(r => r.cells[arguments[0]].textContent)"
)
WIDE = "return document.documentElement.scrollWidth <= window.innerWidth"


def test_tables_sort_by_a_click(browser: Browser, tmp_path: Path) -> None:
    base = Result("s", "t", "done", "d", "i", verdict="sure", seconds={"total": 9.0})
    errors = {"a10": 0.3, "a2": 0.04, NASTY: None}
    results = [replace(base, target=name, error_mean=error) for name, error in errors.items()]
    page = tmp_path / "summary.html"
    page.write_text(summary_page(NASTY, results, {}, {}, 3), encoding="utf-8")
    browser.driver.get_log("browser")
    browser.driver.get(page.as_uri())
    heads = browser.run("return Array.from(document.querySelectorAll('table.sorts th')).map(h => h.textContent)")
    mean, target = heads.index("mean"), heads.index("target")

    def click(column: int) -> list[str]:
        browser.run("document.querySelectorAll('table.sorts th button')[arguments[0]].click()", column)
        return browser.run(COLUMN, column)

    assert click(mean) == ["4.00", "30.00", ""]
    assert click(mean) == ["30.00", "4.00", ""]  # what is not known stays last
    assert browser.run("return document.querySelectorAll('th')[arguments[0]].ariaSort", mean) == "descending"
    assert [name for name in click(target) if name != NASTY] == ["a2", "a10"]
    browser.driver.set_window_size(400, 800)
    assert browser.run(WIDE)
    assert [entry["message"] for entry in browser.driver.get_log("browser")] == []
