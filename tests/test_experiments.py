"""The experiments on tiny generated shapes, and the parts that their conclusions rest on."""

import csv
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import experiment
import figure2
import figure3
import figure4
import figure5
import figure6
import figure7
import formulation_pairs
import formulations
import pair_errors
import run
import section44
import tune
from data_sets import DataSet, find_data_sets, person
from experiment import Options, Result
from intervals import difference, ratio
from kernel_matrix import best_errors, gaussian_matrix, nystrom_error
from kfmaps._arrays import InvalidInput
from kfmaps.config import BasisConfig, Config, NystromConfig
from kfmaps.fmap.evaluate import geodesic_errors
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.basis import Basis
from kfmaps.kernels.kernels import Gaussian
from kfmaps.settings import read_settings, settings_text
from methods import no17, obcs12, paper, recommended
from pair_errors import Row, fingerprint, fit_pair, pair_rows, raw_map
from section44 import conditioning
from store import Job, read_store, run_jobs

SMALL = DataSet("generated", vertices=1500)
PAIR = ("poses-2-source", "poses-2-target")


def small(config: Config) -> Config:
    """The same settings at a size that takes a moment."""
    return replace(
        config,
        basis=replace(config.basis, n_eigenfunctions=20),
        descriptors=replace(config.descriptors, n_eigenfunctions=40),
        nystrom=replace(config.nystrom, samples=30),
        refinement=None,
    )


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


# The store


class Work:
    """Counts its calls, and is interrupted at one of them."""

    def __init__(self, stop: int | None = None) -> None:
        self.done: list[int] = []
        self.stop = stop

    def __call__(self, number: int) -> list[int]:
        if number == self.stop:
            raise KeyboardInterrupt
        self.done.append(number)
        return [number, number**2]


def square_jobs(work: Work) -> list[Job]:
    return [Job((f"{i}", f"{i} squared"), work, (i,)) for i in range(5)]


def test_stopped_run_continues_and_redoes_nothing(tmp_path: Path) -> None:
    store = tmp_path / "store.jsonl"
    first, second, third = Work(stop=3), Work(), Work()
    with pytest.raises(KeyboardInterrupt):
        run_jobs(square_jobs(first), store, workers=1)
    assert first.done == [0, 1, 2]
    assert read_store(store)["2 squared"] == 4
    with store.open("a", encoding="utf-8") as file:
        file.write('\n{"key": "3", "val')  # a crash in the middle of a line
    found = run_jobs(square_jobs(second), store, workers=1)
    assert second.done == [3, 4]
    assert found == {f"{i}": i for i in range(5)} | {f"{i} squared": i**2 for i in range(5)}
    assert run_jobs(square_jobs(third), store, workers=1) == found
    assert third.done == []


def test_processes_give_the_same(tmp_path: Path) -> None:
    jobs = [Job((f"{i} div", f"{i} mod"), divmod, (i, 3)) for i in range(6)]
    alone = run_jobs(jobs, tmp_path / "alone.jsonl", workers=1)
    assert run_jobs(jobs, tmp_path / "many.jsonl", workers=2) == alone
    assert alone["5 mod"] == 2
    assert read_store(tmp_path / "many.jsonl") == alone


# Statistics


def test_interval_is_paired() -> None:
    a = np.random.default_rng(0).normal(size=50)
    same = difference(a + 1, a)
    np.testing.assert_allclose([same.value, same.low, same.high], 1.0)
    twice = ratio(2 * np.exp(a), np.exp(a))
    np.testing.assert_allclose([twice.value, twice.low, twice.high], 2.0)
    with pytest.raises(InvalidInput, match="same pairs"):
        difference(a, a[:2])


