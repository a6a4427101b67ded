"""Pictures, looked at by the pixel: the right colours in the right places, and nothing else."""

import io

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.text import Text
from scipy.spatial.transform import Rotation

from conftest import fibonacci_sphere
from kfmaps import viz
from kfmaps._arrays import InvalidInput
from kfmaps.geometry.mesh import Mesh
from kfmaps.viz.camera import _are_unlike, fit_rotation
from kfmaps.viz.figures import _oklab_to_rgb, make_transparent

RED, BLUE = np.array([0.9, 0.1, 0.1]), np.array([0.1, 0.2, 0.9])
FRONT = viz.view_from((0, 0, 1))


def ball(n: int = 700, center: tuple = (0.0, 0.0, 0.0), radius: float = 1.0) -> Mesh:
    sphere = fibonacci_sphere(n)
    return Mesh(radius * sphere.vertices + center, sphere.faces)


def blob() -> Mesh:
    """A lopsided shape: no two places of it look alike."""
    mesh = ball(500)
    x, y, z = mesh.vertices.T
    return Mesh(np.stack([x * (1 + 0.4 * y), 1.5 * y + 0.3 * z**2, 0.6 * z + 0.2 * x], axis=1), mesh.faces)


def pixels(figure: Figure) -> np.ndarray:
    """The figure's red, green and blue, (height, width, 3), 0 to 1."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[:, :, :3] / 255.0


def drawn(mesh: Mesh, colors: np.ndarray, view: viz.View = FRONT, **options) -> np.ndarray:
    figure = Figure(figsize=(2, 2), dpi=100, facecolor="white")
    viz.draw_surface(figure.add_axes((0, 0, 1, 1)), mesh, colors, view, **options)
    return pixels(figure)


def painted(mesh: Mesh, color: np.ndarray) -> np.ndarray:
    return np.tile(color, (len(mesh.vertices), 1))


def test_nothing_is_clipped_and_the_background_stays_white() -> None:
    for mesh in (blob(), ball()):
        picture = drawn(mesh, painted(mesh, BLUE))
        border = np.concatenate([picture[0], picture[-1], picture[:, 0], picture[:, -1]])
        assert (border == 1).all()
        rows, columns = np.nonzero((picture < 1).any(axis=2))
        assert max(np.ptp(rows), np.ptp(columns)) > 180, "the shape fills the axes"


def test_no_seams_between_faces(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("kfmaps.viz.surfaces._MIN_TRIANGLES", 24000)
    mesh = ball()
    picture = drawn(mesh, painted(mesh, BLUE), shading=False)
    y, x = np.mgrid[-1:1:200j, -1:1:200j]
    inside = np.hypot(x, y) < 0.9
    assert np.abs(picture[inside] - BLUE).max() < 0.01


def test_light_comes_from_the_upper_left() -> None:
    mesh = ball()
    picture = drawn(mesh, painted(mesh, np.full(3, 0.7))).mean(axis=2)
    assert picture[60, 60] > picture[100, 100] * 1.005 > picture[150, 150] * 1.1


def test_near_hides_far() -> None:
    near, far = ball(center=(0, 0, 2), radius=0.5), ball()
    both = Mesh(
        np.concatenate([far.vertices, near.vertices]), np.concatenate([far.faces, near.faces + len(far.vertices)])
    )
    colors = np.concatenate([painted(far, RED), painted(near, BLUE)])
    picture = drawn(both, colors, shading=False)
    np.testing.assert_allclose(picture[100, 100], BLUE, atol=0.03)
    np.testing.assert_allclose(picture[100, 30], RED, atol=0.03)
    behind = drawn(both, colors, viz.view_from((0, 0, -1)), shading=False)
    np.testing.assert_allclose(behind[100, 100], RED, atol=0.03)


def test_right_in_the_view_is_right_in_the_picture() -> None:
    mesh = ball()
    colors = np.where(mesh.vertices[:, :1] > 0, RED, BLUE)
    for towards, up, red in [((0, 0, 1), (0, 1, 0), 160), ((0, 0, -1), (0, 1, 0), 40)]:
        picture = drawn(mesh, colors, viz.view_from(towards, up), shading=False)
        np.testing.assert_allclose(picture[100, red], RED, atol=0.03)
    upright = drawn(mesh, colors, viz.view_from((0, 0, 1), (1, 0, 0)), shading=False)
    np.testing.assert_allclose(upright[40, 100], RED, atol=0.03)


def test_orientation_of_the_faces_does_not_matter() -> None:
    mesh = blob()
    colors = viz.position_colors(mesh)
    inward = Mesh(mesh.vertices, mesh.faces[:, ::-1])
    assert np.abs(drawn(mesh, colors) - drawn(inward, colors)).max() < 0.02


def test_the_inside_of_an_open_surface_shows() -> None:
    mesh = ball()
    bowl = Mesh(mesh.vertices, mesh.faces[(mesh.vertices[mesh.faces, 2] < 0.1).all(axis=1)])
    picture = drawn(bowl, painted(bowl, RED))
    assert picture[100, 100, 0] > 2 * picture[100, 100, 2]


def test_a_cloud_is_drawn_as_dots() -> None:
    cloud = Mesh(blob().vertices, np.zeros((0, 3)))
    picture = drawn(cloud, painted(cloud, RED))
    inked = (picture < 0.9).any(axis=2).mean()
    assert 0.02 < inked < 0.6


def test_colours_are_carried_by_the_map() -> None:
    source = blob()
    n = len(source.vertices)
    identity = pixels(viz.match_figure(source, source, np.arange(n)))
    order = np.random.default_rng(0).permutation(n)
    shuffled = Mesh(source.vertices[order], np.argsort(order)[source.faces])
    same = pixels(viz.match_figure(source, shuffled, order))
    assert np.abs(same - identity).max() < 0.03
    half = identity.shape[1] // 2
    left, right = identity[:, :half], identity[:, half:]
    body = slice(0, int(0.9 * len(left)))
    assert np.abs(left[body] - right[body]).mean() < 0.01, "equal shapes, equal panels"
    wrong = pixels(viz.match_figure(source, shuffled, np.arange(n)))
    assert np.abs(wrong[:, half:] - identity[:, half:]).mean() > 0.02
    np.testing.assert_allclose(wrong[:, : half - 20], identity[:, : half - 20], atol=0.03)


def test_error_panel_and_its_bar() -> None:
    source = blob()
    n = len(source.vertices)
    errors = np.where(source.vertices[:, 1] > 0, 0.2, 0.0)
    figure = viz.match_figure(source, source, np.arange(n), errors=errors, limit=0.2, title="A title")
    bar = figure.axes[-1]
    assert bar.get_ylim() == (0, 0.2)
    assert "% of √area" in bar.get_ylabel()
    ticks = bar.yaxis.get_major_formatter()
    assert [ticks(value, 0) for value in (0.0, 0.025, 0.15)] == ["0", "2.5", "15"]
    assert len(figure.axes) == 4
    assert len(viz.match_figure(source, source, np.arange(n)).axes) == 2
    calm = viz.match_figure(source, source, np.arange(n), errors=0 * errors, limit=0.2, title="A title")
    changed = np.abs(pixels(figure) - pixels(calm)).max(axis=2)
    width = changed.shape[1]
    assert changed[:, : width // 2].max() == 0
    assert changed[:, int(width * 0.6) :].mean() > 0.02
    top, bottom = changed[: len(changed) // 3], changed[-len(changed) // 4 :]
    assert top.max() > 0.3
    assert bottom.max() == 0


def test_error_colours_run_from_white_to_dark() -> None:
    colors = viz.error_colors(np.array([0, 0.02, 0.05, 0.1, 0.5]), limit=0.1)
    np.testing.assert_array_equal(colors[0], 1)
    np.testing.assert_array_equal(colors[3], colors[4])
    luminance = viz.error_colors(np.linspace(0, 1, 50), limit=1) @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(luminance) < 0).all()
    for errors, limit in (([np.nan, 0], 0.1), ([0.0, 1], 0.0)):
        with pytest.raises(InvalidInput):
            viz.error_colors(np.array(errors), limit)


def test_error_limit_is_a_round_number_above_nearly_all() -> None:
    rng = np.random.default_rng(0)
    for scale in (1e-3, 0.07, 4.0):
        errors = scale * rng.random(1000)
        limit = viz.error_limit(errors)
        top = np.percentile(errors, 99)
        assert top <= limit <= 2.01 * top
        assert limit == pytest.approx(float(f"{limit:.0e}"))
    assert viz.error_limit(np.zeros(5)) > 0
    assert viz.error_limit(np.full(5, 0.1)) == pytest.approx(0.1)


def test_position_colours_know_places_but_not_units() -> None:
    mesh = blob()
    colors = viz.position_colors(mesh)
    assert colors.min() >= 0
    assert colors.max() <= 1
    moved = Mesh(1000 * mesh.vertices + [5, -3, 2], mesh.faces)
    np.testing.assert_allclose(viz.position_colors(moved), colors, atol=1e-6)
    distance = np.linalg.norm(mesh.vertices[:, None] - mesh.vertices, axis=2)
    unlike = np.linalg.norm(colors[:, None] - colors, axis=2)
    assert unlike[distance > 1].min() > 0.05
    flat = Mesh(mesh.vertices * [1, 1, 0], mesh.faces)
    assert np.isfinite(viz.position_colors(flat)).all()


def test_oklab_has_its_greys_and_its_primaries() -> None:
    greys = _oklab_to_rgb(np.array([[0.0, 0, 0], [0.6, 0, 0], [1, 0, 0]]))
    np.testing.assert_allclose(greys, np.repeat(greys[:, :1], 3, axis=1), atol=1e-3)
    np.testing.assert_allclose(greys[[0, 2], 0], [0, 1], atol=1e-3)
    red_and_blue = np.array([[0.62796, 0.22486, 0.12585], [0.45201, -0.03246, -0.31153]])
    np.testing.assert_allclose(_oklab_to_rgb(red_and_blue), [[1, 0, 0], [0, 0, 1]], atol=6e-3)


def test_automatic_view_faces_the_broad_side() -> None:
    mesh = blob()
    for thin, up in ((0, None), (1, 2), (2, 1)):
        scale = np.ones(3)
        scale[thin] = 0.2
        flat = Mesh(mesh.vertices * scale, mesh.faces)
        view = viz.automatic_view(flat)
        assert view.towards[thin] > 0.9
        assert up is None or view.up[up] > 0.9
        moved = viz.automatic_view(Mesh(50 * flat.vertices + 7, flat.faces))
        np.testing.assert_allclose(moved.towards, view.towards, atol=1e-6)
        np.testing.assert_allclose(view.axes() @ view.axes().T, np.eye(3), atol=1e-12)
        assert np.linalg.det(view.axes()) > 0


def test_automatic_view_finds_a_tilted_plate() -> None:
    normal = np.array([1.0, 1.0, 1.0]) / np.sqrt(3)
    mesh = ball()
    plate = Mesh(mesh.vertices - 0.98 * np.outer(mesh.vertices @ normal, normal), mesh.faces)
    assert viz.automatic_view(plate).towards @ normal > 0.9


def test_a_shape_on_feet_is_drawn_upright() -> None:
    legs = [ball(100, (0, y, 0.0), 0.15) for y in (-1, 1)]
    parts = [ball(300, (0, y, 1.0), 0.4) for y in (-1, -0.5, 0, 0.5, 1)] + legs
    parts += [ball(100, (0, y, z), 0.15) for y in (-1, 1) for z in (0.2, 0.4, 0.6)]
    points = np.concatenate([p.vertices for p in parts])
    for up, places in ((2, points), (1, points[:, [0, 2, 1]])):
        view = viz.automatic_view(Mesh(places, np.zeros((0, 3))))
        assert view.towards[0] > 0.9
        assert view.up[up] > 0.9


def test_the_target_is_seen_from_the_same_side() -> None:
    source = blob()
    same = np.arange(len(source.vertices))
    angle = np.deg2rad(110)
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    turned = Mesh(source.vertices @ turn.T, source.faces)
    view = viz.view_from((1, 2, 3))
    followed = viz.following_view(view, source, turned, same)
    np.testing.assert_allclose(followed.towards, turn @ view.towards, atol=1e-9)
    np.testing.assert_allclose(followed.up, turn @ view.up, atol=1e-9)
    assert viz.following_view(view, source, source, same) is view
    colors = viz.position_colors(source)
    a, b = drawn(source, colors, view), drawn(turned, colors, followed)
    assert np.abs(a - b).mean() < 0.01
    mirrored = Mesh(source.vertices * [-1, 1, 1], source.faces)
    assert np.linalg.det(viz.following_view(view, source, mirrored, same).axes()) > 0


def test_a_pose_is_seen_from_the_side_that_the_map_says() -> None:
    """An arc and the arc bent the other way lie closer to each other upside down."""
    rng = np.random.default_rng(0)
    x, y, z = rng.uniform(-1, 1, 500), rng.uniform(-0.3, 0.3, 500), rng.uniform(-0.05, 0.05, 500)
    turn = Rotation.from_rotvec([0, 0, np.deg2rad(60)]).as_matrix()
    source, target = (Mesh(np.stack([x, y + bend * x**2, z], 1), np.zeros((0, 3))) for bend in (0.3, -0.3))
    view = viz.view_from((0, 0, 1))
    seen = viz.following_view(view, source, Mesh(target.vertices @ turn.T, target.faces), np.arange(500))
    assert seen.towards[2] > 0.9
    assert seen.up @ turn @ view.up > 0.9


def test_a_shape_of_another_kind_is_seen_from_the_side_that_the_map_says() -> None:
    places = (0, 0, 0), (0, 1, 0.4), (0, 0.5, 0)
    person = _body(*zip(((0.4, 0.8, 0.25), (0.1, 0.1, 0.4), (0.9, 0.1, 0.1)), places, strict=True))
    other = _body(*zip(((0.4, 0.8, 0.25), (0.2, 0.2, 0.5), (0.9, 0.05, 0.05)), places, strict=True))
    backwards = Mesh(other.vertices * [-1, 1, -1], other.faces)
    view, same = viz.automatic_view(person), np.arange(len(person.vertices))
    assert _are_unlike(person, backwards, same)
    seen = viz.following_view(view, person, backwards, same)
    np.testing.assert_allclose(seen.axes(), view.axes() * [-1, 1, -1], atol=0.01)


def _body(*parts: tuple[tuple[float, ...], tuple[float, ...]]) -> Mesh:
    """Ellipsoids of given half axes and places."""
    ball = fibonacci_sphere(300)
    faces = np.vstack([ball.faces + 300 * i for i in range(len(parts))])
    return Mesh(np.vstack([ball.vertices * size + np.array(place) for size, place in parts]), faces)


def test_shapes_of_different_kinds_are_both_upright() -> None:
    """An animal that stands on z and a person on y: the map, which lays one onto the other, does not turn the view."""
    legs = [((0.1, 0.1, 0.5), (x, y, -0.6)) for y in (-0.9, 0.9) for x in (-0.25, 0.25)]
    animal = _body(((0.35, 1.2, 0.35), (0, 0, 0)), *legs)
    lower = [((0.15, 0.9, 0.15), (x, -1.6, 0)) for x in (-0.3, 0.3)]
    upper = [((0.7, 0.1, 0.1), (x, 0.6, 0)) for x in (-0.9, 0.9)]
    person = _body(((0.4, 0.8, 0.25), (0, 0, 0)), *lower, *upper)
    same = np.arange(len(animal.vertices))
    view, own = viz.automatic_view(animal), viz.automatic_view(person)
    assert view.up[2] > 0.9
    assert own.up[1] > 0.9
    turn, alike = fit_rotation(*(x - x.mean(axis=0) for x in (animal.vertices, person.vertices)))
    assert alike > 0.6, "the map is believed"
    assert (turn @ view.up)[1] < 0.5, "and alone would lay the person down"
    assert viz.following_view(view, animal, person, same).up[1] > 0.9
    assert viz.following_view(own, person, animal, same).up[2] > 0.9


def test_another_kind_that_is_upside_down_in_its_file_is_turned_over() -> None:
    legs = [((0.12, 0.12, 0.5), (x, y, -0.6)) for y in (-0.9, 0.9) for x in (-0.25, 0.25)]
    animal = _body(((0.3, 1.2, 0.25), (0, 0, 0)), ((0.2, 0.3, 0.2), (0, 1.4, 0.4)), *legs)
    wider = np.exp(-animal.vertices[:, 1])
    other = Mesh(animal.vertices * np.stack([wider, *np.ones((2, len(wider)))], axis=1), animal.faces)
    over, same = Mesh(other.vertices * (1, -1, -1), other.faces), np.arange(len(wider))
    view = viz.automatic_view(animal)
    assert viz.automatic_view(over).up[2] > 0.9, "its own view shows it on its back"
    assert viz.following_view(view, animal, other, same).up[2] > 0.9
    seen = viz.following_view(view, animal, over, same)
    assert seen.up[2] < -0.9
    assert (view.axes()[0] @ (0, 1, 0)) * (seen.axes()[0] @ (0, -1, 0)) > 0.5, "the head is on the same side"


def test_saved_by_extension_and_the_same_bytes_each_time(tmp_path) -> None:
    mesh = blob()
    for kind, start in (("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")):
        files = [tmp_path / f"{i}.{kind}" for i in range(2)]
        for file in files:
            viz.save_figure(viz.match_figure(mesh, mesh, np.arange(len(mesh.vertices))), file)
        written = [file.read_bytes() for file in files]
        assert written[0].startswith(start)
        assert written[0] == written[1], kind
        stream = io.BytesIO()
        viz.save_figure(Figure(), stream, kind)
        assert stream.getvalue().startswith(start)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda _: viz.picture_format("map.gif"), "Rename"),
        (lambda _: viz.picture_format("map"), "no extension"),
        (lambda _: viz.save_figure(Figure(), io.BytesIO()), "no extension"),
        (lambda _: viz.save_figure(Figure(), io.BytesIO(), "gif"), "png, svg, pdf"),
        (lambda _: viz.view_from((0, 0, 0)), "apart"),
        (lambda _: viz.view_from((0, 2, 0), (0, 1, 0)), "apart"),
        (lambda _: viz.view_from((np.nan, 2, 0)), "towards"),
        (lambda m: viz.match_figure(m, m, np.arange(5)), "target_to_source"),
        (lambda m: viz.match_figure(m, m, np.full(len(m.vertices), -2)), "source vertices from 0"),
        (lambda m: viz.match_figure(m, m, np.full(len(m.vertices), 10**6)), "1000000"),
        (lambda m: viz.match_figure(m, m, np.full(len(m.vertices), 0.5)), "whole number"),
        (lambda m: viz.match_figure(m, m, np.arange(len(m.vertices)), errors=np.ones(3)), "errors"),
        (lambda m: drawn(m, np.ones((3, 3))), "colors"),
    ],
)
def test_bad_input_is_refused(make, message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        make(blob())


def test_a_transparent_figure_can_be_read_on_light_and_dark_pages() -> None:
    figure = viz.curves_figure([viz.Curve("a", np.array([0.0, 0.1]), np.array([0.2, 1.0]))])
    canvas = FigureCanvasAgg(make_transparent(figure))
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())
    assert (pixels[..., 3] == 0).mean() > 0.5

    def luminance(color) -> float:
        rgb = np.array(to_rgb(color))
        return float(np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4) @ [0.2126, 0.7152, 0.0722])

    for text in figure.findobj(Text):
        light = luminance(text.get_color()) + 0.05
        assert min(1.05 / light, light / (luminance("#14181e") + 0.05)) > 3  # WCAG 2.1 for large text and graphics
