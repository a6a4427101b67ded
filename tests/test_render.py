"""Figures for papers: error curves, grids of one source's colours, and the command that writes them."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.image import imread
from scipy.spatial import KDTree

from collecting import done, plan_of, write_collection
from commandline import run
from conftest import blob, fibonacci_sphere
from kfmaps._arrays import InvalidInput
from kfmaps.fmap.evaluate import geodesic_errors
from kfmaps.geometry.mesh import Mesh, surface_area
from kfmaps.io import load_map
from kfmaps.viz import (
    Curve,
    Panel,
    curves_figure,
    following_view,
    grid_figure,
    match_figure,
    mean_curve,
    painted_errors,
    save_figure,
    true_views,
)
from kfmaps.viz.camera import _MIN_CORRELATION, fit_rotation
from kfmaps.viz.matches import _LABEL

THRESHOLDS = np.linspace(0, 0.25, 11)


def png(figure: Figure) -> np.ndarray:
    file = BytesIO()
    save_figure(figure, file, "png")
    return imread(BytesIO(file.getvalue()))


# --- curves ------------------------------------------------------------------------------------------------------


def test_mean_curve_is_the_mean_with_its_band() -> None:
    curves = np.sort(np.random.default_rng(0).uniform(size=(50, 11)), axis=1)
    curve = mean_curve("a", THRESHOLDS, curves)
    np.testing.assert_allclose(curve.fractions, curves.mean(axis=0))
    assert curve.low is not None
    assert curve.high is not None
    inside = (curves >= curve.low) & (curves <= curve.high)
    np.testing.assert_allclose(inside.mean(axis=0), 0.8, atol=0.03)
    assert mean_curve("a", THRESHOLDS, curves[:1]).low is None
    with pytest.raises(InvalidInput, match="at least one pair"):
        mean_curve("a", THRESHOLDS, curves[:0])


def test_curves_are_drawn_as_they_are_and_told_apart() -> None:
    curves = [Curve(f"$run$ {i}", THRESHOLDS, np.linspace(0, 1 - i / 20, 11)) for i in range(5)]
    figure = curves_figure(curves, title="$x$")
    lines = figure.axes[0].lines
    for line, curve in zip(lines, curves, strict=True):
        np.testing.assert_array_equal(line.get_ydata(), curve.fractions)
    assert len({(str(line.get_color()), str(line.get_linestyle())) for line in lines}) == 5
    assert [t.get_text() for t in figure.legends[0].get_texts()] == [c.label for c in curves]
    assert png(figure).ndim == 3  # dollar signs are no formulas
    with pytest.raises(InvalidInput, match="at least one"):
        curves_figure([])


def test_the_legend_covers_no_data() -> None:
    figure = curves_figure([Curve(f"run {i}", THRESHOLDS, np.full(11, i / 5)) for i in range(6)])
    figure.draw_without_rendering()
    legend, axes = figure.legends[0].get_window_extent(), figure.axes[0].get_window_extent()
    assert legend.y1 < axes.y0


# --- grids -------------------------------------------------------------------------------------------------------


def panels(count: int, scale: float = 1.0) -> list[Panel]:
    mesh = blob(200)
    return [Panel(f"t{i}", Mesh(mesh.vertices * scale, mesh.faces), np.arange(200)) for i in range(count)]


def test_a_grid_carries_the_colours() -> None:
    """The same shape under the identity looks the same in every panel; under a constant map it has one colour."""
    mesh, colors = blob(200), np.random.default_rng(0).uniform(0.2, 0.8, size=(200, 3))
    constant = Panel("one", mesh, np.zeros(200, dtype=np.int64))
    figure = grid_figure(mesh, [*panels(1), constant], colors=colors)
    source, target, plain = (ax.collections[0] for ax in figure.axes)
    faces = [np.asarray(c.get_facecolor())[:, :3] for c in (source, target, plain)]
    np.testing.assert_array_equal(faces[0], faces[1])
    shade = faces[2] / colors[0]
    np.testing.assert_allclose(shade, shade[:, :1] * np.ones(3), rtol=1e-6)


@pytest.mark.parametrize("count", [1, 11])
def test_panels_lie_apart_and_inside(count: int) -> None:
    figure = grid_figure(blob(200), panels(count))
    boxes = [ax.get_position() for ax in figure.axes]
    assert len(boxes) == count + 1
    for i, a in enumerate(boxes):
        assert a.x0 >= 0
        assert a.y0 >= _LABEL / figure.get_figheight() * 0.99
        assert max(a.x1, a.y1) <= 1 + 1e-9
        assert not any(a.overlaps(b) for b in boxes[:i])


def test_shapes_of_one_area_are_drawn_at_one_scale() -> None:
    figure = grid_figure(blob(200), panels(1, 1000.0))
    small, large = (ax.get_xlim() for ax in figure.axes)
    np.testing.assert_allclose(np.array(large) / 1000, small, rtol=1e-9)
    stretched = blob(200)
    stretched = Mesh(stretched.vertices * [1, 3, 1], stretched.faces)
    figure = grid_figure(blob(200), [Panel("long", stretched, np.arange(200))])
    spans = [np.ptp(ax.get_ylim()) for ax in figure.axes]
    areas = [np.sqrt(surface_area(mesh)) for mesh in (blob(200), stretched)]
    assert spans[1] / spans[0] == pytest.approx(areas[1] / areas[0])
    for ax in figure.axes:  # nothing is cut off
        (drawn,) = (c for c in ax.collections if isinstance(c, PolyCollection))
        points = np.concatenate([path.vertices for path in drawn.get_paths()])
        assert points[:, 1].min() >= ax.get_ylim()[0]
        assert points[:, 1].max() <= ax.get_ylim()[1]


def test_bad_grids() -> None:
    with pytest.raises(InvalidInput, match="at least one target"):
        grid_figure(blob(200), [])
    for points in (np.arange(199), np.full(200, 200), np.full(200, -2)):
        with pytest.raises(InvalidInput, match="map to x"):
            grid_figure(blob(200), [Panel("x", blob(200), points)])


# --- errors ------------------------------------------------------------------------------------------------------


def test_painted_errors_are_the_errors_where_the_truth_is_known() -> None:
    mesh = blob(200)
    rng = np.random.default_rng(0)
    points, known = rng.integers(0, 200, 200), rng.permutation(200)[:60]
    truth = rng.integers(0, 200, 60)
    painted = painted_errors(mesh, mesh, points, truth, known)
    np.testing.assert_allclose(painted[known], geodesic_errors(mesh, points[known], truth))
    unknown = np.setdiff1d(np.arange(200), known)
    distance = np.linalg.norm(mesh.vertices[unknown][:, None] - mesh.vertices[known], axis=2)
    np.testing.assert_array_equal(painted[unknown], painted[known[distance.argmin(axis=1)]])


def test_an_endless_error_is_painted_as_a_large_one() -> None:
    mesh = blob(200)
    two = Mesh(np.concatenate([mesh.vertices, mesh.vertices + 5]), np.concatenate([mesh.faces, mesh.faces + 200]))
    points = np.arange(400)
    points[0] = 300
    painted = painted_errors(two, two, points, np.arange(400), np.arange(400))
    assert np.isfinite(painted).all()
    assert painted[0] == painted.max() >= 1
    assert not painted[1:].any()


def _centred(points: np.ndarray) -> np.ndarray:
    return points - points.mean(axis=0)


def test_views_follow_the_truth_and_not_a_map_that_confuses_back_and_front() -> None:
    """A map that confuses back and front of shapes that lie alike does not turn the camera."""
    mesh = blob(200)
    turned = Mesh(mesh.vertices @ np.diag([-1.0, 1, -1]), mesh.faces)
    everywhere = np.arange(200)
    seen, followed = true_views(mesh, turned, everywhere, everywhere)
    np.testing.assert_allclose(followed.towards, seen.towards * [-1, 1, -1], atol=1e-6)
    np.testing.assert_allclose(followed.up, seen.up * [-1, 1, -1], atol=1e-6)
    nonsense = np.random.default_rng(0).permutation(200)
    found = following_view(seen, mesh, turned, nonsense)  # by the shapes alone
    np.testing.assert_allclose(found.axes(), followed.axes(), atol=1e-6)
    x, y, z = fibonacci_sphere(200).vertices.T
    body = Mesh(np.stack([x, 2 * y, 0.5 * z + 0.2 * (y > 0.5)], 1), mesh.faces)
    back_for_front = np.asarray(KDTree(body.vertices).query(body.vertices * [-1, 1, -1])[1])
    assert following_view(seen, body, body, back_for_front) is seen
    turn, alike = fit_rotation(_centred(body.vertices[back_for_front]), _centred(body.vertices))
    assert alike > _MIN_CORRELATION, "the map alone says that the camera should go round"
    assert np.trace(turn) < 0
    part = mesh.vertices[:, 0] > 0  # it lies turned, elsewhere
    for rows in (np.flatnonzero(part), np.where(part, np.arange(200), -1)):
        found = Mesh(turned.vertices[part if len(rows) < 200 else slice(None)] + 3, np.zeros((0, 3), int))
        np.testing.assert_allclose(following_view(seen, mesh, found, rows).axes(), followed.axes(), atol=1e-6)
    figure = match_figure(mesh, turned, nonsense, view=seen, target_view=followed)
    own, same = (ax.get_xlim() for ax in figure.axes[:2])
    np.testing.assert_allclose(own, same, atol=1e-6)


# --- the command -------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def output(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The output folder of a run over three shapes."""
    folder = write_collection(tmp_path_factory.mktemp("shapes"))
    out = tmp_path_factory.mktemp("out")
    done(plan_of(folder, out))
    return out


