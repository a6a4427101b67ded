"""Settings from presets, files, options and --set."""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import pytest
import typer
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from kfmaps._arrays import InvalidInput
from kfmaps.config import RECORDS, Config, Formulation, NystromConfig, Search, Weights, as_dict
from kfmaps.fmap.refine import ICP, ZoomOut
from kfmaps.fmap.solvers import CG, Direct
from kfmaps.kernels.kernels import Gaussian, Laplacian, Linear, Polynomial, Product, Sum, Tanh
from kfmaps.kernels.transformed import KERNELS, Metric, Network, Scaled
from kfmaps.registration.nonrigid_icp import NonRigid
from kfmaps.settings.catalogue import FLAGS, PRESETS, SETTINGS
from kfmaps.settings.document import updated
from kfmaps.settings.merge import preset, read_settings, with_assignments, with_flags
from kfmaps.settings.options import Chosen, with_settings
from kfmaps.settings.toml import settings_text

GUARDS = ("kfmaps.config",)

FAR = Config.paper()
"""A base that differs from the recommended settings in most things."""

REACHED: list[tuple[list[str], str, Any]] = [
    (["--basis", "61"], "basis.functions", 61),
    (["--laplacian", "cotangent"], "basis.laplacian", "cotangent"),
    (["--descriptors", "17"], "descriptors.count", 17),
    (["--signature", "heat"], "descriptors.signature", "heat"),
    (["--landmark-map", "none"], "descriptors.landmark_map", "none"),
    (["--shot"], "descriptors.shot", True),
    (["--no-shot"], "descriptors.shot", False),
    (["--normalisation", "norm"], "descriptors.normalisation", "norm"),
    (["--kernel", "linear"], "kernel", Linear()),
    (["--kernel", "laplacian", "--gamma", "2.5"], "kernel", Laplacian(2.5)),
    (["--gamma", "7"], "kernel", Gaussian(7.0)),
    (["--gamma", "automatic"], "kernel", Gaussian(None)),
    (["--sharpness", "0.7"], "sharpness", 0.7),
    (["--degree", "4"], "kernel", Polynomial(4, 1.0)),
    (["--degree", "4", "--offset", "0.5"], "kernel", Polynomial(4, 0.5)),
    (["--kernel", "tanh", "--offset", "-0.5"], "kernel", Tanh(1.0, -0.5)),
    (["--scale", "3"], "kernel", Tanh(3.0, 0.0)),
    (["--exact"], "exact", True),
    (["--no-exact"], "exact", False),
    (["--samples", "60"], "nystrom.samples", 60),
    (["--sampling", "cholesky"], "nystrom.sampling", "cholesky"),
    (["--alpha", "0.25"], "weights.laplacian", 0.25),
    (["--weight-descriptors", "9"], "weights.descriptors", 9.0),
    (["--weight-commutativity", "0"], "weights.commutativity", 0.0),
    (["--weight-orientation", "0.5"], "weights.orientation", 0.5),
    (["--constraint", "orthogonal"], "formulation.constraint", "orthogonal"),
    (["--directions", "both"], "formulation.directions", "both"),
    (["--loss", "huber"], "formulation.loss", "huber"),
    (["--loss", "l21", "--loss-per", "descriptor"], "formulation.loss_per", "descriptor"),
    (["--sparsity", "0.1"], "formulation.sparsity", 0.1),
    (["--spatial", "0.1"], "formulation.spatial", 0.1),
    (["--mask", "resolvent"], "formulation.mask", "resolvent"),
    (["--bases", "coupled"], "formulation.bases", "coupled"),
    (["--solver", "direct"], "solver", Direct()),
    (["--rtol", "1e-3"], "solver.rtol", 1e-3),
    (["--max-steps", "44"], "solver.max_steps", 44),
    (["--max-steps", "none"], "solver.max_steps", None),
    (["--preconditioner", "jacobi"], "preconditioner", "jacobi"),
    (["--refine", "none"], "refinement", None),
    (["--refine", "icp", "--icp-steps", "9"], "refinement", ICP(9)),
    (["--icp-steps", "9"], "refinement", ICP(9)),
    (["--zoom-start", "30"], "refinement.start", 30),
    (["--zoom-stop", "90"], "refinement.stop", 90),
    (["--zoom-start", "250", "--zoom-stop", "300"], "refinement.stop", 300),
    (["--zoom-step", "3"], "refinement.step", 3),
    (["--zoom-samples", "500"], "refinement.samples", 500),
    (["--zoom-samples", "all"], "refinement.samples", None),
    (["--finish", "none"], "finish", None),
    (["--candidates", "3"], "search.candidates", 3),
    (["--orientation", "reversed"], "search.orientation", "reversed"),
    (["--partial", "target"], "partial.which", "target"),
    (["--units", "same"], "partial.units", "same"),
    (["--device", "cuda:1"], "device", "cuda:1"),
    (["--threads", "2"], "threads", 2),
    (["--threads", "none"], "threads", None),
]


