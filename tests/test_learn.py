"""Learning: it starts as the settings that it was given, what it learned is what a match then uses, and it resumes."""

import sys
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import KDTree

from commandline import run
from conftest import blob, fibonacci_sphere
from kfmaps._arrays import InvalidInput, MissingDependency, NotConverged
from kfmaps.config import BasisConfig, Config, DescriptorConfig, Formulation, NystromConfig, Weights
from kfmaps.io import write_mesh
from kfmaps.kernels.kernels import Gaussian, Linear, kernel_matrix, resolve_kernel
from kfmaps.kernels.transformed import Metric
from kfmaps.matching.match import match
from kfmaps.settings import read_settings, settings_text
from kfmaps.shape import prepare

torch = pytest.importorskip("torch")

from kfmaps.cli.commands import learn as learn_command  # noqa: E402
from kfmaps.fmap.solvers import CG  # noqa: E402
from kfmaps.learn import PARTS as PARTS_OF_MODEL  # noqa: E402
from kfmaps.learn import (  # noqa: E402
    Model,
    TrainingOptions,
    functional_map,
    learn,
    learning_figure,
    load,
    pair_loss,
    point_error,
    save,
    training_pair,
)
from kfmaps.learn.model import _blocks  # noqa: E402

CONFIG = replace(
    Config.single_fit(),
    basis=BasisConfig(n_eigenfunctions=12),
    descriptors=DescriptorConfig(n_spectral=10, n_eigenfunctions=30, shot=False),
    nystrom=NystromConfig(samples=60),
    operator_rtol=0.0,
    refinement=None,
)
EXACT = CG(rtol=1e-12, max_iter=500)
SIZES = ((150, 0.0), (130, 0.9), (140, 2.0))
QUICK = TrainingOptions(epochs=3, batch=2, patience=3, solver=CG(1e-8, 300), operator_rtol=0.0)


@pytest.fixture(scope="module")
def shapes():
    return [prepare(blob(n, twist), CONFIG, name=f"blob{i}") for i, (n, twist) in enumerate(SIZES)]


def partners(a, b):
    """For each vertex of ``b`` the one of ``a`` that is closest on the sphere that both are bent from."""
    spheres = [fibonacci_sphere(*SIZES[i]).vertices for i in (a, b)]
    return np.asarray(KDTree(spheres[0]).query(spheres[1])[1])


def taught(shapes, a, b, config=CONFIG, landmarks=2, samples=40):
    known = partners(a, b)
    landmark_vertices = np.array([[known[v], v] for v in (5, 120)])[:landmarks]
    sides = (known, np.arange(len(known)))
    return training_pair(shapes[a], shapes[b], config, landmarks=landmark_vertices, truth=sides, samples=samples)


@pytest.fixture(scope="module")
def lessons(shapes):
    return [taught(shapes, 0, 1), taught(shapes, 1, 2), taught(shapes, 2, 0)]


ROWS = {"signature": 3, "landmark": 1}
PARTS = [("gamma",), ("terms",), ("metric", "terms")]


def shaken(model, size=0.3):
    draw = np.random.default_rng(4)
    with torch.no_grad():
        for p in model.parameters():
            if p.requires_grad:
                p += torch.tensor(size * draw.normal(size=tuple(p.shape)))
    return model


@pytest.mark.parametrize("parts", PARTS, ids="+".join)
def test_learned_settings_give_the_kernel_of_the_model(parts, lessons):
    model = shaken(Model(CONFIG, lessons, parts, rank=ROWS))
    D_s, D_t = lessons[0].descriptors_s, lessons[0].descriptors_t
    with torch.no_grad():
        found = model.kernel_matrix(model.transform(D_t), model.transform(D_s))
    config = model.settings()
    np.testing.assert_allclose(found, kernel_matrix(config.kernel, D_t.numpy(), D_s.numpy()), rtol=1e-10, atol=1e-14)
    assert ("terms" in parts) == (config.weights != CONFIG.weights)


def test_it_begins_as_the_settings_it_was_given(lessons):
    model = Model(CONFIG, lessons[:1], ["gamma", "terms"])
    kernel = resolve_kernel(CONFIG.kernel, lessons[0].samples.numpy(), CONFIG.bandwidth_scale)
    D = lessons[0].descriptors_s
    with torch.no_grad():
        np.testing.assert_allclose(model.kernel_matrix(D, D), kernel_matrix(kernel, D.numpy(), D.numpy()), rtol=1e-12)
    assert model.settings().weights.descriptors == pytest.approx(CONFIG.weights.descriptors)


