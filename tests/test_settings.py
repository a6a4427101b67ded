"""Settings from presets, files, options and --set."""

from __future__ import annotations

import runpy
from dataclasses import is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typer
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from commandline import run
from kfmaps._arrays import InvalidInput
from kfmaps._records import Setting, walk
from kfmaps.config import KINDS, RECORDS, Config, Formulation, NystromConfig, Search, Weights, as_dict, from_dict
from kfmaps.fmap.refine import ICP
from kfmaps.fmap.solvers import CG, Direct
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.kernels.kernels import Gaussian, Laplacian, Linear, Polynomial, Product, Sum, Tanh
from kfmaps.kernels.transformed import Metric
from kfmaps.settings import (
    OPTIONS,
    PRESETS,
    SettingsOptions,
    preset,
    read_settings,
    settings_text,
    with_assignments,
    with_settings,
)

FAR = Config.paper()
"""A base that differs from the recommended settings in most things."""

REACHED: list[tuple[list[str], str, Any]] = [
    (["--kernel", "linear"], "kernel", Linear()),
    (["--kernel", "laplacian", "--set", "kernel.gamma=2.5"], "kernel", Laplacian(2.5)),
    (["--set", "kernel.gamma=7"], "kernel", Gaussian(7.0)),
    (["--set", "kernel.gamma=automatic"], "kernel", Gaussian(None)),
    (["--kernel", "polynomial", "--set", "kernel.degree=4"], "kernel", Polynomial(4, 1.0)),
    (["--set", "kernel={kind='polynomial', degree=4, offset=0.5}"], "kernel", Polynomial(4, 0.5)),
    (["--set", "solver=direct"], "solver", Direct()),
    (["--set", "solver.max_iter=none"], "solver.max_iter", None),
    (["--set", "refinement=none"], "refinement", None),
    (["--set", "refinement.kind=icp", "--set", "refinement.steps=9"], "refinement", ICP(9)),
    (["--set", "refinement=zoomout", "--set", "refinement.samples=all"], "refinement.samples", None),
    (["--set", "registration=none"], "registration", None),
    (["--orientation", "reversing"], "search.orientation", "reversing"),
    (["--partial", "target"], "partial.part", "target"),
    (["--device", "cuda:1"], "device", "cuda:1"),
    (["--threads", "2"], "threads", 2),
    (["--set", "threads=none"], "threads", None),
]

REMOVED = {
    "--exact": "full_kernel",
    "--loss-per": "formulation.loss_group",
    "--refine": "refinement",
    "--samples": "nystrom.samples",
    "--bandwidth": "bandwidth_scale",
    "--solver": "solver",
    "--units": "partial.scale",
    "--zoom-stop": "refinement.stop",
}
"""Options that there were, and the settings that do the same."""


def at(config: Config, path: str) -> Any:
    value: Any = config
    for name in filter(None, path.split(".")):
        value = getattr(value, name)
    return value


def chosen(*words: str, base: Config = FAR) -> Config:
    """The configuration that a command with these options makes of ``base``."""
    seen: list[SettingsOptions] = []
    app = typer.Typer()

    @app.command()
    @with_settings
    def command(settings: SettingsOptions) -> None:
        seen.append(settings)

    result = CliRunner().invoke(app, list(words))
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert seen, result.output
    return seen[0].config(base)


@pytest.mark.parametrize(("words", "path", "value"), REACHED, ids=[" ".join(words) for words, _, _ in REACHED])
def test_option_reaches_the_configuration(words: list[str], path: str, value: Any) -> None:
    found = chosen(*words)
    assert at(found, path) == value
    assert type(at(found, path)) is type(value)


def test_every_option_is_in_that_list() -> None:
    assert {word for words, _, _ in REACHED for word in words if word.startswith("--")} >= set(OPTIONS)


@pytest.mark.parametrize("option", REMOVED)
def test_an_unknown_option_is_answered_with_the_setting(option: str) -> None:
    assert f"--set {REMOVED[option]}=VALUE" in run("match", "a.ply", "b.ply", option, "1").error


