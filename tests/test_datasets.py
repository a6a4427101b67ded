"""The generated shapes: closed, well shaped, seeded, and with a correspondence that is true."""

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import KDTree

from kfmaps import datasets
from kfmaps._arrays import InvalidInput, NotConverged
from kfmaps.datasets import ExamplePair, largest_piece, skeleton, surface
from kfmaps.datasets.creature import CREATURE, SYMMETRIC, WAVE
from kfmaps.datasets.skeleton import Bend, Body
from kfmaps.datasets.surface import closed_mesh
from kfmaps.geometry.mesh import Mesh, face_areas, face_normals, surface_area, vertex_normals

GUARDS = ("kfmaps.geometry.topology",)

BODY = Body(CREATURE)
COUNT = 1500
PAIRS = ("two_poses", "non_isometric", "partial", "symmetric_creature")


@pytest.fixture(scope="module")
def points() -> np.ndarray:
    """Of the surface of the unbent creature."""
    return closed_mesh(BODY, BODY.box(), 1500, np.random.default_rng(0))[0]


@pytest.fixture(scope="module")
def pairs() -> dict[str, ExamplePair]:
    return {name: getattr(datasets, name)(COUNT, rng=7) for name in PAIRS}


def edges(faces: np.ndarray) -> np.ndarray:
    """Each edge once, (e, 2)."""
    both = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return np.unique(both, axis=0)


def characteristic(mesh: Mesh) -> int:
    return len(np.unique(mesh.faces)) - len(edges(mesh.faces)) + len(mesh.faces)


def rim(faces: np.ndarray) -> np.ndarray:
    """Directed edges that no other face runs through the other way, (r, 2)."""
    forth = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    back = {(b, a) for a, b in forth.tolist()}
    return np.array([e for e in forth.tolist() if tuple(e) not in back], dtype=np.int64).reshape(-1, 2)


def volume(mesh: Mesh) -> float:
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    return float((a * np.cross(b, c)).sum() / 6)


def smallest_angles(mesh: Mesh) -> np.ndarray:
    corners = mesh.vertices[mesh.faces]
    ahead, behind = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    cosine = (ahead * behind).sum(axis=2) / np.linalg.norm(ahead, axis=2) / np.linalg.norm(behind, axis=2)
    return np.rad2deg(np.arccos(np.clip(cosine, -1, 1))).min(axis=1)


def exact_places(pair: ExamplePair) -> np.ndarray:
    """Where each target vertex truly is on the source, (n_t, 3)."""
    corners = pair.source.vertices[pair.source.faces[pair.truth_faces]]
    return (corners * pair.truth_weights[:, :, None]).sum(axis=1)


def length_ratios(pair: ExamplePair) -> np.ndarray:
    """Length on the source over length on the target of each target edge."""
    e, places = edges(pair.target.faces), exact_places(pair)
    there = np.linalg.norm(np.diff(pair.target.vertices[e], axis=1), axis=2)
    return (np.linalg.norm(np.diff(places[e], axis=1), axis=2) / there).ravel()


def path_lengths(mesh: Mesh, starts: np.ndarray) -> np.ndarray:
    e = edges(mesh.faces)
    length = np.linalg.norm(np.diff(mesh.vertices[e], axis=1), axis=2).ravel()
    graph = coo_array((length, (e[:, 0], e[:, 1])), shape=(len(mesh.vertices),) * 2).tocsr()
    return dijkstra(graph, directed=False, indices=starts)


def facing(pair: ExamplePair, point_map: np.ndarray) -> float:
    """Share of the target's area whose image on the source is not turned inside out.

    Not all of it even under the truth: where neighbours go to one vertex, a triangle has no side.
    """
    a, b, c = (pair.source.vertices[point_map[pair.target.faces[:, i]]] for i in range(3))
    outward = vertex_normals(pair.source)[point_map[pair.target.faces]].sum(axis=1)
    sign = (np.cross(b - a, c - a) * outward).sum(axis=1) > 0
    return float(np.average(sign, weights=face_areas(pair.target)))


def check_paths(pair: ExamplePair, truth: np.ndarray) -> None:
    """A map keeps the lengths of long paths, nearly."""
    starts = np.random.default_rng(1).choice(len(truth), 12, replace=False)
    there = path_lengths(pair.target, starts)
    far = there > 0.5
    here = path_lengths(pair.source, truth[starts])[:, truth]
    assert np.abs(here[far] / there[far] - 1).mean() < 0.09