@pytest.mark.parametrize("formulation", [Formulation(), Formulation(mask="resolvent")], ids=["squared", "resolvent"])
def test_the_map_is_that_of_a_match(formulation, shapes):
    """The whole way, with as many samples: descriptors, features, energy, minimiser."""
    base = replace(CONFIG, formulation=formulation)
    known = partners(0, 1)
    landmark_vertices = np.array([[known[v], v] for v in (5, 120)])
    each = taught(shapes, 0, 1, base, samples=200)
    model = shaken(Model(base, [each], ["gamma", "terms"]))
    with torch.no_grad():
        C = functional_map(model, each, EXACT)
    config = replace(model.settings(), solver=EXACT, nystrom=NystromConfig(samples=200, rtol=1e-9))
    found = match(shapes[0], shapes[1], config, landmarks=landmark_vertices)
    np.testing.assert_allclose(C, found.functional_map, atol=2e-4)


@pytest.mark.parametrize("parts", [("gamma", "terms"), ("gamma", "metric", "terms")], ids="+".join)
def test_gradient_of_the_map_is_its_difference(parts, lessons):
    model = shaken(Model(CONFIG, lessons, parts, rank=ROWS), 0.1)

    def loss():
        return ((functional_map(model, lessons[0], EXACT) - 1) ** 2).sum()

    loss().backward()
    draw, step = np.random.default_rng(1), 1e-5
    learned = [p for p in model.parameters() if p.requires_grad]
    direction = [torch.tensor(draw.normal(size=tuple(p.shape))) for p in learned]
    slope = sum(float((p.grad * d).sum()) for p, d in zip(learned, direction, strict=True))
    values = []
    with torch.no_grad():
        for sign in (1, -2):
            for p, d in zip(learned, direction, strict=True):
                p += sign * step * d
            values.append(float(loss()))
    # The direction may be almost one of no change: what the difference is off by goes with the gradient's length.
    length = sum(float((p.grad**2).sum()) for p in learned if p.grad is not None) ** 0.5
    assert (values[0] - values[1]) / (2 * step) == pytest.approx(slope, abs=1e-6 * length)


def test_a_soft_map_becomes_the_map_to_the_nearest(lessons):
    """At a temperature of zero its expected error is the error; its gradient says what to change."""
    model = shaken(Model(CONFIG, lessons, rank=ROWS))
    soft = pair_loss(model, lessons[0], replace(QUICK, temperature=1e-9))
    assert float(soft.detach()) == pytest.approx(point_error(model, lessons[0], QUICK), rel=1e-6)
    pair_loss(model, lessons[0], QUICK).backward()
    for p in model.parameters():
        assert p.grad is not None
        assert 0 < float(p.grad.abs().max()) < float("inf")


def test_metric_starts_where_corresponding_points_agree(lessons):
    """Rows are of unit variance between corresponding points, uncorrelated, and blind to what does not correspond."""
    rng = np.random.default_rng(0)
    noisy = []
    for each in lessons:
        sides = (each.descriptors_s.clone(), each.descriptors_t.clone())
        for D in sides:
            D[:, 0] = torch.from_numpy(rng.normal(size=len(D)))  # the signature's first says nothing
        noisy.append(replace(each, descriptors_s=sides[0], descriptors_t=sides[1]))
    model = Model(CONFIG, noisy, ["metric"], rank={"signature": 3, "landmark": 1})
    M = model.get_parameter("metric_signature").detach().numpy()
    assert M.shape == (3, model.blocks[0][1].stop)
    assert len(model.get_parameter("metric_landmark")) == 1
    kernel = model.settings().kernel
    assert isinstance(kernel, Metric)
    whole = np.array(kernel.matrix)
    first, second = (block for kind, block in model.blocks if kind == "landmark")
    np.testing.assert_array_equal(whole[3, first], whole[4, second])  # whichever point is the first landmark
    size = np.abs(M).max(axis=0)
    assert size[0] < 0.2 * size[1:].max()
    block = model.blocks[0][1]
    gaps = [x.descriptors_s[x.points_s][:, block] - x.descriptors_t[x.points_t][:, block] for x in noisy]
    between = M @ np.mean([(g.T @ g).numpy() / len(g) for g in gaps], axis=0) @ M.T
    # with the ridge, the same number for all rows, they are of unit variance and uncorrelated
    ridge = (1 - between[0, 0]) / (M @ M.T)[0, 0]
    assert ridge > 0
    np.testing.assert_allclose(between + ridge * M @ M.T, np.eye(3), atol=1e-8)
    with pytest.raises(InvalidInput, match="rows for landmark"):
        Model(CONFIG, noisy, ["metric"], rank={"signature": 3})