@pytest.fixture
def render(tmp_path: Path) -> Callable[..., Path]:
    """Runs the command and gives the file it wrote."""

    def draw(*arguments: object, name: str = "figure.png") -> Path:
        ran = run("render", *arguments, "-o", tmp_path / name)
        if ran.status:
            raise InvalidInput(ran.error)
        return tmp_path / name

    return draw


def test_every_kind_of_figure(output: Path, render: Callable[..., Path]) -> None:
    for arguments, kind, start in (
        (("pair", output / "maps" / "b0-b1.npz", "--title", "$a"), "pdf", b"%PDF"),
        (("grid", output, "--source", "b0"), "svg", b"<?xml"),
        (("curves", output), "png", b"\x89PNG"),
    ):
        assert render(*arguments, name=f"figure.{kind}").read_bytes().startswith(start)
    with pytest.raises(InvalidInput, match="--force"):
        render("curves", output, name="figure.png")


def test_a_pair_with_its_error(output: Path, render: Callable[..., Path]) -> None:
    settings = (output / "maps" / "b0-b1.npz", "--from", 1, 0, 0, "--up", 0, 0, 1)
    plain = render("pair", *settings, name="plain.png")
    (truth,) = {p.parent for p in Path(load_map(settings[0]).source_file.path).parent.glob("corres/*.vts")}
    lists = (truth / "b0.vts", truth / "b1.vts")
    with_error = render("pair", *settings, "--truth", *lists, "--limit", 10, name="error.png")
    assert imread(with_error).shape[1] > imread(plain).shape[1]
    with pytest.raises(InvalidInput, match="--from beside it"):
        render("pair", settings[0], "--up", 0, 0, 1, name="other.png")


