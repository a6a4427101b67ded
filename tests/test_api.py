"""What the library takes and gives: files, arrays and other libraries' meshes in, a match that shows itself out."""

from __future__ import annotations

import re
import sys
import types
from dataclasses import replace
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

import kfmaps
from collecting import CONFIG
from conftest import blob
from kfmaps import InvalidInput, Mesh
from kfmaps.fmap.precise import vertex_point_map
from kfmaps.geometry.mesh import surface_area
from kfmaps.io import write_landmarks
from kfmaps.io.convert import as_mesh

GUARDS = ("kfmaps.matching.match", "kfmaps.matching.result")

MESH = blob(200)
V, F = MESH.vertices, MESH.faces
ORDER = np.random.default_rng(5).permutation(200)
OTHER = Mesh(V[ORDER], np.argsort(ORDER)[F])
"""The same shape in another order: vertex i is vertex ORDER[i] of the first."""
MARKS = [(int(ORDER[i]), i) for i in (0, 40, 80, 120, 160)]
QUICK = replace(CONFIG, refinement=kfmaps.ICP(2))

SOURCES: dict[str, Any] = {
    "mesh": MESH,
    "tuple": (V, F),
    "lists": [V.tolist(), F.tolist()],
    "trimesh": trimesh.Trimesh(V, F, process=False),
    "pyvista": types.SimpleNamespace(points=V.astype(np.float32), faces=np.insert(F, 0, 3, axis=1).ravel()),
    "meshio": types.SimpleNamespace(
        points=V,
        cells=[
            types.SimpleNamespace(type="line", data=np.array([[0, 1]])),
            types.SimpleNamespace(type="triangle", data=F[:9]),
            types.SimpleNamespace(type="triangle", data=F[9:]),
        ],
        cells_dict={},
    ),
    "open3d": types.SimpleNamespace(vertices=V, triangles=F.astype(np.int32)),
}


@pytest.mark.parametrize("kind", SOURCES)
def test_shapes_of_other_libraries(kind: str) -> None:
    found = as_mesh(SOURCES[kind])
    np.testing.assert_allclose(found.vertices, V, atol=1e-6)
    np.testing.assert_array_equal(found.faces, F)


def test_polygons_become_fans() -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 2, 0]], dtype=float)
    fans = [[0, 1, 2], [0, 2, 3], [3, 2, 4]]
    flat: Any = types.SimpleNamespace(points=square, faces=np.array([4, 0, 1, 2, 3, 3, 3, 2, 4]))
    np.testing.assert_array_equal(as_mesh(flat).faces, fans)
    blocks = {"quad": np.array([[0, 1, 2, 3]]), "triangle": np.array([[3, 2, 4]])}
    meshio: Any = types.SimpleNamespace(points=square, cells=blocks, cells_dict=blocks)
    np.testing.assert_array_equal(as_mesh(meshio).faces, fans)
    np.testing.assert_array_equal(as_mesh((square, [[0, 1, 2, 3]])).faces, fans[:2])


def test_without_faces_it_is_a_point_cloud() -> None:
    for cloud in (Mesh(V), Mesh(V, None), as_mesh(V), as_mesh(trimesh.PointCloud(V))):  # pyright: ignore
        assert cloud.faces.shape == (0, 3)
        np.testing.assert_array_equal(cloud.vertices, V)