def test_the_rate_falls_to_zero(lessons):
    """As half a cosine: at step n of six, one an epoch, it is 0.15 (1 + cos(π n / 6))."""
    rates: list[float] = []
    many = replace(QUICK, epochs=6, batch=4, patience=9, rate=0.3)
    learn(
        Model(CONFIG, lessons, ["gamma"]),
        lessons,
        [],
        many,
        on_epoch=lambda state: rates.append(state.optimizer["param_groups"][0]["lr"]),
    )
    np.testing.assert_allclose(rates[1:], 0.15 * (1 + np.cos(np.pi * np.arange(6) / 6)), rtol=1e-12)


def test_columns_of_every_kind():
    config = DescriptorConfig(n_spectral=20)
    found = _blocks(config, 3, 20 + 352)
    assert [kind for kind, _ in found] == ["signature", "landmark", "landmark", "landmark", "shot"]
    assert found[-1][1] == slice(20, 372)
    assert [kind for kind, _ in _blocks(replace(config, signature="none"), 0, 352)] == ["shot"]
    nth = DescriptorConfig(n_spectral=20, energy_sampling="every-nth", shot=False)
    assert [kind for kind, _ in _blocks(nth, 3, 20)] == ["signature"]


def test_it_learns_stops_and_resumes_alike(lessons, tmp_path):
    poor = replace(CONFIG, kernel=Gaussian(30.0), weights=Weights(1.0, 1.0, 0.01))

    def model():
        return Model(poor, lessons, ["gamma", "metric", "terms"])

    whole = learn(model(), lessons[:2], lessons[2:], QUICK)
    assert whole.history[-1].loss < whole.history[0].loss
    assert whole.best_epoch.held_out <= whole.history[0].held_out
    again = model()
    kept = []
    first = learn(again, lessons[:2], lessons[2:], replace(QUICK, epochs=1), on_epoch=kept.append)
    assert [state.history[-1].number for state in kept] == [0, 1]
    file = tmp_path / "state.pt"
    save(file, first, settings_text(again.settings()), {"seed": 0})
    loaded, text, request = load(file)
    assert request == {"seed": 0}
    assert 'kind = "Metric"' in text
    resumed = model()
    rest = learn(resumed, lessons[:2], lessons[2:], QUICK, state=loaded)
    for a, b in zip(whole.history, rest.history, strict=True):
        assert (a.number, a.loss, a.held_out) == (b.number, b.loss, b.held_out)
    for name, tensor in whole.best.items():
        torch.testing.assert_close(rest.best[name], tensor, rtol=0, atol=0)
        torch.testing.assert_close(dict(resumed.named_parameters())[name].detach(), tensor, rtol=0, atol=0)
    assert len(learning_figure(rest.history).axes) == 2


def test_patience(lessons):
    model = Model(CONFIG, lessons, ["terms"])
    before = model.settings()
    state = learn(model, lessons[:1], lessons[1:2], replace(QUICK, epochs=9, rate=3.0, patience=1))
    assert len(state.history) < 9
    if state.best_epoch.number == 0:
        assert model.settings() == before


@pytest.mark.parametrize("rate", [1e3, 1e5])
def test_a_number_that_is_none_stops_and_keeps_the_best(rate, lessons):
    model = Model(CONFIG, lessons, ["gamma", "metric", "terms"])
    kept = []
    with pytest.raises(NotConverged, match="the best so far, is kept"):
        learn(model, lessons[:2], lessons[2:], replace(QUICK, rate=rate, epochs=20, patience=20), on_epoch=kept.append)
    best = kept[-1].best
    assert all(bool(torch.isfinite(t).all()) for t in best.values())
    torch.testing.assert_close(dict(model.named_parameters())["log_terms"].detach(), best["log_terms"])


def test_pairs_must_be_alike(shapes, lessons):
    with pytest.raises(InvalidInput, match="equally many landmarks"):
        Model(CONFIG, [*lessons, taught(shapes, 0, 1, landmarks=1)])
    with pytest.raises(InvalidInput, match="truth of blob"):
        training_pair(shapes[0], shapes[1], CONFIG, truth=(np.arange(30), np.arange(31)))
    with pytest.raises(InvalidInput, match="orientation"):
        taught(shapes, 0, 1, replace(CONFIG, weights=Weights(orientation=1.0)))
    with pytest.raises(InvalidInput, match="quadratic in one map"):
        taught(shapes, 0, 1, replace(CONFIG, formulation=Formulation(constraint="orthogonal")))
    for parts in ([], ["wits"]):
        with pytest.raises(InvalidInput, match="what to learn"):
            Model(CONFIG, lessons, parts)
    with pytest.raises(InvalidInput, match="kernel to learn"):
        Model(replace(CONFIG, kernel=Linear()), lessons)
    bad: list[dict[str, Any]] = [{"rate": 0.0}, {"epochs": 0}, {"seconds": 0.0}]
    for wrong in bad:
        with pytest.raises(InvalidInput, match="expected"):
            TrainingOptions(**wrong)


