"""The page of a result: what stands in it, that it is safe, small, and up to date."""

import base64
import hashlib
import json
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.sparse.csgraph import dijkstra
from scipy.spatial.transform import Rotation

from kfmaps._arrays import InvalidInput
from kfmaps.cli.commands.view import view
from kfmaps.config import Config
from kfmaps.datasets import sphere
from kfmaps.evaluation import Truth
from kfmaps.fmap.confidence import local_confidence
from kfmaps.fmap.convert import nearest_reached
from kfmaps.fmap.evaluate import area_distortion
from kfmaps.fmap.precise import PointMap
from kfmaps.geometry.mesh import Mesh, unit_area, vertex_areas
from kfmaps.io import MeshFile, save_map, write_mesh, write_vertex_numbers
from kfmaps.io.bake import decode_picture, encode_png
from kfmaps.io.mapfile import mesh_path
from kfmaps.io.record import Picture
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import MatchFit, ShapeFile
from kfmaps.viz import result_pages
from kfmaps.viz.document import _json_block, asset, encode_floats, encode_integers, to_json
from kfmaps.viz.figures import position_colors
from kfmaps.viz.result_pages import _match_summary, _rotation_by_map, match_page, signatures, vertex_errors
from serving import Page, page_data

WEB = Path(__file__).parents[1] / "web"
NO_FACES = np.zeros((0, 3), int)
NASTY = "</script><script>alert(1)</script>&'\"<!--"


def unpacked(record: dict) -> np.ndarray:
    raw = np.frombuffer(base64.b64decode(record["base64"]), np.dtype(record["type"]).newbyteorder("<"))
    array = raw.reshape(record["shape"])
    if "step" not in record:
        return array
    return np.where(array == 65535, np.nan, record["low"] + record["step"] * array)


def grid_torus(around: int, along: int) -> Mesh:
    """A torus of around × along vertices, quickly."""
    u, v = np.meshgrid(np.arange(around), np.arange(along), indexing="ij")
    a, b = 2 * np.pi * u.ravel() / around, 2 * np.pi * v.ravel() / along
    ring = 1 + 0.4 * np.cos(b)
    number = lambda i, j: ((i % around) * along + j % along).ravel()  # noqa: E731
    quads = [number(u, v), number(u + 1, v), number(u + 1, v + 1), number(u, v + 1)]
    faces = np.concatenate([np.stack([quads[i] for i in t], axis=1) for t in ((0, 1, 2), (0, 2, 3))])
    return Mesh(np.stack([ring * np.cos(a), 0.4 * np.sin(b), ring * np.sin(a)], axis=1), faces)


@pytest.fixture(scope="module")
def pair() -> tuple[Mesh, Mesh, np.ndarray]:
    rng = np.random.default_rng(1)
    source, target = sphere(300), grid_torus(20, 12)
    return source, target, rng.integers(0, 300, 240)