def test_interval_of_two_pairs_spans_all_resamples() -> None:
    # Differences 0 and 4: the means of their resamples are 0, 2, 2, 4.
    found = difference(np.array([5.0, 9.0]), np.array([5.0, 5.0]))
    assert (found.value, found.low, found.high) == (2.0, 0.0, 4.0)
    alone = difference(np.array([5.0]), np.array([2.0]))
    assert (alone.value, alone.low, alone.high) == (3.0, 3.0, 3.0)


# Data sets


def fake_data(folder: Path, layout: str, people: int) -> Path:
    (folder / layout).mkdir(parents=True)
    for i in range(10 * people):
        (folder / layout / f"tr_reg_{i:03d}.ply").touch()
    return folder / layout


def test_reported_pairs_have_no_training_person(tmp_path: Path) -> None:
    fake_data(tmp_path, "FAUST", 4)
    remeshed = fake_data(tmp_path, "FAUST_r", 8)
    listed = [("tr_reg_005", "tr_reg_071"), ("tr_reg_022", "tr_reg_031"), ("tr_reg_040", "tr_reg_019")]
    (remeshed / "test_pairs.txt").write_text("\n".join(" ".join(pair) for pair in listed), encoding="utf-8")
    faust, faust_r = find_data_sets(tmp_path)
    training, reported = faust.training(), faust.reported()
    assert {person(n) for p in training for n in p} == {0, 1}
    assert {person(n) for p in reported for n in p} == {2, 3}
    assert len(set(training)) == 380
    assert [person(p[0]) == person(p[1]) for p in training[:6]] == [True, False] * 3
    assert faust.training(6) == training[:6]
    assert len(set(reported)) == 100
    assert faust_r.reported() == [("tr_reg_022", "tr_reg_031")]
    assert find_data_sets(tmp_path / "FAUST")[0].folder == tmp_path / "FAUST"


def test_a_longer_draw_begins_with_a_shorter() -> None:
    assert SMALL.reported(5) == SMALL.reported(12)[:5]
    assert set(SMALL.reported(None)).isdisjoint(SMALL.training(None))
    assert SMALL.reported(5, seed=1) != SMALL.reported(5, seed=0)


def test_data_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="FAUST or FAUST_r"):
        find_data_sets(tmp_path)


def test_generated_truth_is_consistent() -> None:
    source, target = SMALL.truth(PAIR)
    for landmarks in (SMALL.landmarks(PAIR), SMALL.farthest_landmarks(PAIR, 6)):
        assert len(np.unique(landmarks[:, 0])) == len(np.unique(landmarks[:, 1])) == 6
        np.testing.assert_array_equal(landmarks[:, 0], source[landmarks[:, 1]])
    back = SMALL.truth((PAIR[1], PAIR[0]))
    np.testing.assert_array_equal(back, (target, source))


# Pairs


def test_rows_are_the_errors_of_the_fit(tmp_path: Path) -> None:
    config = small(no17(10))
    (row,) = pair_rows(SMALL, [PAIR], {"NO17": config}, tmp_path / "pairs.jsonl", workers=1)["NO17"]
    source, target = SMALL.truth(PAIR)
    points = raw_map(fit_pair(SMALL, PAIR, config, SMALL.landmarks(PAIR))[1])
    errors = geodesic_errors(SMALL.mesh(PAIR[0]), points[target], source)
    assert row.mean == pytest.approx(errors.mean(), rel=1e-5)
    assert row.refined == row.mean
    at = int(np.flatnonzero(np.isclose(pair_errors.THRESHOLDS, 0.05))[0])
    assert row.curve[at] == pytest.approx((errors <= 0.05).mean(), abs=1e-3)
    assert row.status == "converged"