def test_no_option_changes_nothing_and_a_preset_is_chosen_by_its_name() -> None:
    for name in PRESETS:
        assert chosen(base=preset(name)) == chosen("--preset", name) == preset(name)
    assert preset("paper") == Config.paper() != preset("default") == Config()


SETTINGS = list(walk(Config, KINDS))


def test_every_setting_is_documented() -> None:
    for path, cls, one in SETTINGS:
        assert one.help, (path, cls)
        assert one.values(KINDS), (path, cls)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("kernel", "gaussian"),
        ("kernel", Gaussian),
        ("basis", 100),
        ("refinement", "icp"),
        ("refinement", None.__class__),
        ("search", {}),
        ("solver", None),
        ("threads", 1.5),
        ("threads", True),
        ("device", 0),
        ("full_kernel", 1),
        ("bandwidth_scale", "0.3"),
        ("bandwidth_scale", float("nan")),
        ("partial", "auto"),
    ],
)
def test_a_field_of_a_wrong_type_is_refused_at_once(field: str, value: Any) -> None:
    with pytest.raises(InvalidInput, match=f"^Config.{field}: expected "):
        replace(Config(), **{field: value})
    with pytest.raises(InvalidInput, match=r"got 'gaussian'\. Write kernel=Gaussian\(\)"):
        Config(kernel="gaussian")  # pyright: ignore[reportArgumentType]


def test_numbers_of_numpy_are_numbers() -> None:
    config = Config(threads=np.int64(2), bandwidth_scale=np.float32(0.5))  # pyright: ignore[reportArgumentType]
    assert type(as_dict(config)["threads"]) is int
    assert from_dict(as_dict(config)) == config


@pytest.mark.parametrize(("path", "cls", "one"), SETTINGS, ids=[f"{p} {c.__name__}" for p, c, _ in SETTINGS])
def test_assignment_reaches_every_setting(path: str, cls: type, one: Setting) -> None:
    section = path.rpartition(".")[0]
    if cls in (Metric, Sum, Product):
        return  # only settings files can say it, see below
    base = Config()
    before = at(base, path) if type(at(base, section)) is cls else one.default
    if one.records(KINDS):
        other = next(kind for kind in reversed(one.records(KINDS)) if kind not in (Metric, Sum, Product))
        value: Any = other.__name__.lower() if not one.optional else "none"
    elif one.choices:
        value = next(choice for choice in one.choices if choice != before)
    else:
        value = {bool: not before, int: 7 if one.high else 37, float: 0.5, str: "cuda"}[one.types[0]]
    chosen = [f"{section}.kind={cls.__name__}"] if cls.__name__ in RECORDS else []
    if path == "refinement.stop":
        chosen.append("refinement.start=2")
    found = at(with_assignments(base, [*chosen, f"{path}={str(value).lower()}"]), path)
    if one.records(KINDS):
        assert (type(found).__name__.lower() if is_dataclass(found) else "none") == value
    else:
        assert found == value


CONFIGS = [
    *(preset(name) for name in PRESETS),
    Config(kernel=Sum(Gaussian(), Product(Linear(), Tanh(2.0, -1.0))), refinement=ICP(3), solver=Direct(100)),
    Config(kernel=Polynomial(3, 0.5), solver=CG(1e-7, None), threads=3, search=Search(2, "reversing"), device="cuda:0"),
    Config(refinement=ZoomOut(10, 20, 2, None), full_kernel=True, weights=Weights(1e-30, 1e20, 0.1 + 0.2, 3)),
    Config(nystrom=NystromConfig(rtol=0.0), kernel=Laplacian(1 / 3)),
    Config(formulation=Formulation("orthogonal", True, 0.3, 2.0, "huber", "feature", 0.7, 1e-3, "resolvent", 0.6)),
    Config(kernel=Metric(Sum(Gaussian(2.0), Linear()), ((1.0, 0.1, 1e-9), (0.1, 1 / 3, 2.0)))),
]


