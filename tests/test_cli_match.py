"""``kfmaps match``: what it writes, prints and leaves alone."""

from __future__ import annotations

import json
import types
from pathlib import Path

import numpy as np
import pytest

import kfmaps
from commandline import SMALL, Ran, run, shapes
from kfmaps.fmap.confidence import local_confidence
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import load_map, write_mesh

SEARCH = (
    *("--set", "search.candidates=2", "--set", "search.n_sign_functions=2", "--set", "search.match_extremities=false"),
    *("--set", "refinement.stop=80"),
)
"""A search among a few maps."""


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> types.SimpleNamespace:
    return shapes(tmp_path_factory.mktemp("shapes"))


def match(made: types.SimpleNamespace, *words: object, landmarks: bool = True) -> Ran:
    given = ("--landmarks", made.landmarks, "--preset", "single-fit") if landmarks else ()
    return run("match", made.source, made.target, *given, *SMALL, *words)


@pytest.fixture(scope="module")
def first(made: types.SimpleNamespace) -> tuple[Ran, kfmaps.Match]:
    """A map, and what was said while it was made."""
    ran = match(made, "-o", made.folder / "m.npz")
    assert ran.status == 0, ran.stderr
    return ran, load_map(made.folder / "m.npz")


def test_map_of_a_shape_to_itself_moved(made: types.SimpleNamespace, first: tuple[Ran, kfmaps.Match]) -> None:
    """Turned, in other units and renumbered, a shape is matched to itself vertex by vertex; the file says how."""
    found = first[1]
    np.testing.assert_array_equal(found.target_to_source, made.truth)
    assert found.functional_map is not None
    assert found.functional_map.shape == (30, 30)
    np.testing.assert_allclose(found.eigenvalues_source, found.eigenvalues_target, rtol=1e-6, atol=1e-6)
    config = found.config
    assert (config.basis.n_eigenfunctions, config.nystrom.samples) == (20, 60)
    assert found.n_source == len(made.truth)
    assert found.source_file.path == str(made.source)
    assert found.target_file.path == str(made.target)
    np.testing.assert_array_equal(found.landmarks, np.stack([made.truth[made.rows], made.rows], axis=1))
    assert found.fit.raw_target_to_source is not None
    assert found.fit.raw_target_to_source.shape == made.truth.shape
    assert found.fit.raw_functional_map.shape == (20, 20)
    assert set(found.fit.energies) >= {"descriptors", "commutativity", "laplacian"}
    assert all(value >= 0 for value in found.fit.energies.values())
    assert len(found.fit.residuals) - 1 == found.fit.steps
    assert found.fit.residuals[0] == 1.0
    assert set(found.seconds) >= {"eigenfunctions of source", "eigenfunctions of target", "solve", "refinement"}


