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
from kfmaps.config import BasisConfig, Config, DescriptorConfig, Formulation, NystromConfig, Search, Weights
from kfmaps.io import write_mesh
from kfmaps.kernels.kernels import Gaussian, Laplacian, Linear, Polynomial, kernel_matrix, resolve_kernel
from kfmaps.kernels.transformed import Metric
from kfmaps.matching.match import match
from kfmaps.settings.merge import read_settings, settings_text
from kfmaps.shape import prepare

torch = pytest.importorskip("torch")

from kfmaps.cli.commands import learn as learn_command  # noqa: E402
from kfmaps.fmap.solvers import CG  # noqa: E402
from kfmaps.learn import (  # noqa: E402
    LOSSES,
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
from kfmaps.learn import PARTS as PARTS_OF_MODEL  # noqa: E402
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


def taught(shapes, a, b, config=CONFIG, truth=True, landmarks=2):
    known = partners(a, b)
    marks = np.array([[known[v], v] for v in (5, 120)])[:landmarks]
    sides = (known, np.arange(len(known))) if truth else None
    return training_pair(shapes[a], shapes[b], config, landmarks=marks, truth=sides, samples=40)


@pytest.fixture(scope="module")
def lessons(shapes):
    return [taught(shapes, 0, 1), taught(shapes, 1, 2), taught(shapes, 2, 0)]


PARTS = [("gamma",), ("ard", "terms"), ("metric", "mixture"), ("network", "ard"), ("network", "metric", "terms")]


def shaken(model, size=0.3):
    draw = np.random.default_rng(4)
    with torch.no_grad():
        for p in model.parameters():
            if p.requires_grad:
                p += torch.from_numpy(size * draw.normal(size=tuple(p.shape)))
    return model


@pytest.mark.parametrize("parts", PARTS, ids="+".join)
def test_what_is_learned_is_what_the_settings_say(parts, lessons):
    """The model's kernel matrix is that of the record, whatever the parameters."""
    model = shaken(Model(CONFIG, lessons, parts, rank=3))
    D_s, D_t = lessons[0].descriptors_s, lessons[0].descriptors_t
    with torch.no_grad():
        found = model.kernel_matrix(model.transform(D_t), model.transform(D_s))
    config = model.settings()
    np.testing.assert_allclose(found, kernel_matrix(config.kernel, D_t.numpy(), D_s.numpy()), rtol=1e-10, atol=1e-14)
    assert ("terms" in parts) == (config.weights != CONFIG.weights)


def test_it_begins_as_the_settings_it_was_given(lessons):
    model = Model(CONFIG, lessons[:1], ["gamma", "ard", "terms"])
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
    marks = np.array([[known[v], v] for v in (5, 120)])
    each = training_pair(shapes[0], shapes[1], base, landmarks=marks, samples=200)
    model = shaken(Model(base, [each], ["ard", "terms"]))
    with torch.no_grad():
        C = functional_map(model, each, EXACT)
    config = replace(model.settings(), solver=EXACT, nystrom=NystromConfig(samples=200, rtol=1e-9))
    found = match(shapes[0], shapes[1], config, landmarks=marks)
    np.testing.assert_allclose(C, found.functional_map, atol=2e-4)


@pytest.mark.parametrize("parts", [("gamma", "ard", "terms"), ("metric", "mixture"), ("network",)], ids="+".join)
def test_gradient_of_a_loss_is_its_difference(parts, lessons):
    model = shaken(Model(CONFIG, lessons, parts, rank=3), 0.1)
    options = replace(QUICK, losses={"supervised": 1.0, "orthogonality": 0.3}, solver=EXACT)

    def loss():
        return pair_loss(model, lessons[0], options)

    loss().backward()
    draw, step = np.random.default_rng(1), 1e-5
    learned = [p for p in model.parameters() if p.requires_grad]
    direction = [torch.from_numpy(draw.normal(size=tuple(p.shape))) for p in learned]
    slope = sum(float((p.grad * d).sum()) for p, d in zip(learned, direction, strict=True))
    values = []
    with torch.no_grad():
        for sign in (1, -2):
            for p, d in zip(learned, direction, strict=True):
                p += sign * step * d
            values.append(float(loss()))
    assert (values[0] - values[1]) / (2 * step) == pytest.approx(slope, rel=1e-6)


def test_landmarks_share_their_weights(lessons):
    """Whichever point is the first landmark, what was learned is the same."""
    kinds = _blocks(CONFIG.descriptors, 2, lessons[0].descriptors_s.shape[1])
    assert [kind for kind, _ in kinds].count("landmark") == 2
    assert kinds[-1][1].stop == 10
    kernel = shaken(Model(CONFIG, lessons, ["ard"])).settings().kernel
    assert isinstance(kernel, Metric)
    first, second = (kernel.matrix[block] for kind, block in kinds if kind == "landmark")
    assert first == second


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
    size = np.abs(M).max(axis=0)
    assert size[0] < 0.2 * size[1:].max()
    block = model.blocks[0][1]
    gaps = [
        x.descriptors_s[x.truth.points_s][:, block] - x.descriptors_t[x.truth.points_t][:, block]
        for x in noisy
        if x.truth is not None
    ]
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
    """From a bad start the error falls; the same seed gives the same; stopped and resumed gives the same."""
    poor = replace(CONFIG, kernel=Gaussian(30.0), weights=Weights(1.0, 1.0, 0.01))

    def model():
        return Model(poor, lessons, ["gamma", "ard", "terms"])

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


def test_without_landmarks():
    """A kernel learned from descriptors alone serves the search, whose small fits have other descriptors."""
    config = replace(
        Config.single_fit(),
        basis=BasisConfig(n_eigenfunctions=20),
        descriptors=DescriptorConfig(n_spectral=10, n_eigenfunctions=30, shot=True, shot_radius=0.3),
        nystrom=NystromConfig(samples=40),
        refinement=None,
        search=Search(candidates=1, n_sign_functions=0),
    )
    source, target = (prepare(blob(n, twist), config, name="blob") for n, twist in SIZES[:2])
    each = training_pair(source, target, config, samples=30)
    model = Model(config, [each], ["metric"], rank=3)
    learn(model, [each], [], TrainingOptions({"coupling": 1.0}, epochs=1))
    found = match(source, target, model.settings())
    assert found.target_to_source.shape == (SIZES[1][0],)
    assert isinstance(found.config.kernel, Metric)


def test_patience(lessons):
    """A rate that only does harm stops early, and the start is kept."""
    model = Model(CONFIG, lessons, ["terms"])
    before = model.settings()
    state = learn(model, lessons[:1], lessons[1:2], replace(QUICK, epochs=9, rate=3.0, patience=1))
    assert len(state.history) < 9
    if state.best_epoch.number == 0:
        assert model.settings() == before


@pytest.mark.parametrize("rate", [1e3, 1e5])
def test_a_number_that_is_none_stops_and_keeps_the_best(rate, lessons):
    model = Model(CONFIG, lessons, ["gamma", "ard", "terms"])
    kept = []
    with pytest.raises(NotConverged, match="the best so far, is kept"):
        learn(model, lessons[:2], lessons[2:], replace(QUICK, rate=rate, epochs=20, patience=20), on_epoch=kept.append)
    best = kept[-1].best
    assert all(bool(torch.isfinite(t).all()) for t in best.values())
    torch.testing.assert_close(dict(model.named_parameters())["log_terms"].detach(), best["log_terms"])


@pytest.mark.parametrize("name", LOSSES)
def test_every_loss_has_a_gradient(name, lessons):
    model = Model(CONFIG, lessons, ["gamma", "terms"])
    value = pair_loss(model, lessons[0], replace(QUICK, losses={name: 1.0}))
    value.backward()
    gradient = model.get_parameter("log_terms").grad
    assert float(value.detach()) > 0
    assert gradient is not None
    assert bool(torch.isfinite(gradient).all())
    assert float(gradient.abs().max()) > 0


def test_what_needs_the_truth_says_so(shapes):
    unknown = taught(shapes, 0, 1, truth=False)
    model = Model(CONFIG, [unknown], ["gamma"])
    for name in ("geodesic", "supervised"):
        with pytest.raises(InvalidInput, match=f"loss {name}"):
            pair_loss(model, unknown, replace(QUICK, losses={name: 1.0}))
    with pytest.raises(InvalidInput, match="held-out pairs"):
        point_error(model, unknown, QUICK)
    state = learn(model, [unknown], [unknown], replace(QUICK, losses={"orthogonality": 1.0}, epochs=1))
    assert state.history[-1].loss > 0


@pytest.mark.parametrize("kernel", [Linear(), Polynomial(2, 1.0), Laplacian()])
def test_other_kernels(kernel, shapes):
    config = replace(CONFIG, kernel=kernel)
    each = taught(shapes, 0, 1, config)
    model = Model(config, [each], ["ard", "terms"])
    state = learn(model, [each], [], replace(QUICK, epochs=1))
    assert np.isfinite(state.history[-1].loss)
    assert isinstance(model.settings().kernel, Metric)


@pytest.mark.parametrize(
    ("parts", "kernel"),
    [([], Gaussian()), (["wits"], Gaussian()), (["ard", "metric"], Gaussian()), (["gamma"], Linear())],
)
def test_what_cannot_be_learned(parts, kernel, lessons):
    with pytest.raises(InvalidInput, match="expected"):
        Model(replace(CONFIG, kernel=kernel), lessons, parts)


def test_pairs_must_be_alike(shapes, lessons):
    with pytest.raises(InvalidInput, match="equally many landmarks"):
        Model(CONFIG, [*lessons, taught(shapes, 0, 1, landmarks=1)], ["ard"])
    with pytest.raises(InvalidInput, match="truth of blob"):
        training_pair(shapes[0], shapes[1], CONFIG, truth=(np.arange(30), np.arange(31)))
    with pytest.raises(InvalidInput, match="orientation"):
        taught(shapes, 0, 1, replace(CONFIG, weights=Weights(orientation=1.0)))
    with pytest.raises(InvalidInput, match="quadratic in one map"):
        taught(shapes, 0, 1, replace(CONFIG, formulation=Formulation(constraint="orthogonal")))
    bad: list[dict[str, Any]] = [{"losses": {}}, {"losses": {"wits": 1.0}}, {"rate": 0.0}, {"epochs": 0}]
    bad += [{"seconds": 0.0}]
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


def test_command_without_truth(folder):
    for path in (folder / "data" / "corres").iterdir():
        path.unlink()
    words = (str(folder / "data"), "-o", str(folder / "kernel.pt"), "--set", "descriptors.n_spectral=10")
    small = ("--set", "refinement=none", "--set", "basis.n_eigenfunctions=8", "--set", "descriptors.shot=false")
    small = (*small, "--set", "descriptors.n_eigenfunctions=20", "--training", "pairs=1")
    ran = run("learn", *words, *small, "--held-out", "none", "--training", "epochs=1", "--learn", "gamma")
    assert ran.status == 0, ran.stderr
    learned = read_settings(folder / "kernel.pt", Config.single_fit())
    assert isinstance(learned.kernel, Gaussian)
    assert learned.fit_samples == Config.single_fit().fit_samples  # fewer points are for learning alone


def test_command_refuses(folder):
    words = ("learn", str(folder / "data"), "-o", str(folder / "kernel.toml"))
    assert "--shapes" in run(*words, "--shapes", "cat*").error
    assert "--loss" in run(*words, "--loss", "cycle=much").error
    assert "one of .toml .pt" in run(*words[:-1], str(folder / "kernel.txt")).error
    for wrong in ("epochs=many", "epochs=2.5", "haste=1", "pairs=0"):
        assert "--training" in run(*words, "--training", wrong).error
    assert "--truth-landmarks" in run(*words, "--truth-landmarks", "0,5").error


def test_help_names_what_the_library_has():
    assert learn_command._PARTS.split(", ") == list(PARTS_OF_MODEL)
    assert learn_command._LOSSES.split(", ") == list(LOSSES)
    own = {field.name: field.default for field in fields(TrainingOptions)}
    assert {name: own[name] for name in learn_command.NUMBERS if name in own} == {
        name: value for name, value in learn_command.NUMBERS.items() if name not in ("pairs", "held_out_pairs", "rank")
    }