class Harmful:
    def __reduce__(self):
        return (print, ("executed",))


def test_a_file_never_runs_anything(tmp_path, capsys):
    file = tmp_path / "kernel.pt"
    torch.save({"format": 1, "settings": Harmful()}, file)
    for read in (load, lambda path: read_settings(path, Config.single_fit())):
        with pytest.raises(InvalidInput, match="expected a file that kfmaps learn wrote"):
            read(file)
    assert "executed" not in capsys.readouterr().out
    file.write_bytes(b"nothing")
    with pytest.raises(InvalidInput, match="expected a file that kfmaps learn wrote"):
        load(file)
    torch.save({"format": 99}, file)
    with pytest.raises(InvalidInput, match="another content"):
        load(file)
    with pytest.raises(InvalidInput, match="expected a file"):
        load(tmp_path / "missing.pt")


WORDS = (
    *("--set", "basis.n_eigenfunctions=12", "--set", "descriptors.n_spectral=10"),
    *("--set", "descriptors.n_eigenfunctions=30", "--set", "nystrom.samples=60"),
    *("--truth-landmarks", "6,121", "--training", "pairs=2", "--training", "held_out_pairs=1"),
    *("--set", "refinement=none"),
    *("--shapes", "blob*", "--held-out", "blob0,blob1"),
)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "data" / "corres").mkdir(parents=True)
    base = fibonacci_sphere(180).vertices
    for i, (n, twist) in enumerate((*SIZES, (120, 1.0))):
        write_mesh(tmp_path / "data" / f"blob{i}.ply", blob(n, twist))
        near = np.asarray(KDTree(fibonacci_sphere(n, twist).vertices).query(base)[1]) + 1
        (tmp_path / "data" / "corres" / f"blob{i}.vts").write_text("\n".join(str(v) for v in near))
    return tmp_path


def test_command(folder, monkeypatch):
    out = folder / "kernel.toml"
    words = ("learn", str(folder / "data"), "-o", str(out), *WORDS, "--training")
    ran = run(*words, "epochs=1")
    assert ran.status == 0, ran.stderr
    assert "held-out pairs" in ran.stdout
    assert sorted(p.name for p in folder.iterdir()) == ["data", "kernel.png", "kernel.pt", "kernel.toml"]
    first = load(folder / "kernel.pt")[0]
    assert run(*words, "epochs=2", "-q").status == 0
    second = load(folder / "kernel.pt")[0]
    assert second.history[:2] == first.history
    assert len(second.history) == 3
    assert "another --training" in run(*words, "rate=0.01").stderr
    config = read_settings(folder / "kernel.pt", Config.single_fit())
    monkeypatch.setitem(sys.modules, "torch", None)
    assert read_settings(out, Config.single_fit()) == config  # without PyTorch
    assert isinstance(config.kernel, Metric)
    with pytest.raises(MissingDependency, match=r"kfmaps\[learn\]"):
        read_settings(folder / "kernel.pt", Config.single_fit())
    (folder / "kernel.pt").unlink()
    assert "a new file" in run(*words, "epochs=1").error


def test_command_refuses(folder):
    marked = ("--truth-landmarks", "6,121")
    words = ("learn", str(folder / "data"), "-o", str(folder / "kernel.toml"), *marked)
    assert "--shapes" in run(*words, "--shapes", "cat*").error
    assert "one of .toml .pt" in run(*words[:3], str(folder / "kernel.txt"), *marked).error
    for wrong in ("epochs=many", "epochs=2.5", "haste=1", "pairs=0"):
        assert "--training" in run(*words, "--training", wrong).error
    assert "--truth-landmarks" in run(*words[:4]).error
    alike = ("--shapes", "blob0,blob1", "--held-out", "none", "--truth-landmarks")
    for lines in ("0,5", "1,200"):
        assert "--truth-landmarks" in run(*words, *alike, lines).error
    (folder / "data" / "corres" / "blob0.vts").unlink()
    assert "truth of blob0: expected a list" in run(*words, *alike, "1").error


def test_help_names_what_the_library_has():
    assert tuple(learn_command._PARTS.split(",")) == PARTS_OF_MODEL
    own = {field.name: field.default for field in fields(TrainingOptions)}
    named = {name: value for name, value in learn_command.NUMBERS.items() if name not in ("pairs", "held_out_pairs")}
    assert {name: own[name] for name in named} == named