def test_resolution_and_targets_by_name(output: Path, render: Callable[..., Path]) -> None:
    fine, coarse = (imread(render("curves", output, "--dpi", dpi, name=f"{dpi}.png")) for dpi in (300, 100))
    assert fine.shape[0] == pytest.approx(3 * coarse.shape[0], abs=3)
    both, one = (
        imread(render("grid", output, "--source", "b0", *more, "--columns", 3, name=name))
        for more, name in (((), "two.png"), (("--targets", "b2"), "one.png"))
    )
    assert both.shape[1] == pytest.approx(1.5 * one.shape[1], abs=2)


def test_render_refuses_bad_arguments(output: Path, tmp_path: Path, render: Callable[..., Path]) -> None:
    for arguments, message in (
        (("grid", output, "--source", "x"), "matched as a source"),
        (("grid", output, "--source", "b0", "--targets", "b9"), "b9"),
        (("grid", tmp_path, "--source", "b0"), "output folder of kfmaps batch"),
        (("curves", output, "--labels", "a,b"), "1 names"),
        (("pair", output / "maps" / "b0-b9.npz"), "b0-b9"),
    ):
        with pytest.raises(InvalidInput, match=message):
            render(*arguments)
    with pytest.raises(InvalidInput, match=r"\.svg"):
        render("curves", output, name="figure.gif")
    assert not list(tmp_path.glob("figure*"))