@pytest.mark.parametrize("name", PAIRS)
def test_closed_oriented_genus_zero(pairs: dict[str, ExamplePair], name: str) -> None:
    pair = pairs[name]
    for mesh in (pair.source,) if name == "partial" else (pair.source, pair.target):
        assert len(rim(mesh.faces)) == 0
        assert characteristic(mesh) == 2
        assert volume(mesh) > 0
        assert len(np.unique(mesh.faces)) == len(mesh.vertices)


@pytest.mark.parametrize("name", PAIRS)
def test_triangles_are_well_shaped(pairs: dict[str, ExamplePair], name: str) -> None:
    for mesh in (pairs[name].source, pairs[name].target):
        angles = smallest_angles(mesh)
        assert np.percentile(angles, 1) > 15
        assert np.median(angles) > 35


def test_same_seed_same_shape_other_seed_other_shape(poses: ExamplePair) -> None:
    one, other = datasets.two_poses(1500, rng=np.random.default_rng(2)), datasets.two_poses(1500, rng=4)
    np.testing.assert_array_equal(one.target.vertices, poses.target.vertices)
    np.testing.assert_array_equal(one.target.faces, poses.target.faces)
    np.testing.assert_array_equal(one.truth, poses.truth)
    assert not np.allclose(one.source.vertices, other.source.vertices)


@pytest.mark.parametrize("name", PAIRS)
def test_truth_is_the_vertex_nearest_to_the_exact_place(pairs: dict[str, ExamplePair], name: str) -> None:
    pair = pairs[name]
    assert pair.truth.shape == pair.truth_faces.shape == (len(pair.target.vertices),)
    np.testing.assert_allclose(pair.truth_weights.sum(axis=1), 1)
    assert pair.truth_weights.min() >= 0
    places = exact_places(pair)
    distance = np.linalg.norm(pair.source.vertices[pair.truth] - places, axis=1)
    corners = pair.source.vertices[pair.source.faces[pair.truth_faces]]
    nearest = np.linalg.norm(corners - places[:, None], axis=2).min(axis=1)
    # The exact place is on the smooth surface, a little beside the flat face.
    spacing = np.sqrt(surface_area(pair.source) / len(pair.source.vertices))
    assert (distance <= nearest + 0.1 * spacing).mean() > 0.995
    assert distance.max() < 1.2 * spacing


@pytest.mark.parametrize("name", ["two_poses", "symmetric_creature", "partial"])
def test_poses_are_nearly_isometric(pairs: dict[str, ExamplePair], name: str) -> None:
    ratios = length_ratios(pairs[name])
    assert abs(ratios.mean() - 1) < 0.02
    assert ratios.std() < 0.13
    assert np.mean((ratios > 0.8) & (ratios < 1.25)) > 0.93


def test_other_proportions_are_not_isometric(pairs: dict[str, ExamplePair]) -> None:
    low, high = np.percentile(length_ratios(pairs["non_isometric"]), [5, 95])
    assert low < 0.75
    assert high > 1.15


def test_meshes_are_independent(pairs: dict[str, ExamplePair]) -> None:
    pair = pairs["two_poses"]
    largest = pair.truth_weights.max(axis=1)
    assert (largest > 0.99).mean() < 0.02, "target vertices are source vertices"
    assert len(np.unique(pair.truth_faces)) > 0.3 * len(pair.source.faces)
    # A random place in a triangle has a largest barycentric coordinate of 11/18 on average.
    assert abs(largest.mean() - 11 / 18) < 0.03


def test_poses_differ_by_more_than_a_rigid_motion(pairs: dict[str, ExamplePair]) -> None:
    pair = pairs["two_poses"]
    a, b = exact_places(pair), pair.target.vertices
    a, b = a - a.mean(axis=0), b - b.mean(axis=0)
    u, _, vt = np.linalg.svd(a.T @ b)
    left = np.linalg.norm(a @ (u @ vt) - b, axis=1).mean()
    assert left > 0.05 * np.sqrt(surface_area(pair.target))


def test_creature_has_no_mirror_image_in_itself(points: np.ndarray) -> None:
    beside = np.abs(BODY(points * [-1, 1, 1])[0])
    assert (beside > 0.03).mean() > 0.2
    lengths = {
        limb.name: np.linalg.norm(np.diff(np.array(limb.balls)[:, :3], axis=0), axis=1).sum() for limb in CREATURE
    }
    for part in ("ear", "arm", "leg", "foot"):
        ratio = lengths[f"left {part}"] / lengths[f"right {part}"]
        assert max(ratio, 1 / ratio) > 1.2, part