def test_pairs_resume_and_notice_other_settings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = tmp_path / "pairs.jsonl"
    settings = {"a": small(no17(10)), "b": small(obcs12(10))}
    first = pair_rows(SMALL, [PAIR], settings, store, workers=1)
    size = store.stat().st_size
    # Other threads are not other settings; another name is not other work.
    renamed = {"c": replace(settings["a"], threads=3), "b": settings["b"]}
    monkeypatch.setattr(pair_errors, "measure", lambda *_: pytest.fail("redone"))
    again = pair_rows(SMALL, [PAIR], renamed, store, workers=1)
    assert list(again.values()) == list(first.values())
    assert store.stat().st_size == size
    monkeypatch.undo()
    changed = {"a": replace(settings["a"], weights=replace(settings["a"].weights, laplacian=7.0))}
    assert fingerprint(changed["a"]) != fingerprint(settings["a"])
    pair_rows(SMALL, [PAIR], changed, store, workers=1)
    assert len(read_store(store)) == 3


# The parts of figures


def test_best_errors_are_those_of_truncation() -> None:
    A = np.random.default_rng(0).normal(size=(12, 9))
    K = A @ A.T
    values, vectors = np.linalg.eigh(K)
    found = best_errors(values[::-1])
    for k in (0, 1, 4, 8):
        top = vectors[:, 12 - k :] * values[12 - k :] @ vectors[:, 12 - k :].T
        assert found[k] == pytest.approx(np.linalg.norm(K - top) / np.linalg.norm(K))
    assert found[9] < 1e-12


def test_nystrom_error_is_the_norm_and_vanishes_with_all_samples() -> None:
    X = np.random.default_rng(0).normal(size=(40, 3))
    K = gaussian_matrix(X, 0.5)
    few = np.arange(6)
    explicit = K[:, few] @ np.linalg.solve(K[np.ix_(few, few)], K[few])
    assert nystrom_error(K, X, few, 0.5, block=7) == pytest.approx(np.linalg.norm(K - explicit) / np.linalg.norm(K))
    assert nystrom_error(K, X, np.arange(40), 0.5) < 1e-6


def test_conditioning() -> None:
    assert conditioning(np.diag([1.0, 4.0, 8.0])) == (3, pytest.approx(8.0))
    assert conditioning(np.diag([0.0, 1.0, 2.0])) == (2, np.inf)