# Arrays ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("largest", [0, 255, 256, 65535, 65536, 2**32 - 1])
def test_whole_numbers_come_back(largest: int) -> None:
    numbers = np.array([[0, largest, largest // 2]])
    record = encode_integers(numbers)
    assert np.array_equal(unpacked(record), numbers)
    assert len(base64.b64decode(record["base64"])) == 3 * (1 if largest < 256 else 2 if largest < 65536 else 4)


def test_real_numbers_come_back_within_half_a_step() -> None:
    values = np.random.default_rng(0).normal(size=(50, 3)) * 7
    values[3, 1], values[4, 2] = np.nan, np.inf
    back = unpacked(encode_floats(values))
    known = np.isfinite(values)
    span = np.ptp(values[known])
    assert np.abs(back - values)[known].max() <= span / 65534 / 2 * (1 + 1e-9)
    assert np.isnan(back[~known]).all()
    assert np.array_equal(unpacked(encode_floats(np.full(4, 2.5))), np.full(4, 2.5))
    assert np.isnan(unpacked(encode_floats(np.full(4, np.nan)))).all()


def test_json_block_holds_no_markup_and_means_the_same() -> None:
    data = {NASTY: [NASTY, np.float32(0.5), np.arange(2), (1, None), True, "Ω → \u2028"]}
    text = _json_block(data)
    assert not set("<>&\u2028") & set(text)
    assert json.loads(text) == {NASTY: [NASTY, 0.5, [0, 1], [1, None], True, "Ω → \u2028"]}
    assert to_json({"a": np.nan, "b": [float("inf")], "c": Path("x")}) == {"a": "nan", "b": ["inf"], "c": "x"}


# Fields ---------------------------------------------------------------------------------------------------


def test_area_distortion_is_the_ratio_of_areas() -> None:
    target = grid_torus(24, 16)
    identity = np.arange(len(target.vertices))
    grown = Mesh(7 * target.vertices, target.faces)
    assert np.abs(area_distortion(grown, target, identity)).max() < 1e-9
    # Summed over the target with the weights of the definition, the ratios give the source's whole area.
    registered = Mesh(target.vertices * (1 + 0.3 * np.sin(target.vertices)), target.faces)
    weights = vertex_areas(unit_area(target))
    assert weights @ 2 ** area_distortion(registered, target, identity) == pytest.approx(1, abs=1e-9)
    assert np.ptp(area_distortion(registered, target, identity)) > 0.5
    assert (area_distortion(target, target, np.zeros_like(identity)) == -4).all()
    assert np.isnan(area_distortion(Mesh(target.vertices, NO_FACES), target, identity)).all()


def test_nearest_reached_is_nearest_along_the_edges() -> None:
    source = grid_torus(20, 12)
    points = np.random.default_rng(2).integers(0, len(source.vertices), 30)
    nearest = nearest_reached(source, points)
    ends = source.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    graph = np.zeros((len(source.vertices),) * 2)
    graph[ends[:, 0], ends[:, 1]] = np.linalg.norm(source.vertices[ends[:, 0]] - source.vertices[ends[:, 1]], axis=1)
    distance = dijkstra(graph, directed=False)
    assert set(nearest) <= set(points)
    own = distance[np.arange(len(nearest)), nearest]
    assert np.allclose(own, distance[:, points].min(axis=1))
    assert own.max() > 0
    cloud = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [2.2, 0, 0], [9, 0, 0]]), NO_FACES)
    assert nearest_reached(cloud, np.array([1, 3])).tolist() == [1, 1, 1, 3]


def test_alignment_undoes_a_rotation_and_never_mirrors() -> None:
    source = Mesh(sphere(200).vertices * [3, 2, 1], sphere(200).faces)
    turn = Rotation.from_euler("xyz", [100, 30, -70], degrees=True).as_matrix()
    target = Mesh(source.vertices @ turn.T + 5, source.faces)
    identity = np.arange(200)
    assert np.allclose(_rotation_by_map(source, target, identity), turn.T)
    mirrored = Mesh(source.vertices * [-1, 1, 1], source.faces)
    assert np.linalg.det(_rotation_by_map(source, mirrored, identity)) == pytest.approx(1)


# The page -------------------------------------------------------------------------------------------------


def plain_page(source: Mesh, target: Mesh, found: np.ndarray | Match, **more: Any) -> str:
    found = found if isinstance(found, Match) else Match(found)
    return match_page(found, source, target, **{"names": ("a", "b"), "descriptors": False, **more})


def test_page_holds_the_shapes_and_the_map(pair: tuple) -> None:
    source, target, points = pair
    rows = np.delete(np.arange(240), 5)
    data = page_data(
        plain_page(source, target, Match(points, alternatives=(points[::-1],)), truth=Truth(points[rows], rows))
    )
    placed = unpacked(data["source"]["positions"])
    moved = placed - unit_area(source).vertices
    assert np.abs(moved - moved[0]).max() < 1e-4
    assert np.array_equal(unpacked(data["source"]["faces"]), source.faces)
    assert [m["label"] for m in data["maps"]] == ["Best map", "Alternative 1"]
    assert np.array_equal(unpacked(data["maps"][0]["points"]), points)
    assert np.array_equal(unpacked(data["maps"][1]["points"]), points[::-1])
    expected = vertex_errors(source, [points, points[::-1]], points[rows], rows)
    for row, given in zip(data["errors"], expected, strict=True):
        back = unpacked(row)
        assert np.isnan(back[5])
        assert np.nanmax(np.abs(back - given)) < 1e-4