def test_a_map_that_reaches_no_point_of_the_truth_is_written(
    made: types.SimpleNamespace, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A part may be placed where the truth has nothing; the map is not lost for it."""
    nowhere = kfmaps.Match(np.full(len(made.truth), -1), verdict="unlikely")
    monkeypatch.setattr("kfmaps.cli.commands.match.find_map", lambda *_, **__: nowhere)
    ran = match(made, "-o", tmp_path / "m.npz", "--json", "--truth", made.truth_source, made.truth_target)
    assert ran.status == 0
    assert "no point of the truth has a counterpart" in ran.stderr
    assert json.loads(ran.stdout)["errors"] is None
    assert (load_map(tmp_path / "m.npz").target_to_source == -1).all()


def test_summary_for_people(first: tuple[Ran, kfmaps.Match]) -> None:
    ran = first[0]
    shown = " ".join(ran.stdout.split())
    for text in (
        "matched a.off (300 vertices) → b.off (300 vertices)",
        "verdict Landmarks. One fit, guided by the landmarks",
        "landmarks 6",
        "Gaussian(gamma=",
        "features; converged in",
        "time ",
        "next kfmaps view ",
    ):
        assert text in shown, text
    assert "m.npz" in "".join(ran.stdout.split())
    stages = [line.partition(":")[0] for line in ran.stderr.splitlines()]
    assert set(stages[:2]) == {"eigenfunctions of source", "eigenfunctions of target"}  # side by side
    stages = stages[2:]
    assert stages[:6] == ["descriptors", "energy", "solve", "point map", "refinement", "confidence"]
    assert stages[6:] in (["non-rigid fit"], ["non-rigid fit", "confidence after the fit"])


def test_summary_for_machines(made: types.SimpleNamespace, tmp_path: Path) -> None:
    truth = ("--truth", made.truth_source, made.truth_target)
    ran = match(made, "-o", tmp_path / "m.npz", "--json", "--seed", "5", *truth)
    assert ran.stderr == ""
    output = json.loads(ran.stdout)
    assert (output["source_file"]["n_vertices"], output["target_file"]["n_vertices"]) == (300, 300)
    assert (output["n_landmarks"], output["seed"], output["verdict"]) == (6, 5, "landmarks")
    assert output["map_size"] == [30, 30]
    assert output["fit"]["status"] == "converged"
    assert 0 < output["fit"]["rank"] <= 60
    assert output["errors"]["mean"] == 0.0
    assert output["errors"]["exact"] == 1.0
    assert output["output"] == str(tmp_path / "m.npz")


def test_odd_mesh_is_warned_about_and_matched(made: types.SimpleNamespace, tmp_path: Path) -> None:
    """A vertex of no face: one line, or none where all is quiet but errors, and the right map for all others."""
    mesh = made.meshes[0]
    write_mesh(tmp_path / "loose.off", Mesh(np.vstack([mesh.vertices, [[9, 9, 9]]]), mesh.faces))
    words = ("match", tmp_path / "loose.off", made.target, "--landmarks", made.landmarks, *SMALL)
    words = (*words, "--preset", "single-fit", "-o", tmp_path / "m.npz")
    ran = run(*words)
    output = [line for line in ran.stderr.splitlines() if line.startswith("kfmaps: ")]
    assert output == [f"kfmaps: warning: {tmp_path / 'loose.off'}: 1 vertex that no face uses is kept"]
    points = load_map(tmp_path / "m.npz").target_to_source
    # The loose vertex is as good as the one nearest to it.
    twin = np.linalg.norm(mesh.vertices - 9, axis=1).argmin()
    np.testing.assert_array_equal(np.where(points == 300, twin, points), made.truth)
    assert "existing" in run(*words, "-q").error
    assert run(*words, "-q", "--force") == Ran(0, "", "")


def test_text_output(made: types.SimpleNamespace, tmp_path: Path) -> None:
    ran = match(made, "-o", tmp_path / "m.txt")
    assert ran.status == 0
    assert f"m.txt --source {made.source} --target {made.target}".replace(" ", "") in "".join(ran.stdout.split())
    lines = (tmp_path / "m.txt").read_text().split()
    assert [int(word) for word in lines] == made.truth.tolist()


def test_one_based_landmarks(made: types.SimpleNamespace, tmp_path: Path) -> None:
    pairs = np.loadtxt(made.landmarks, dtype=int)
    np.savetxt(tmp_path / "one.txt", pairs + 1, fmt="%d", header="source target")
    words = ("--preset", "single-fit", "--landmarks", tmp_path / "one.txt", "--one-based", "-q")
    assert match(made, *words, "-o", tmp_path / "m.npz", landmarks=False).status == 0
    np.testing.assert_array_equal(load_map(tmp_path / "m.npz").landmarks, pairs)


def test_raw_is_the_map_before_refinement(
    made: types.SimpleNamespace, first: tuple[Ran, kfmaps.Match], tmp_path: Path
) -> None:
    words = ("match", made.source, made.target, "--landmarks", made.landmarks, "--preset", "single-fit", *SMALL[:-6])
    assert run(*words, "--set", "refinement=none", "-q", "-o", tmp_path / "raw.npz").status == 0
    raw = load_map(tmp_path / "raw.npz")
    assert raw.config.refinement is None
    np.testing.assert_array_equal(raw.target_to_source, first[1].fit.raw_target_to_source)


def test_own_descriptors(made: types.SimpleNamespace, tmp_path: Path) -> None:
    mesh = made.meshes[0]
    values = np.concatenate([mesh.vertices, mesh.vertices**2], axis=1)
    np.save(tmp_path / "s.npy", values)
    np.savetxt(tmp_path / "t.csv", values[made.truth], delimiter=",")
    words = ("--preset", "single-fit", "--descriptors", tmp_path / "s.npy", tmp_path / "t.csv")
    ran = match(
        made, *words, "--set", "descriptors.signature=none", "--json", "-o", tmp_path / "m.npz", landmarks=False
    )
    output = json.loads(ran.stdout)
    assert (output["verdict"], output["n_landmarks"]) == ("unchecked", 0)
    np.testing.assert_array_equal(load_map(tmp_path / "m.npz").target_to_source, made.truth)


def test_without_landmarks(made: types.SimpleNamespace, tmp_path: Path) -> None:
    words = (*SEARCH, "--json", "-o", tmp_path / "m.npz")
    output = json.loads(match(made, *words, landmarks=False).stdout)
    assert output["verdict"] in ("sure", "likely", "ambiguous", "unlikely")
    assert 0 <= output["confidence"] <= 1
    found = load_map(tmp_path / "m.npz")
    assert found.confidence == pytest.approx(output["confidence"])
    assert len(found.alternatives) == output["n_alternatives"]
    assert len(output["score"]["scores"]) == 1 + output["n_alternatives"]
    sure = local_confidence(made.meshes[0], made.meshes[1], found.target_to_source)
    np.testing.assert_allclose(found.local_confidence, sure, atol=1e-9)
    assert output["mean_local_confidence"] == pytest.approx(sure.mean())
    assert "confidence" in output["seconds"]


def test_landmarks_take_part_in_the_search(made: types.SimpleNamespace, tmp_path: Path) -> None:
    words = (*SEARCH, "--landmarks", made.landmarks, "--json", "-o", tmp_path / "m.npz")
    output = json.loads(match(made, *words, landmarks=False).stdout)
    assert output["verdict"] in ("sure", "likely", "ambiguous", "unlikely")
    assert (output["n_landmarks"], output["score"]["rejected_landmarks"]) == (6, [])
    assert len(output["score"]["scores"]) == 1 + output["n_alternatives"]


def test_same_seed_same_map(made: types.SimpleNamespace, tmp_path: Path) -> None:
    words = ("--set", "nystrom.sampling=uniform", "--set", "nystrom.samples=10", "-q")
    for name in ("a.npz", "b.npz"):
        match(made, *words, "--seed", "4", "-o", tmp_path / name)
    match(made, *words, "--seed", "5", "-o", tmp_path / "c.npz")
    a, b, c = (load_map(tmp_path / f"{x}.npz").fit.raw_functional_map for x in "abc")
    np.testing.assert_array_equal(a, b)
    assert np.abs(a - c).max() > 1e-8


def test_settings_file_of_a_run_repeats_it(made: types.SimpleNamespace, tmp_path: Path) -> None:
    words = ("--preset", "single-fit", *SMALL, "--kernel", "laplacian")
    assert run("config", *words, "-o", tmp_path / "s.toml").status == 0
    match(made, "--kernel", "laplacian", "-q", "-o", tmp_path / "a.npz")
    given = ("--landmarks", made.landmarks, "--config", tmp_path / "s.toml")
    assert run("match", made.source, made.target, *given, "-q", "-o", tmp_path / "b.npz").status == 0
    a, b = load_map(tmp_path / "a.npz"), load_map(tmp_path / "b.npz")
    assert a.config == b.config
    np.testing.assert_array_equal(a.functional_map, b.functional_map)


def test_config_is_not_overwritten(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text("# mine\n")
    assert "--force" in run("config", "-o", tmp_path / "s.toml").error
    assert (tmp_path / "s.toml").read_text() == "# mine\n"
    assert run("config", "-o", tmp_path / "s.toml", "--force").status == 0
    assert (tmp_path / "s.toml").read_text() == run("config").stdout


def test_view_opens_the_page(made: types.SimpleNamespace, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import kfmaps.viz.result_pages as results

    opened: list[str] = []

    def open_page(html: str) -> tuple[Path, bool]:
        opened.append(html)
        return tmp_path / "page.html", False

    monkeypatch.setattr(results, "open_page", open_page)
    ran = match(made, "--view", "-o", tmp_path / "m.npz", "-q")
    assert "<html" in opened[0]
    assert '"confidence":[{' in opened[0]  # per vertex
    assert ran.stderr == f"no browser was found; open {(tmp_path / 'page.html').as_uri()}\n"
    assert ran.status == 0