def test_the_symmetric_creature_has_two_truths_and_the_other_one(pairs: dict[str, ExamplePair]) -> None:
    pair = pairs["symmetric_creature"]
    assert pair.mirrored is not None
    assert pairs["two_poses"].mirrored is None
    body = Body(SYMMETRIC)
    points = np.random.default_rng(0).uniform(BODY.box()[0], BODY.box()[1], (500, 3))
    np.testing.assert_allclose(body(points)[0], body(points * [-1, 1, 1])[0], atol=1e-7)

    check_paths(pair, pair.mirrored)
    assert facing(pair, pair.mirrored) < 0.15
    for name in ("two_poses", "symmetric_creature"):
        check_paths(pairs[name], pairs[name].truth)
        assert facing(pairs[name], pairs[name].truth) > 0.85
    aside = np.linalg.norm(pair.source.vertices[pair.truth] - pair.source.vertices[pair.mirrored], axis=1)
    assert np.median(aside) > 0.2


@pytest.mark.parametrize("name", ["two_poses", "non_isometric", "symmetric_creature"])
def test_the_skin_does_not_touch_itself(pairs: dict[str, ExamplePair], name: str) -> None:
    for mesh in (pairs[name].source, pairs[name].target):
        normals = vertex_normals(mesh)
        near = KDTree(mesh.vertices).query_pairs(0.1, output_type="ndarray")
        gaps = mesh.vertices[near[:, 1]] - mesh.vertices[near[:, 0]]
        across = (normals[near[:, 0]] * normals[near[:, 1]]).sum(axis=1) < -0.5
        outside = (gaps * normals[near[:, 0]]).sum(axis=1) > 0
        between = np.linalg.norm(gaps[across & outside], axis=1)
        assert between.min(initial=1.0) > 0.02, "two limbs are about to touch"


def test_partial_is_one_manifold_piece_of_the_whole(pairs: dict[str, ExamplePair]) -> None:
    whole, part = pairs["two_poses"], datasets.partial(COUNT, rng=7, kept=0.5)
    np.testing.assert_array_equal(whole.source.vertices, part.source.vertices)
    mesh = part.target
    border = rim(mesh.faces)
    assert len(border) > 10
    leaving, arriving = np.bincount(border[:, 0]), np.bincount(border[:, 1])
    np.testing.assert_array_equal(leaving, arriving)
    assert leaving.max() == 1, "two corners of the rim touch"
    e = edges(mesh.faces)
    n = len(mesh.vertices)
    assert connected_components(coo_array((np.ones(len(e)), (e[:, 0], e[:, 1])), shape=(n, n)))[0] == 1
    assert 0.3 * surface_area(whole.target) < surface_area(mesh) < 0.52 * surface_area(whole.target)
    old = {tuple(v): i for i, v in enumerate(whole.target.vertices.tolist())}
    numbers = [old[tuple(v)] for v in mesh.vertices.tolist()]
    np.testing.assert_array_equal(part.truth, whole.truth[numbers])
    np.testing.assert_array_equal(part.truth_faces, whole.truth_faces[numbers])


def test_two_holes_that_touch_become_one() -> None:
    mesh = datasets.sphere(800)
    around = {int(b) for e in edges(mesh.faces) if 0 in e for b in e} - {0}
    linked = {tuple(e) for e in edges(mesh.faces).tolist()}
    far = [(a, b) for a in around for b in around if a < b and (a, b) not in linked]
    distance = [np.linalg.norm(mesh.vertices[a] - mesh.vertices[b]) for a, b in far]
    keep = np.ones(len(mesh.vertices), dtype=bool)
    keep[list(far[int(np.argmax(distance))])] = False
    whole_stars = mesh.faces[keep[mesh.faces].all(axis=1)]
    assert np.bincount(rim(whole_stars)[:, 0]).max() == 2, "both holes have a corner at vertex 0"
    part, old = largest_piece(mesh, keep)
    border = rim(part.faces)
    assert np.bincount(border[:, 0]).max() == np.bincount(border[:, 1]).max() == 1
    np.testing.assert_array_equal(part.vertices, mesh.vertices[old])
    assert 0 not in old
    assert characteristic(part) == 1


@pytest.mark.parametrize(
    ("make", "name"),
    [
        (lambda: datasets.two_poses(100), "vertices"),
        (lambda: datasets.non_isometric(10**6), "vertices"),
        (lambda: datasets.symmetric_creature(1500.5), "vertices"),  # type: ignore[arg-type]
        (lambda: datasets.partial(1500, kept=1.5), "kept"),
        (lambda: datasets.sphere(3), "vertices"),
        (lambda: datasets.torus(100), "vertices"),
        (lambda: datasets.torus(900, tube=1.0), "tube"),
    ],
)
def test_bad_sizes_are_refused(make, name: str) -> None:
    with pytest.raises(InvalidInput, match=f"^{name}: expected"):
        make()