def test_page_takes_names_and_settings_as_text(pair: tuple) -> None:
    source, target, points = pair
    html = plain_page(source, target, Match(points, fit=MatchFit(kernel=NASTY)), names=(NASTY, "b"))
    tags = Page(html)
    assert [a.get("type") for t, a in tags.tags if t == "script"] == ["application/json", None]
    assert tags.text["title"] == [f"{NASTY} → b"]
    assert page_data(html)["source"]["name"] == NASTY
    assert page_data(html)["summary"]["kernel"] == NASTY


def test_page_allows_its_own_script_and_style_only(pair: tuple) -> None:
    tags = Page(plain_page(*pair))
    policy = next(a["content"] for t, a in tags.tags if a.get("http-equiv") == "Content-Security-Policy")
    assert policy is not None
    rules = {name: rest for name, *rest in (rule.split() for rule in policy.split("; "))}
    for name, text in (("script-src", tags.text["script"][1]), ("style-src", tags.text["style"][0])):
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert rules[name] == [f"'sha256-{digest}'"]
    assert rules["default-src"] == rules["connect-src"] == ["'none'"]
    loads = [a.get("src") or a.get("href") for _, a in tags.tags if "src" in a or "href" in a]
    assert loads == ["data:,"]
    assert not any(name.startswith("on") for _, a in tags.tags for name in a)


def test_everything_of_two_7000_vertex_meshes_is_below_3_mb(monkeypatch: pytest.MonkeyPatch) -> None:
    mesh, rng = grid_torus(100, 70), np.random.default_rng(0)
    n = len(mesh.vertices)
    assert n == 7000
    waves = rng.random((n, 12)), rng.random((n, 12))
    made = {"signatures": waves, "local_confidence": rng.random(n), "vertex_errors": rng.random((4, n))}
    for name, values in made.items():
        monkeypatch.setattr(result_pages, name, lambda *_, values=values: values)
    others = tuple(rng.permutation(n) for _ in range(3))
    html = plain_page(
        mesh,
        mesh,
        Match(rng.permutation(n), functional_map=rng.random((200, 200)), alternatives=others),
        truth=Truth(np.arange(n), np.arange(n)),
        descriptors=True,
    )
    assert len(html.encode()) < 3e6
    shown = page_data(html)["descriptors"]
    assert [d["number"] for d in shown] == list(range(12))
    assert np.abs(unpacked(shown[-1]["target"]) - waves[1][:, 11]).max() < 1e-4


@pytest.mark.parametrize(
    ("found", "name"),
    [
        (Match(np.zeros(3, int)), "map"),
        (Match(np.full(240, 300)), "map"),
        (Match(np.zeros(240, int), alternatives=(np.full(240, -1),)), "alternative 1"),
    ],
)
def test_page_refuses_what_does_not_fit(pair: tuple, found: Match, name: str) -> None:
    with pytest.raises(InvalidInput, match=f"^{name}: expected"):
        plain_page(pair[0], pair[1], found)
    with pytest.raises(InvalidInput, match="up: expected"):
        plain_page(pair[0], pair[1], pair[2], up="w")


# Results --------------------------------------------------------------------------------------------------


def test_errors_are_zero_at_the_truth_and_unknown_elsewhere(pair: tuple) -> None:
    source, _, points = pair
    truth_t = np.arange(0, 240, 2)
    off = points.copy()
    off[0] = (points[0] + 1) % 300
    rows = vertex_errors(source, [points, off], points[truth_t], truth_t)
    assert np.isnan(rows[:, 1::2]).all()
    assert (rows[0, ::2] == 0).all()
    assert rows[1, 0] > 0
    assert (rows[1, 2::2] == 0).all()