def at(config: Config, path: str) -> Any:
    value: Any = config
    for name in path.split("."):
        value = getattr(value, name)
    return value


def chosen(*words: str, base: Config = FAR) -> Config:
    """The configuration that a command with these options makes of ``base``."""
    seen: list[Chosen] = []
    app = typer.Typer()

    @app.command()
    @with_settings
    def command(settings: Chosen) -> None:
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
    assert {word for words, _, _ in REACHED for word in words if word.startswith("--")} >= set(FLAGS)


def test_no_option_changes_nothing() -> None:
    for name in PRESETS:
        assert chosen(base=preset(name)) == preset(name)


def paths(record: type) -> set[str]:
    """What a record's settings are called, kinds aside."""
    return {f.name for f in fields(record)}


def test_the_catalogue_knows_every_setting() -> None:
    """A new field must be added to settings/catalogue.py, and one that is gone taken out."""
    sections = {"basis", "descriptors", "nystrom", "weights", "formulation", "partial"}
    unions = {
        "kernel": KERNELS,
        "solver": (CG, Direct),
        "refinement": (ZoomOut, ICP),
        "finish": (NonRigid,),
        "search": (Search,),
    }
    wanted = paths(Config) - sections - unions.keys()
    for section in sections:
        wanted |= {f"{section}.{name}" for name in paths(type(getattr(Config(), section)))}
    for section, records in unions.items():
        wanted |= {f"{section}.kind", *(f"{section}.{name}" for record in records for name in paths(record))}
    assert {s.path for s in SETTINGS} == wanted
    for setting in SETTINGS:
        having = {k for k, r in RECORDS.items() if setting.field in paths(r) and r in unions.get(setting.section, ())}
        assert set(setting.kinds) == having, setting.path


INSIDE = ("a", "b", "kernel", "matrix", "landmarks", "layers", "columns")
"""What only settings files can say."""


@pytest.mark.parametrize("path", [s.path for s in SETTINGS if s.field not in INSIDE])
def test_assignment_reaches_every_setting(path: str) -> None:
    """A value unlike the one before is found where it was put."""
    setting = next(s for s in SETTINGS if s.path == path)
    base = Config()
    words = {
        "kernel.kind": "tanh",
        "solver.kind": "direct",
        "refinement.kind": "icp",
        "finish.kind": "none",
        "search.kind": "none",
        "basis.laplacian": "cotangent",
        "descriptors.signature": "heat",
        "descriptors.landmark_map": "heat",
        "descriptors.layout": "every-nth",
        "descriptors.normalisation": "row",
        "nystrom.sampling": "uniform",
        "formulation.constraint": "orthogonal",
        "formulation.directions": "both",
        "formulation.loss": "geman",
        "formulation.loss_per": "feature",
        "formulation.mask": "resolvent",
        "formulation.bases": "coupled",
        "preconditioner": "none",
        "search.orientation": "reversed",
        "search.signs": 7,
        "partial.which": "both",
        "partial.units": "same",
        "device": "cuda",
    }
    value: Any = (
        words.get(path) or {int: 37, float: 0.5, bool: not at(base, path) if setting.type is bool else 0}[setting.type]
    )
    texts = [f"{path}={str(value).lower()}"]
    if setting.kinds:
        texts = [f"{setting.section}.kind={setting.kinds[0]}", *texts]
    if path == "refinement.stop":
        texts.append("refinement.start=2")
    found = with_assignments(base, texts)
    if path.endswith(".kind"):
        record = at(found, setting.section)
        assert (type(record).__name__.lower() if is_dataclass(record) else "none") == value
    else:
        assert at(found, path) == value