@pytest.mark.parametrize("base", [Config(), CONFIGS[len(PRESETS) + 1]], ids=["default", "another"])
@pytest.mark.parametrize("config", CONFIGS, ids=range(len(CONFIGS)))
def test_settings_file_round_trip(config: Config, base: Config, tmp_path: Path) -> None:
    path = tmp_path / "settings.toml"
    for comments in (True, False):
        path.write_text(settings_text(config, comments), encoding="utf-8")
        found = read_settings(path, base)
        assert found == config
        assert as_dict(found) == as_dict(config)


@given(st.floats(min_value=1e-300, max_value=1e300), st.integers(1, 10**9))
def test_every_digit_is_kept(number: float, whole: int) -> None:
    config = Config(bandwidth_scale=number, kernel=Gaussian(number), threads=whole)
    assert (
        with_assignments(Config(), [f"bandwidth_scale={number!r}", f"kernel.gamma={number!r}", f"threads={whole}"])
        == config
    )


def test_written_settings_say_what_they_mean() -> None:
    text = settings_text(Config.single_fit())
    for path, _, one in SETTINGS:
        if path.partition(".")[0] in ("basis", "descriptors", "nystrom", "weights"):
            assert one.help in text
    assert 'search = "none"' in text
    assert "search among many candidate maps" in text
    with pytest.raises(InvalidInput, match="kernel: expected a record"):
        settings_text(Config(kernel=lambda X, Y: X @ Y.T))


def test_later_wins(tmp_path: Path) -> None:
    """A file over a preset, an option over the file, --set over the option."""
    path = tmp_path / "s.toml"
    path.write_text("bandwidth_scale = 2\n[weights]\nlaplacian = 3\ncommutativity = 4\n[nystrom]\nsamples = 50\n")
    words = "--preset no17 --kernel laplacian --set weights.laplacian=5 --set nystrom.samples=60"
    words += f" --set nystrom.samples=70 --set kernel=linear --config {path}"
    found = chosen(*words.split(), base=Config())
    assert found.kernel == Linear()
    assert (found.bandwidth_scale, found.weights.commutativity, found.weights.laplacian) == (2.0, 4.0, 5.0)
    assert found.nystrom.samples == 70
    assert found == replace(
        Config.no17(),
        bandwidth_scale=2.0,
        weights=Weights(Config.no17().weights.descriptors, 4.0, 5.0, Config.no17().weights.orientation),
        nystrom=replace(Config.no17().nystrom, samples=70),
    )


def test_a_kind_begins_with_the_recommended_numbers() -> None:
    assert FAR.refinement is None
    assert with_assignments(FAR, ["refinement=zoomout"]).refinement == Config().refinement
    recommended = Config().refinement
    assert isinstance(recommended, ZoomOut)
    found = with_assignments(FAR, ["refinement.kind=zoomout", "refinement.step=3"]).refinement
    assert found == replace(recommended, step=3)
    assert with_assignments(Config(solver=Direct()), ["solver=cg"]).solver == Config().solver