def test_signatures_do_not_depend_on_pose_or_unit() -> None:
    mesh = grid_torus(20, 15)
    turned = Mesh(5 * mesh.vertices @ Rotation.from_rotvec([1, 2, 3]).as_matrix() + 1, mesh.faces)
    first, second = signatures(mesh, turned)
    assert first.shape == (300, 12)
    assert np.allclose(first, second, rtol=1e-5, atol=1e-6)


def test_summary_of_a_match_is_json() -> None:
    fit = MatchFit(residuals=np.array([1.0, 0.5, 0.0625]), energies={"laplacian": 1.5}, status="converged", steps=2)
    found = Match(np.zeros(4, np.int64), config=Config.single_fit(), seconds={"solve": 0.5}, fit=fit)
    summary = _match_summary(found)
    assert json.loads(json.dumps(summary)) == summary
    assert summary["residuals"] == [1, 0.5, 0.0625]
    assert summary["times"] == {"solve": 0.5}
    assert summary["energies"] == {"laplacian": 1.5}
    assert summary["settings"]["nystrom"]["samples"] == Config.single_fit().nystrom.samples
    assert "confidence" not in summary
    assert _match_summary(replace(found, confidence=0.25))["confidence"] == 0.25
    assert "energies" not in _match_summary(replace(found, fit=MatchFit()))


def test_page_of_a_file_shows_what_the_file_holds(pair: tuple) -> None:
    source, target, points = pair
    found = Match(
        points,
        alternatives=(points[::-1],),
        local_confidence=np.linspace(0, 1, 240),
        confidence=0.5,
        seconds={"solve": 2.0},
    )
    data = page_data(plain_page(source, target, found))
    assert len(data["maps"]) == 2
    assert data["summary"] == {"verdict": "unchecked", "times": {"solve": 2}, "confidence": 0.5}
    known, other = (unpacked(row) for row in data["confidence"])
    np.testing.assert_allclose(known, np.linspace(0, 1, 240), atol=1e-4)
    np.testing.assert_allclose(other, local_confidence(source, target, points[::-1]), atol=1e-4)


def test_vertices_without_a_counterpart_have_no_local_fit(pair: tuple) -> None:
    """Else the page of a small part would show a mean fit near zero."""
    source, target, points = pair
    lost = np.where(np.arange(240) < 100, -1, points)
    data = page_data(plain_page(source, target, Match(lost, local_confidence=np.ones(240))))
    np.testing.assert_array_equal(np.isnan(unpacked(data["confidence"][0])), lost < 0)


def test_a_page_says_that_a_map_is_to_the_mirror_image(small_mesh: Mesh) -> None:
    points = np.arange(len(small_mesh.vertices))
    for way, told in (("reversing", True), ("preserving", False)):
        data = page_data(plain_page(small_mesh, small_mesh, Match(points, verdict="sure", orientation=way)))
        assert ("mirror image" in data["verdict"]["text"]) == told


def test_view_writes_one_page(pair: tuple, tmp_path: Path) -> None:
    source, target, points = pair
    write_mesh(tmp_path / "a.off", source)
    write_mesh(tmp_path / "b.off", target)
    write_vertex_numbers(tmp_path / "a.vts", points)
    write_vertex_numbers(tmp_path / "b.vts", np.arange(240))
    save_map(tmp_path / "m.npz", Match(points, source_file=ShapeFile("gone/a.off"), target_file=ShapeFile("b.off")))
    page = tmp_path / "page.html"
    a, b = tmp_path / "a.vts", tmp_path / "b.vts"
    view(tmp_path / "m.npz", output=page, truth=(a, b), descriptors=False)
    data = page_data(page.read_text(encoding="utf-8"))
    assert (data["source"]["name"], data["target"]["name"]) == ("a", "b")
    assert (unpacked(data["errors"][0]) == 0).all()
    with pytest.raises(InvalidInput, match="--force"):
        view(tmp_path / "m.npz", output=page)
    with pytest.raises(InvalidInput, match="up: expected x, y or z"):
        view(tmp_path / "none.npz", output=tmp_path / "other.html", up="w")
    with pytest.raises(InvalidInput, match="equally many"):
        view(tmp_path / "m.npz", output=page, identity=True, force=True)
    with pytest.raises(InvalidInput, match="expected vertices from 0 to 239"):
        view(tmp_path / "m.npz", output=page, truth=(b, a), force=True)