CONFIGS = [
    *(preset(name) for name in PRESETS),
    Config(kernel=Sum(Gaussian(), Product(Linear(), Tanh(2.0, -1.0))), refinement=ICP(3), solver=Direct(100)),
    Config(kernel=Polynomial(3, 0.5), solver=CG(1e-7, None), threads=3, search=Search(2, "reversed"), device="cuda:0"),
    Config(refinement=ZoomOut(10, 20, 2, None), exact=True, weights=Weights(1e-30, 1e20, 0.1 + 0.2, 3)),
    Config(nystrom=NystromConfig(rtol=0.0), kernel=Laplacian(1 / 3)),
    Config(formulation=Formulation("orthogonal", "both", 0.3, 2.0, "huber", "feature", 0.7, 1e-3, "resolvent", 0.6)),
    Config(kernel=Metric(Sum(Gaussian(2.0), Scaled(Gaussian(0.1), 1 / 3)), (1.0, 0.1, 1e-9))),
    Config(kernel=Metric(Network(Gaussian(), (((1.0, 2.0, 3.0),), ((0.5, 0.1),)), (0,)), ((1.0, 2.0), (0.1, 1 / 3)))),
]


@pytest.mark.parametrize("base", [Config(), CONFIGS[len(PRESETS) + 1]], ids=["default", "another"])
@pytest.mark.parametrize("config", CONFIGS, ids=range(len(CONFIGS)))
def test_settings_file_round_trip(config: Config, base: Config, tmp_path: Path) -> None:
    """What is written is read back identically, whatever it is laid over."""
    path = tmp_path / "settings.toml"
    for comments in (True, False):
        path.write_text(settings_text(config, comments), encoding="utf-8")
        found = read_settings(path, base)
        assert found == config
        assert as_dict(found) == as_dict(config)


@given(st.floats(min_value=1e-300, max_value=1e300), st.integers(1, 10**9))
def test_every_digit_is_kept(number: float, whole: int) -> None:
    config = Config(sharpness=number, kernel=Gaussian(number), threads=whole)
    assert (
        with_assignments(Config(), [f"sharpness={number!r}", f"kernel.gamma={number!r}", f"threads={whole}"]) == config
    )


def test_written_settings_say_what_they_mean() -> None:
    text = settings_text(Config.single_fit())
    for setting in SETTINGS:
        if setting.section in ("basis", "descriptors", "nystrom", "weights"):
            assert setting.meaning in text
    assert 'search = "none"' in text
    assert "whether several maps are tried" in text


def test_later_wins(tmp_path: Path) -> None:
    """A file over a preset, an option over the file, --set over the option."""
    path = tmp_path / "s.toml"
    path.write_text("sharpness = 2\n[weights]\nlaplacian = 3\ncommutativity = 4\n[nystrom]\nsamples = 50\n")
    words = [
        "--preset",
        "no17",
        "--config",
        str(path),
        "--alpha",
        "5",
        "--samples",
        "60",
        "--set",
        "nystrom.samples=70",
    ]
    found = chosen(*words, base=Config())
    assert found.kernel == Linear()
    assert (found.sharpness, found.weights.commutativity, found.weights.laplacian) == (2.0, 4.0, 5.0)
    assert found.nystrom.samples == 70
    assert found == replace(
        Config.no17(),
        sharpness=2.0,
        weights=Weights(Config.no17().weights.descriptors, 4.0, 5.0, Config.no17().weights.orientation),
        nystrom=replace(Config.no17().nystrom, samples=70),
    )


def test_presets() -> None:
    assert chosen("--paper") == chosen("--preset", "paper") == Config.paper()
    assert chosen("--preset", "obcs12") == Config.obcs12()
    assert chosen("--preset", "single-fit") == Config.single_fit()
    assert chosen("--preset", "default") == Config()
    assert chosen("--paper", "--preset", "paper") == Config.paper()


def test_a_kind_begins_with_the_recommended_numbers() -> None:
    assert FAR.refinement is None
    assert with_flags(FAR, {"--refine": "zoomout"}).refinement == Config().refinement
    recommended = Config().refinement
    assert isinstance(recommended, ZoomOut)
    assert with_flags(FAR, {"--zoom-step": 3}).refinement == replace(recommended, step=3)
    assert with_assignments(Config(solver=Direct()), ["solver=cg"]).solver == Config().solver