WRONG: list[tuple[list[str], str, str]] = [
    (["--set", "basis.n_eigenfunctions=1"], "--set basis.n_eigenfunctions", "at least 2"),
    (["--set", "basis.laplacian=umbrella"], "--set basis.laplacian", "robust, cotangent"),
    (["--kernel", "cubic"], "--kernel", "gaussian"),
    (["--set", "kernel.gamma=-1"], "--set kernel.gamma", "above 0"),
    (["--kernel", "linear", "--set", "kernel.gamma=1"], "--", "no setting"),
    (["--set", "kernel.degree=2"], "--set kernel.degree", "gamma"),
    (["--set", "refinement.kind=icp", "--set", "refinement.stop=90"], "--set refinement", "steps"),
    (
        ["--set", "refinement={kind='zoomout', start=99}", "--set", "refinement.stop=98"],
        "--set refinement",
        "at least 99",
    ),
    (["--set", "solver.max_iter=0"], "--set solver.max_iter", "at least 1"),
    (
        ["--set", "solver.rtol=0", "--set", "solver.max_iter=none"],
        "--set solver.rtol, --set solver.max_iter",
        "a way to stop",
    ),
    (["--set", "search={candidates=-1}"], "--set search", "at least 0"),
    (["--threads", "0"], "--threads", "at least 1"),
    (["--preset", "best"], "--preset", "no17"),
    (
        ["--set", "formulation={loss='huber', loss_group='feature'}", "--set", "full_kernel=true"],
        "--",
        "loss per feature",
    ),
    (["--set", "alpha"], "--set", "NAME=VALUE"),
    (["--set", "=3"], "--set", "NAME=VALUE"),
    (["--set", "weights.alpha=1"], "--set weights.alpha", "descriptors, commutativity, laplacian"),
    (["--set", "weight=1"], "--set weight", "weights"),
    (["--set", "weights.laplacian.x=40"], "--set weights.laplacian.x", "a number"),
    (["--set", "full_kernel=1"], "--set full_kernel", "true or false"),
    (["--set", "basis.n_eigenfunctions=none"], "--set basis.n_eigenfunctions", "a whole number"),
    (["--set", "basis.n_eigenfunctions=50.0"], "--set basis.n_eigenfunctions", "a whole number"),
    (["--set", "bandwidth_scale=inf"], "--set bandwidth_scale", "a number"),
    (["--set", "kernel=sum"], "--set kernel", "kernel.a: expected a value (linear"),
    (["--set", "kernel=7"], "--set kernel", "a table"),
    (["--set", "refinement.kind=CG"], "--set refinement.kind", "icp"),
    (["--set", "refinement.stop=90"], "--set refinement.stop", "zoomout, icp"),
    (["--set", "basis.kind=BasisConfig"], "--set basis.kind", "n_eigenfunctions, laplacian"),
]


@pytest.mark.parametrize(("words", "named", "wanted"), WRONG, ids=[" ".join(words) for words, _, _ in WRONG])
def test_wrong_settings_name_the_option(words: list[str], named: str, wanted: str) -> None:
    with pytest.raises(InvalidInput) as raised:
        chosen(*words)
    text = str(raised.value)
    assert text.startswith(named), text
    assert wanted in text
    assert "\n" not in text


@pytest.mark.parametrize(
    ("content", "wanted"),
    [
        (b"[kernel", "TOML"),
        (b"\xff\xfe", "UTF-8"),
        (b"[kernels]\nkind = 'Gaussian'", "kernels"),
        (b"[weights]\nlaplacian = 'heavy'", "weights.laplacian: expected a number"),
        (b"[[weights]]\nlaplacian = 1", "a table of settings"),
        (b"kernel = {kind = 'callable', name = 'mine'}", "linear, polynomial"),
        (b"[basis]\nn_eigenfunctions = 1", "at least 2"),
        (b"a = " + b"[" * 5000, "TOML"),
    ],
)
def test_wrong_files_are_named(content: bytes, wanted: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_bytes(content)
    with pytest.raises(InvalidInput) as raised:
        chosen("--config", str(path))
    assert str(raised.value).startswith(f"--config {path}: ")
    assert wanted in str(raised.value)
    with pytest.raises(InvalidInput, match=r"--config .*none.toml: expected a settings file"):
        chosen("--config", str(tmp_path / "none.toml"))


def test_document_is_current() -> None:
    """Run ``python docs/_ext/settings_tables.py`` after changing a setting."""
    docs = Path(__file__).parents[1] / "docs"
    text = (docs / "settings.md").read_text(encoding="utf-8")
    assert runpy.run_path(str(docs / "_ext" / "settings_tables.py"))["updated"](text) == text
    for path, _, _ in SETTINGS:
        assert f"`{path}`" in text


@pytest.mark.parametrize("matrix", ["1.0", '["a"]', "[[1.0], 2.0]", "[[[[[[1.0]]]]]]", "[true]", "[]", "[nan]"])
def test_a_metric_that_is_none(matrix: str, tmp_path: Path) -> None:
    path = tmp_path / "settings.toml"
    path.write_text(f'[kernel]\nkind = "metric"\nmatrix = {matrix}\n', encoding="utf-8")
    with pytest.raises(InvalidInput, match=r"(?i)matrix.*expected"):
        read_settings(path, Config())