@pytest.mark.parametrize(
    ("shape", "message"),
    [
        (3, "got int"),
        ("no-such.off", "no-such.off"),
        ((V, F, F), "got tuple"),
        ((V, "faces"), "faces: expected whole numbers"),
        ((V, F[:, :2]), "three vertex numbers"),
        ((V[:, :2], F), "shape"),
        (("a", F), "got tuple"),
        (types.SimpleNamespace(points=V, faces=np.array([3, 0, 1])), "cut short"),
        (types.SimpleNamespace(points=V, faces=np.array([2, 0, 1])), "three corners"),
        (types.SimpleNamespace(points=V, cells={"tetra": F}, cells_dict={}), "surface first"),
    ],
)
def test_other_things_are_refused_by_name(shape: Any, message: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        kfmaps.match(shape, MESH)
    assert message in str(caught.value)


@pytest.fixture(scope="module")
def found() -> kfmaps.Match:
    return kfmaps.match((V, F), SOURCES["trimesh"], QUICK, landmarks=[(v, v) for v, _ in MARKS])


@pytest.fixture(scope="module")
def shuffled(tmp_path_factory: pytest.TempPathFactory) -> kfmaps.Match:
    folder = tmp_path_factory.mktemp("files")
    kfmaps.write_mesh(folder / "a.ply", MESH)
    kfmaps.write_mesh(folder / "b.ply", OTHER)
    write_landmarks(folder / "pairs.txt", np.array(MARKS))
    return kfmaps.match(folder / "a.ply", str(folder / "b.ply"), QUICK, landmarks=folder / "pairs.txt", rng=1)


def test_files_objects_and_arrays_are_matched_alike(found: kfmaps.Match, shuffled: kfmaps.Match) -> None:
    np.testing.assert_array_equal(found.target_to_source, np.arange(200))
    np.testing.assert_array_equal(shuffled.target_to_source, ORDER)
    assert found.source.vertices.shape == (200, 3)
    prepared = [kfmaps.prepare(part, QUICK, name="a") for part in ((V, F), OTHER)]
    again = kfmaps.match(prepared[0], prepared[1], QUICK, landmarks=MARKS, rng=1)
    np.testing.assert_array_equal(again.target_to_source, ORDER)


def test_progress_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    stages: list[str] = []
    for progress in (True, lambda stage, _done: stages.append(stage), False):
        kfmaps.match(MESH, MESH, replace(QUICK, refinement=None), landmarks=MARKS[:3], progress=progress)
    message = capsys.readouterr().err
    assert "solve" in message
    assert message.count("solve") == 1
    assert "solve" in stages


def test_a_match_shows_itself(found: kfmaps.Match) -> None:
    assert repr(found) == "Match(200 target to 200 source vertices: landmarks; C 20 × 20)"
    html = found._repr_html_()
    assert html.startswith('<img alt="Match(')
    assert "data:image/png;base64," in html
    figure = found.plot(title="both")
    assert len(figure.axes) == 2
    assert len(found.plot(truth=(np.arange(200), np.arange(200))).axes) == 4  # the error, and its bar


def test_a_notebook_shows_the_page_in_its_cell(found: kfmaps.Match, monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[str] = []
    display = types.ModuleType("IPython.display")
    display.HTML = str  # pyright: ignore[reportAttributeAccessIssue]
    display.display = shown.append  # pyright: ignore[reportAttributeAccessIssue]
    monkeypatch.setitem(sys.modules, "IPython", types.ModuleType("IPython"))
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    monkeypatch.setattr("kfmaps.viz.result_pages.in_notebook", lambda: True)
    assert found.view(descriptors=False, names=('a"<b>', "c")) is None
    (html,) = shown
    page = unescape(re.findall(r'srcdoc="([^"]*)"', html)[0])
    assert 'sandbox="allow-scripts allow-downloads"' in html
    assert 'title="a&quot;&lt;b&gt; → c"' in html
    assert page.startswith("<!DOCTYPE html>")
    assert '<body class="cell">' in page
    assert page.endswith("</html>")


def test_transfer_carries_values_and_coordinates(shuffled: kfmaps.Match, tmp_path: Path) -> None:
    heights = V[:, 1]
    np.testing.assert_array_equal(shuffled.transfer(heights), heights[ORDER])
    np.testing.assert_array_equal(kfmaps.transfer(heights, shuffled.target_to_source), heights[ORDER])
    shuffled.save(tmp_path / "m.npz")
    np.testing.assert_array_equal(kfmaps.transfer(heights, tmp_path / "m.npz"), heights[ORDER])
    for carrier in (shuffled, tmp_path / "m.npz"):
        with pytest.raises(InvalidInput, match="200 rows"):
            kfmaps.transfer(heights[:-1], carrier)
    with pytest.raises(InvalidInput, match="existing"):
        shuffled.save(tmp_path / "m.npz")


def test_inverse(shuffled: kfmaps.Match) -> None:
    """Of a one-to-one map the inverse; else what it gives lands where it should, or as near as any does."""
    np.testing.assert_array_equal(shuffled.inverse(), np.argsort(ORDER))
    points = np.sort(np.random.default_rng(0).integers(0, 200, 200))
    crowded = replace(shuffled, target_to_source=points, target=MESH, precise_map=None)
    back = crowded.inverse()
    reached = np.unique(points)
    np.testing.assert_array_equal(points[back[reached]], reached)
    for vertex in reached[:20]:
        there = np.flatnonzero(points == vertex)
        middle = V[there].mean(axis=0)
        assert np.linalg.norm(V[back[vertex]] - middle) <= np.linalg.norm(V[there] - middle, axis=1).min() + 1e-12
    assert set(points[back]) <= set(reached)
    # Outside the part that both shapes have it is -1.
    overlap = np.where(np.arange(len(back)) < 120, 0.9, 0.2)
    part = replace(crowded, partial=replace(crowded.partial, overlap_source=overlap))
    np.testing.assert_array_equal(part.inverse(), np.where(np.arange(len(back)) < 120, back, -1))


def test_the_inverse_is_finer_where_the_map_is(shuffled: kfmaps.Match, poses: kfmaps.datasets.ExamplePair) -> None:
    """Points inside triangles of the target: nearer to the truth than the vertices on which the target's land."""
    pair = poses
    place = kfmaps.PointMap(pair.truth_faces, pair.truth_weights)
    shapes = {"source": pair.source, "target": pair.target}
    coarse = replace(shuffled, target_to_source=pair.truth, precise_map=None, **shapes)
    fine = replace(coarse, precise_map=place)
    back = fine.precise_inverse()
    there = np.einsum("si,sij->sj", back.weights, pair.target.vertices[pair.target.faces[back.faces]])
    true = np.einsum("ti,tij->tj", place.weights, pair.source.vertices[pair.source.faces[place.faces]])
    # Carried back through the true map, linear in the target's faces, each source vertex is where it was.
    again = np.einsum("si,sij->sj", back.weights, true[pair.target.faces[back.faces]])
    edge = np.sqrt(surface_area(pair.source) / len(pair.source.faces))
    assert np.linalg.norm(again - pair.source.vertices, axis=1).mean() < 0.2 * edge
    corners = fine.inverse()
    away = np.linalg.norm(pair.target.vertices[pair.target.faces[back.faces]] - there[:, None], axis=2)
    np.testing.assert_allclose(np.linalg.norm(pair.target.vertices[corners] - there, axis=1), away.min(axis=1))
    off = [np.linalg.norm(true[found] - pair.source.vertices, axis=1).mean() for found in (corners, coarse.inverse())]
    assert off[0] < off[1]


def test_picture_and_page_of_a_map(shuffled: kfmaps.Match, tmp_path: Path) -> None:
    path = kfmaps.view(shuffled, output=tmp_path / "page.html", descriptors=False, names=("one", "two"))
    assert path is not None
    assert "one → two" in path.read_text(encoding="utf-8")
    shuffled.save(tmp_path / "m.npz")
    kfmaps.view(tmp_path / "m.npz", (V, F), OTHER, output=tmp_path / "again.html", descriptors=False)
    kfmaps.render(tmp_path / "m.npz", MESH, OTHER, output=tmp_path / "pair.png")
    assert (tmp_path / "pair.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(InvalidInput, match="source= in Python"):
        kfmaps.load_map(tmp_path / "m.npz").plot()
    with pytest.raises(InvalidInput, match="Give source="):
        kfmaps.render(shuffled.target_to_source)
    with pytest.raises(InvalidInput, match="equal length"):
        kfmaps.render(shuffled, truth=([0, 1], [0]))
    with pytest.raises(InvalidInput, match="existing"):
        kfmaps.render(shuffled, output=tmp_path / "pair.png")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: kfmaps.match(MESH, MESH, "paper"), "config: expected a Config, got str"),  # pyright: ignore
        (lambda: kfmaps.prepare("a.off", 3), "config"),  # pyright: ignore
        (lambda: kfmaps.laplace_basis("a.off", 5), "mesh: expected a Mesh, got str"),  # pyright: ignore
        (lambda: kfmaps.geodesic_distances((V, F), [0]), "mesh: expected a Mesh, got tuple"),  # pyright: ignore
        (lambda: kfmaps.geodesic_errors("no.off", ORDER, ORDER), "no.off: expected a file"),
        (lambda: kfmaps.geodesic_errors(MESH, ORDER, ORDER[:5]), "predicted and true vertices: expected lists of"),
        (lambda: kfmaps.geodesic_errors(MESH, ORDER, ([0], [200])), "the truth's target vertices"),
        (lambda: kfmaps.transfer(V, vertex_point_map(ORDER, MESH)), "a PointMap alone. Give source="),
        (lambda: kfmaps.render(vertex_point_map(ORDER, MESH), Mesh(V), OTHER), "map"),
        (lambda: kfmaps.coverage(ORDER, "a.off"), "source: expected a Mesh"),  # pyright: ignore
        (lambda: kfmaps.write_mesh("a.off", (V, F)), "mesh: expected a Mesh"),  # pyright: ignore
        (lambda: kfmaps.save_map("a.npz", ORDER), "map: expected a Match"),  # pyright: ignore
        (lambda: kfmaps.transfer(V, {"a": 1}), "map: expected a Match, the file of a map"),  # pyright: ignore
        (lambda: kfmaps.transfer(V, [0, 1.5]), "map: expected a whole number for each vertex, got fractions"),
        (lambda: kfmaps.view({"a": 1}, MESH, MESH), "map: expected"),  # pyright: ignore
    ],
)
def test_wrong_things_are_told_in_words(call: Any, message: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        call()
    assert message in str(caught.value)


@pytest.mark.filterwarnings("ignore::kfmaps.KfmapsWarning")
def test_each_call_takes_any_kind_of_map(shuffled: kfmaps.Match, tmp_path: Path) -> None:
    """A match, its file, the file's content, points inside triangles and a list of vertices: all mean the same."""
    shuffled.save(tmp_path / "m.npz")
    kfmaps.write_mesh(tmp_path / "a.off", MESH)
    given = (shuffled, tmp_path / "m.npz", kfmaps.Match(ORDER), vertex_point_map(ORDER, MESH), ORDER, ORDER.tolist())
    moved = np.roll(ORDER, 1)
    pictures, errors = [], []
    for one in given:
        np.testing.assert_allclose(kfmaps.transfer(V, one, source=MESH), V[ORDER], atol=1e-6)
        assert kfmaps.transfer(ORDER, one, source=tmp_path / "a.off").tolist() == ORDER[ORDER].tolist()
        errors.append(kfmaps.geodesic_errors((V, F), one, moved))
        truth = (moved[:9], np.arange(9))
        np.testing.assert_array_equal(kfmaps.geodesic_errors(MESH, one, truth), errors[-1][:9])
        figure = kfmaps.render(one, MESH, OTHER, colors=np.zeros((200, 3)))
        pictures.append(len(figure.axes))
    assert pictures == [2] * len(given)
    assert (errors[0] > 0.05).mean() > 0.9
    for other in errors[1:]:
        np.testing.assert_allclose(other, errors[0], rtol=0.03)  # paths between points are found otherwise
    part = np.where(ORDER < 100, ORDER, -1)
    np.testing.assert_array_equal(np.isnan(kfmaps.geodesic_errors(MESH, part, moved)), part < 0)


# Notebooks ------------------------------------------------------------------------------------------------


def test_zoomout_grows_a_map_to_all_functions(shuffled: kfmaps.Match) -> None:
    a, b = (kfmaps.laplace_basis(mesh, 60) for mesh in (shuffled.source, shuffled.target))
    C = kfmaps.to_functional(ORDER, a.truncate(20), b.truncate(20))
    found = kfmaps.zoomout(C, a, b)
    np.testing.assert_array_equal(found.target_to_source, ORDER)
    assert found.functional_map.shape == (60, 60)
    same = kfmaps.ZoomOut(start=20, stop=60, step=5)(C, a, b)
    np.testing.assert_array_equal(found.functional_map, same.functional_map)
    assert kfmaps.zoomout(C, a, b, start=10, stop=30, step=10).history == (10, 20, 30)
    for wrong, part in (((C, MESH, b), "source: expected a Basis"), ((np.eye(61), a, b), "at most 60 × 60")):
        with pytest.raises(InvalidInput, match=part):
            kfmaps.zoomout(*wrong)  # pyright: ignore


def test_error_curves_in_one_line() -> None:
    """The line of a name has the fraction of its errors within each threshold; what has no counterpart is in none."""
    figure = kfmaps.plot_curve({"ours": [0.0, 0.1], "theirs": np.array([0.05, np.nan, np.nan, 0.2])}, limit=0.5)
    ours, theirs = figure.axes[0].lines
    assert (ours.get_label(), theirs.get_label()) == ("ours", "theirs")
    steps = np.asarray(ours.get_xdata())
    assert steps[-1] == 0.5
    np.testing.assert_array_equal(ours.get_ydata(), np.where(steps >= 0.1, 1.0, 0.5))
    np.testing.assert_array_equal(theirs.get_ydata(), 0.25 * (steps >= 0.05) + 0.25 * (steps >= 0.2))
    assert figure._repr_png_()[1:4] == b"PNG"  # type: ignore[attr-defined]
    for wrong in ({}, {"ours": []}):
        with pytest.raises(InvalidInput):
            kfmaps.plot_curve(wrong)


@pytest.mark.filterwarnings("ignore::kfmaps.KfmapsWarning")
def test_a_truth_may_be_an_array(shuffled: kfmaps.Match, monkeypatch: pytest.MonkeyPatch) -> None:
    seen = []
    monkeypatch.setattr("kfmaps.viz.painted_errors", lambda *args: seen.append(args[3:]) or np.zeros(200))
    truth = np.where(np.arange(200) < 50, -1, ORDER)
    shuffled.plot(truth=truth)
    shuffled.plot(truth=(ORDER[50:], np.arange(50, 200)))
    for one, other in zip(*seen, strict=True):
        np.testing.assert_array_equal(one, other)
    with pytest.raises(InvalidInput, match=r"truth: expected shape \(200\)"):
        shuffled.plot(truth=ORDER[:9])