def test_mesh_is_where_the_map_says_or_asked_for(tmp_path: Path) -> None:
    nameless = Match(np.zeros(1, int))
    assert mesh_path(Path("given.off"), nameless, "source", tmp_path / "m.npz") == Path("given.off")
    with pytest.raises(InvalidInput, match="--source FILE"):
        mesh_path(None, nameless, "source", tmp_path / "m.npz")
    with pytest.raises(InvalidInput, match="nothing at"):
        mesh_path(None, Match(np.zeros(1, int), source_file=ShapeFile("no.off")), "source", tmp_path / "m.npz")


# The bundle -----------------------------------------------------------------------------------------------


def test_bundle_carries_the_licences_of_what_is_in_it() -> None:
    locked = json.loads((WEB / "package-lock.json").read_text(encoding="utf-8"))["packages"]
    notice = asset("viewer.LICENSE.txt")
    for name in ("three", "three-mesh-bvh"):
        assert f"{name} {locked[f'node_modules/{name}']['version']}" in notice
    assert notice.count("Permission is hereby granted") == 2


def test_bundle_can_stand_inside_a_script_element() -> None:
    assert "</script" not in asset("viewer.js").lower()
    assert "<!--" not in asset("viewer.js")


def test_bundle_is_built_from_the_sources() -> None:
    node = shutil.which("node")
    if node is None:
        pytest.skip("Node is not installed")
    if not (WEB / "node_modules" / "esbuild").is_dir():
        pytest.skip("run `npm ci` in web/ first")
    done = subprocess.run([node, "build.mjs", "--check"], cwd=WEB, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_colours_are_mixed_inside_triangles_where_the_map_has_points_there(pair: tuple) -> None:
    source, target, _ = pair
    faces = np.arange(len(target.vertices)) % len(source.faces)
    weights = np.tile([0.5, 0.3, 0.2], (len(faces), 1))
    found = Match(target_to_source=source.faces[faces, 0], precise_map=PointMap(faces, weights))
    data = page_data(plain_page(source, target, found))
    expected = np.einsum("j,tjc->tc", [0.5, 0.3, 0.2], position_colors(source)[source.faces[faces]])
    assert np.abs(unpacked(data["maps"][0]["colours"]) - 255 * expected).max() <= 0.5
    assert "colours" not in page_data(plain_page(source, target, found.target_to_source))["maps"][0]


def test_the_page_has_the_texture_of_the_source(pair: tuple[Mesh, Mesh, np.ndarray]) -> None:
    source, target, points = pair
    picture = encode_png(np.random.default_rng(0).random((2100, 30, 3)))
    file = MeshFile(source, None, np.random.default_rng(1).random((len(source.vertices), 2)), source.faces, picture)
    found = Match(points)
    own, carried = page_data(match_page(found, file, target, ("a", "b"), descriptors=False))["textures"]
    assert len(unpacked(own["corners"])) == 3 * len(source.faces)
    assert len(unpacked(carried["corners"])) == 3 * len(target.faces)
    for record in (own, carried):
        kind, _, data = record["picture"].partition(",")
        assert kind == "data:image/png;base64"
        assert decode_picture(Picture(base64.b64decode(data), "image/png")).shape[0] >= 2048
    assert page_data(plain_page(source, target, found))["textures"] == []