WRONG: list[tuple[list[str], str, str]] = [
    (["--basis", "1"], "--basis", "at least 2"),
    (["--laplacian", "umbrella"], "--laplacian", "robust, cotangent"),
    (["--kernel", "cubic"], "--kernel", "gaussian"),
    (["--gamma", "-1"], "--gamma", "above zero"),
    (["--gamma", "wide"], "--gamma", "a number"),
    (["--kernel", "linear", "--gamma", "1"], "--gamma", "gaussian or laplacian"),
    (["--degree", "2", "--gamma", "1"], "--gamma and --degree", "go together"),
    (["--offset", "1"], "--offset", "--kernel"),
    (["--refine", "none", "--zoom-stop", "90"], "--zoom-stop", "--refine zoomout"),
    (["--refine", "icp", "--zoom-stop", "90"], "--zoom-stop", "--refine zoomout"),
    (["--zoom-start", "99", "--zoom-stop", "98"], "--zoom-st", "at least 99"),
    (["--max-steps", "0"], "--max-steps", "at least 1"),
    (["--max-steps", "1.5"], "--max-steps", "a whole number"),
    (["--rtol", "0", "--max-steps", "none"], "--rtol, --max-steps", "a way to stop"),
    (["--alpha", "nan"], "--alpha", "a number"),
    (["--candidates", "0"], "--candidates", "at least 1"),
    (["--threads", "0"], "--threads", "at least 1"),
    (["--preset", "best"], "--preset", "no17"),
    (["--paper", "--preset", "no17"], "--paper", "one preset"),
    (["--alpha", "-1", "--basis", "50"], "--alpha", "at least zero"),
    (["--loss", "cubic"], "--loss", "huber"),
    (["--loss", "huber", "--loss-per", "feature", "--exact"], "--", "loss per feature"),
    (["--sparsity", "-1"], "--sparsity", "at least zero"),
    (["--set", "alpha"], "--set", "NAME=VALUE"),
    (["--set", "=3"], "--set", "NAME=VALUE"),
    (["--set", "weights.alpha=1"], "--set weights.alpha", "descriptors, commutativity, laplacian"),
    (["--set", "weight=1"], "--set weight", "weights"),
    (["--set", "basis=40"], "--set basis", "a table"),
    (["--set", "weights.laplacian.x=40"], "--set weights.laplacian.x", "a number"),
    (["--set", "exact=1"], "--set exact", "true or false"),
    (["--set", "basis.functions=none"], "--set basis.functions", "a whole number"),
    (["--set", "basis.functions=50.0"], "--set basis.functions", "a whole number"),
    (["--set", "sharpness=inf"], "--set sharpness", "a number"),
    (["--set", "kernel=sum"], "--set kernel", "a kernel"),
    (["--set", "kernel.kind=ZoomOut"], "--set kernel.kind", "gaussian"),
    (["--set", "kernel=7"], "--set kernel", "a table"),
    (["--set", "refinement.kind=CG"], "--set refinement.kind", "icp"),
    (["--set", "refinement.stop=90"], "--set refinement.stop", "icp, zoomout"),
    (["--set", "basis.kind=BasisConfig"], "--set basis.kind", "functions, laplacian"),
    (["--set", "solver=none"], "--set solver", "cg"),
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
        (b"[weights]\nlaplacian = 'heavy'", "weights.laplacian: wanted a number"),
        (b"[[weights]]\nlaplacian = 1", "a table of settings"),
        (b"kernel = {kind = 'callable', name = 'mine'}", "linear, polynomial"),
        (b"[basis]\nfunctions = 1", "at least 2"),
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


def test_missing_file(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match=r"--config .*none.toml: wanted a settings file"):
        chosen("--config", str(tmp_path / "none.toml"))


def test_document_is_current() -> None:
    """Run ``python -m kfmaps.settings.document docs/settings.md`` after changing a setting."""
    text = (Path(__file__).parents[1] / "docs" / "settings.md").read_text(encoding="utf-8")
    assert updated(text) == text
    for setting in SETTINGS:
        assert f"`{setting.path}`" in text


@pytest.mark.parametrize("matrix", ["1.0", '["a"]', "[[1.0], 2.0]", "[[[[[[1.0]]]]]]", "[true]", "[]", "[nan]"])
def test_a_metric_that_is_none(matrix: str, tmp_path: Path) -> None:
    path = tmp_path / "settings.toml"
    path.write_text(f'[kernel]\nkind = "metric"\nmatrix = {matrix}\n', encoding="utf-8")
    with pytest.raises(InvalidInput, match=r"(?i)matrix.*wanted"):
        read_settings(path, Config())