def test_figure_1_in_blocks_is_the_whole_formula(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(figure7, "BLOCK", 5)
    rng = np.random.default_rng(0)
    source, target = (Basis(np.arange(3.0), rng.normal(size=(n, 3)), rng.random(n)) for n in (11, 13))
    W_s, W_t, C = rng.normal(size=(11, 4)), rng.normal(size=(13, 4)), rng.normal(size=(3, 3))
    middle = (target.functions @ C @ source.functions.T) * (W_t @ W_s.T)
    whole = target.functions.T @ np.diag(target.mass) @ middle @ np.diag(source.mass) @ source.functions
    np.testing.assert_allclose(figure7.hadamard((source, target), (W_s, W_t), C), whole)


# Conclusions follow the numbers


def rows(mean: float) -> list[Row]:
    return [Row(m, m, (0.0,) * 101, "converged", 1, 1, 0.1) for m in (mean, 2 * mean)]


@pytest.mark.parametrize("good", [True, False])
def test_figure6_claims(good: bool) -> None:
    ours, recommended_error = (0.9, 0.85) if good else (1.1, 0.95)
    means = (6.0, 4.0, 1.0, 1.3, ours, recommended_error, 0.8, ours, 0.9)
    names = (*figure6.style.METHODS, *figure6.variants(10))
    found = figure6.compare({name: rows(mean) for name, mean in zip(names, means, strict=True)})
    claims = {c["claim"]: c for c in found}
    assert claims["ours at most NO17"]["holds"] is good
    assert claims["ours at most NO17"]["value"] == pytest.approx(150 * (ours - 1))
    assert claims["recommended at least 10 % better than NO17"]["holds"] is good
    assert claims["ours at most a fifth of OBCS12"]["holds"]
    assert not claims["and of OBCS12 with α = 1"]["holds"]
    assert claims["and when both are scaled alike too"]["value"] == pytest.approx(150 * (0.8 - ours))
    assert claims["recommended at most the same without a kernel"]["holds"] is good
    assert ("does not hold" in figure6.sentence(claims["ours at most NO17"])) is not good


def test_figure3_conclusions() -> None:
    last = {(g, way): figure3.PAPER[g] * 2 for g in figure3.GAMMAS for way in figure3.METHODS}
    near = figure3.conclusions(last, 400)
    assert "within one order" in near[0]
    assert all("at least as good" in line for line in near[1:4])
    last[10.0, "pivoted Cholesky"] *= 3
    last[0.01, "descriptor farthest"] *= 20
    far = figure3.conclusions(last, 400)
    assert "more than one order" in far[0]
    assert "not as good for every" in far[1]


def test_figure2_and_figure5_conclusions() -> None:
    assert figure2.verdict(0.009, 0.001) == "reproduced."
    assert "the squared error or λ" in figure2.verdict(0.05, 0.005)
    assert figure2.verdict(0.2, 0.005).endswith("means λ_k / λ_1.")
    assert figure2.verdict(0.2, 0.05) == "not reproduced."
    means = dict.fromkeys(figure5.kernels(), 5.0)
    sharpest = f"Gaussian, γ = {max(figure5.GAMMAS):g}"
    assert "as in the paper" in figure5.conclusion(means | {sharpest: 4.0})
    assert "not always better" in figure5.conclusion(means | {sharpest: 6.0})


def test_figure4_conclusions() -> None:
    def panels(*kernel: float) -> list[figure4.Panel]:
        none = np.zeros(1, dtype=np.int64)
        values = {
            method: kernel if method == figure4.METHODS[1] else (0.4, 0.3, 0.2, 0.1) for method in figure4.METHODS
        }
        return [
            figure4.Panel(method, count, none, none, np.array([value]))
            for method, errors in values.items()
            for count, value in zip(figure4.COUNTS, errors, strict=True)
        ]

    assert "holds here" in figure4.conclusions(panels(0.04, 0.03, 0.02, 0.01), True)[-1]
    later = figure4.conclusions(panels(0.13, 0.06, 0.03, 0.02), True)[-1]
    assert "takes 10 descriptors with the kernel and more than 100 without" in later
    assert "does not hold here" in later


def test_figure7_conclusions() -> None:
    times = [
        {"form": "f", "seconds": s, "relative difference": d}
        for s, d in ((4.0, 1e-15), (2.0, 1e-15), (3.0, 1e-4), (0.5, 0.0), (0.25, 1e-4))
    ]
    falling = figure7.conclusions({"plain": np.array([1.0, 0.1, 1e-9])}, times)
    assert "in 2 steps and rise 0 times" in falling[0]
    assert "are monotone" in falling[1]
    assert "8.0 and 4.0 times faster" in falling[2]
    rising = figure7.conclusions({"plain": np.array([1.0, 0.1, 0.2])}, times)
    assert "rise 1 times" in rising[0]
    assert "not monotone" in rising[1]


def test_section44_conclusions() -> None:
    def line(kernel: str, system: str, count: int, rank: int) -> dict[str, object]:
        return {"kernel": kernel, "system": system, "descriptors": count, "rank": rank, "size": 9}

    table = [
        line(kernel, system, count, 9 if kernel == "Gaussian" or count > 9 else count)
        for kernel in section44.KERNELS
        for system in ("F_P", "F_P + F_D", "F_P + F_D + F_Δ")
        for count in (1, 5, 10)
    ]
    lines = section44.conclusions(table)
    assert "linear kernel: from 10 descriptors on; Gaussian kernel: from 1 descriptors on" in lines[0]
    assert "rank 1 of 9 with the linear kernel and 9 with the Gaussian" in lines[-1]


# Whole experiments, tiny


@pytest.fixture
def tiny(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Options:
    """Options and figures of a size that takes a moment."""
    both = (figure6.methods, figure5.kernels, figure4.settings, figure6.variants)
    monkeypatch.setattr(figure6, "variants", lambda n: {k: small(c) for k, c in both[3](n).items()})
    monkeypatch.setattr(figure6, "methods", lambda n: {k: small(c) for k, c in both[0](n).items()})
    monkeypatch.setattr(figure5, "kernels", lambda: {k: small(c) for k, c in both[1]().items()})
    monkeypatch.setattr(figure4, "settings", lambda n, alone: {k: small(c) for k, c in both[2](n, alone).items()})
    monkeypatch.setattr(figure4, "COUNTS", (2,))
    monkeypatch.setattr(figure3, "RANKS", (5, 20, 400))
    monkeypatch.setattr(figure3, "SEEDS", (0,))
    for name in ("paper", "recommended"):
        made = {"paper": paper, "recommended": recommended}[name]
        monkeypatch.setattr(figure7, name, lambda n, made=made: small(made(n)))
    monkeypatch.setattr(section44, "paper", lambda n: small(paper(n)))
    monkeypatch.setattr(section44, "COUNTS", (1, 30))
    monkeypatch.setattr(section44, "SIZE", 10)
    monkeypatch.setattr(section44, "WHOLE_SIZE", 5)
    few = ("least squares", "both directions")
    chosen = {name: formulation_pairs.FORMULATIONS[name] for name in few}
    monkeypatch.setattr(formulation_pairs, "FORMULATIONS", chosen)
    smaller = replace(formulation_pairs.CONFIG, nystrom=NystromConfig(30), basis=BasisConfig(n_eigenfunctions=10))
    monkeypatch.setattr(formulation_pairs, "CONFIG", smaller)
    monkeypatch.setattr(formulation_pairs, "ZOOM", ZoomOut(10, 40, 10))
    monkeypatch.setattr(formulation_pairs, "WRONG_SHARES", (0.0, 0.3))
    monkeypatch.setattr(formulations, "LOSSES", ("squared", "geman"))
    monkeypatch.setattr(formulations, "N_PAIRS", {"generated": 1, "FAUST_r": 1})
    return Options(None, tmp_path, pairs=1, workers=1, vertices=1500, timing_vertices=1500)


COLUMNS = {
    "figure2": {"gamma", "k", "relative eigenvalue", "best rank-k error"},
    "figure3": {"gamma", "sampling", "rank", "relative error"},
    "figure4": {"descriptors", "method", "mean error (% of √area)"},
    "figure5": {"kernel", "pairs", "mean error (% of √area)"},
    "figure6": {"data", "descriptors", "pairs", "method", "mean error (% of √area)"},
    "figure7": {"settings", "step", "relative residual"},
    "section44": {"descriptors", "kernel", "system", "rank", "condition number"},
    "formulations": {"data", "descriptors", "formulation", "kernel", "pairs", "raw", "refined"},
}


def test_every_experiment_is_run_and_has_a_script() -> None:
    assert [each.__name__ for each in run.EXPERIMENTS] == list(COLUMNS)
    folder = Path(run.__file__).parent
    assert all((folder / f"{name}.py").read_text(encoding="utf-8").endswith(f"main({name})\n") for name in COLUMNS)


@pytest.mark.parametrize("function", run.EXPERIMENTS, ids=list(COLUMNS))
def test_experiment_writes_its_files(function: Callable[[Options], Result], tiny: Options) -> None:
    name = function.__name__
    result = function(tiny)
    paths = result.write(name, tiny.folder)
    table = rows_of(tiny.folder / f"{name}.csv")
    assert COLUMNS[name] <= set(table[0])
    for path in paths:
        if path.suffix in (".png", ".pdf"):
            assert path.read_bytes().startswith({".png": b"\x89PNG", ".pdf": b"%PDF"}[path.suffix])
    assert {".csv", ".png", ".pdf", ".md"} == {path.suffix for path in paths}
    text = (tiny.folder / f"{name}.md").read_text(encoding="utf-8")
    assert "shapes that the package generates" in text
    assert result.conclusions
    assert all(line in text for line in result.conclusions)
    if name == "figure3":
        bound = {
            (r["gamma"], r["rank"]): float(r["relative error"]) for r in table if r["sampling"] == "spectral bound"
        }
        assert all(float(r["relative error"]) >= 0.99 * bound[r["gamma"], r["rank"]] for r in table)
    if name == "section44":
        linear = [r for r in table if (r["kernel"], r["system"]) == ("linear", "F_P")]
        assert [int(r["rank"]) for r in linear] == [1, 10]


# Grid search


def test_grid_names_every_combination() -> None:
    found = tune.candidates(
        Config.single_fit(), ["kernel.gamma=1.0,2.0", "weights.laplacian=0.1", "descriptors.n_spectral=10,50"]
    )
    assert len(found) == 4
    chosen = found["kernel.gamma=2.0, weights.laplacian=0.1, descriptors.n_spectral=10"]
    assert chosen.kernel == Gaussian(2.0)
    assert (chosen.weights.laplacian, chosen.descriptors.n_spectral) == (0.1, 10)
    with pytest.raises(InvalidInput, match="gamma"):
        tune.candidates(Config.no17(), ["kernel.gamma=1"])


def test_grid_search_takes_the_lowest_error(tmp_path: Path) -> None:
    options = Options(None, tmp_path, workers=1, vertices=1500)
    grid = tune.candidates(small(recommended(20)), ["weights.laplacian=1,1e9"])
    found = tune.grid_search(options, grid, [(SMALL, [PAIR])])
    errors = [line["mean error (% of √area)"] for line in found.table]
    assert errors == sorted(errors)
    assert found.error == pytest.approx(errors[0] / 100)
    # A map that only commutes with the Laplacian knows nothing of the descriptors.
    assert found.best.weights.laplacian == 1.0


# Command lines


def test_run_writes_and_prints(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    given: list[Options] = []

    def figure(options: Options) -> Result:
        """A figure."""
        given.append(options)
        return Result({"figure": [{"a": 1.0}]}, {}, ("a conclusion",), options.data_sets())

    def other(options: Options) -> Result:
        return figure(options)

    words = ["figure", "-o", str(out), "--vertices", "1500", "--workers", "3", "--pairs", "7", "--seed", "5"]
    experiment.main(figure, other, arguments=words)
    experiment.main(figure, arguments=words[1:])
    assert given == [Options(None, out, 7, 3, 1500, 5)] * 2
    printed = capsys.readouterr().out
    assert all(text in printed for text in ("figure.csv", "figure.md", "a conclusion"))
    for wrong in (["figure9"], ["figure", "--data", str(tmp_path)]):
        with pytest.raises(SystemExit):
            experiment.main(figure, other, arguments=[*wrong, "-o", str(out)])


def test_tune_writes_settings_that_match_reads(tmp_path: Path) -> None:
    settings = tmp_path / "start.toml"
    settings.write_text(settings_text(small(Config.single_fit())), encoding="utf-8")
    listed = tmp_path / "pairs.txt"
    listed.write_text(" ".join(PAIR), encoding="utf-8")
    out = tmp_path / "out"
    words = ["--base", str(settings), "--vary", "weights.laplacian=1,1e9", "--pairs-from", str(listed), "-o", str(out)]
    tune.main([*words, "--vertices", "1500", "--workers", "1"])
    best = read_settings(out / "tune.toml")
    assert best == small(Config.single_fit())
    assert [r["settings"] for r in rows_of(out / "tune.csv")] == ["weights.laplacian=1", "weights.laplacian=1e9"]
    with pytest.raises(SystemExit):
        tune.main(["--vary", "weights.laplacian=one", "-o", str(out)])
    assert len(read_store(out / "pairs.jsonl")) == 2