# What the shapes are made of: fields, bending, closed meshes through points


def test_field_is_negative_inside_and_its_gradient_is_its_derivative() -> None:
    points = np.random.default_rng(0).uniform(BODY.box()[0], BODY.box()[1], (2000, 3))
    values, gradients = BODY(points)
    near = np.abs(values) < 0.1
    steps = 1e-6 * np.eye(3)
    numeric = np.stack([(BODY(points + s)[0] - BODY(points - s)[0]) / 2e-6 for s in steps], axis=1)
    difference = np.abs(numeric - gradients).max(axis=1)[near]
    assert np.percentile(difference, 98) < 1e-6, "all but points above a kink of the radius"
    middles = np.array([limb.balls[1][:3] for limb in CREATURE])
    assert (BODY(middles)[0] < 0).all()
    assert BODY(np.array([[0.5, 0.2, 0.3]]))[0][0] > 0


def test_bending_nothing_is_the_identity_and_growing_all_is_a_similarity(points: np.ndarray) -> None:
    np.testing.assert_allclose(BODY.bend(points, {}), points, atol=1e-12)
    grown = BODY.bend(points, {limb.name: Bend(longer=2, thicker=2) for limb in CREATURE})
    np.testing.assert_allclose(grown - grown[0], 2 * (points - points[0]), atol=1e-12)


def test_only_the_bent_limb_and_what_it_carries_moves(points: np.ndarray) -> None:
    moved = np.linalg.norm(BODY.bend(points, {"left arm": WAVE["left arm"]}) - points, axis=1)
    assert moved[points[:, 0] > 0.75].min() > 0.3
    away = (points[:, 0] < -0.3) | (points[:, 1] < 0.4)
    assert moved[away].max() < 0.01


def test_wrong_genus_is_reported() -> None:
    def ring(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        radius = np.hypot(points[:, 0], points[:, 1])
        away = points - points * [1, 1, 0] / radius[:, None]
        length = np.linalg.norm(away, axis=1)
        return length - 0.4, away / length[:, None]

    box = np.array([[-1.5, -1.5, -0.5], [1.5, 1.5, 0.5]])
    assert len(closed_mesh(ring, box, 400, np.random.default_rng(0), genus=1)[0]) == 400
    with pytest.raises(NotConverged, match="Ask for more vertices"):
        closed_mesh(ring, box, 400, np.random.default_rng(0), genus=0)


def test_sphere_has_its_radius_and_its_area() -> None:
    ball = datasets.sphere(400)
    np.testing.assert_allclose(np.linalg.norm(ball.vertices, axis=1), 1, rtol=1e-9)
    lack = [1 - surface_area(m) / (4 * np.pi) for m in (ball, datasets.sphere(1600))]
    assert lack[0] > 0
    assert lack[0] / lack[1] == pytest.approx(4, rel=0.15), "the lack of area falls as one over the number"


def test_torus_has_its_area() -> None:
    assert surface_area(datasets.torus(900)) == pytest.approx(4 * np.pi**2 * 0.4, rel=0.02)
    assert surface_area(datasets.torus(900, tube=0.6)) == pytest.approx(4 * np.pi**2 * 0.6, rel=0.02)


@pytest.mark.parametrize("count", [801, 802, 803, 804, 3500])
def test_subdivided_meshes_are_as_good(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(surface, "_SCATTERED", 400)
    for mesh, genus in ((datasets.sphere(count), 0), (datasets.torus(count), 1)):
        assert len(mesh.vertices) == count
        assert surface._is_closed(mesh, genus)
        edges = np.linalg.norm(mesh.vertices[mesh.faces] - mesh.vertices[np.roll(mesh.faces, 1, axis=1)], axis=2)
        assert (edges.max(axis=1) / edges.min(axis=1)).max() < 4
        outside = (face_normals(mesh) * vertex_normals(mesh)[mesh.faces[:, 0]]).sum(axis=1)
        assert outside.min() > 0.5
    np.testing.assert_allclose(np.linalg.norm(datasets.sphere(count).vertices, axis=1), 1, rtol=1e-12)


def test_working_in_blocks_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    points = np.random.default_rng(0).uniform(BODY.box()[0], BODY.box()[1], (2500, 3))
    one = (*BODY(points), BODY.bend(points, WAVE))
    monkeypatch.setattr(skeleton, "_BLOCK", 999)
    monkeypatch.setattr(skeleton, "_MAX_POINTS", 999)
    for a, b in zip(one, (*BODY(points), BODY.bend(points, WAVE)), strict=True):
        np.testing.assert_allclose(a, b, atol=1e-12)
