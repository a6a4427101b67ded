"""The page of a result in a real browser."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scipy.spatial import KDTree

from chromium import NASTY, Browser, Keys, needs_browser
from conftest import fibonacci_sphere
from kfmaps.config import Config
from kfmaps.datasets import ExamplePair
from kfmaps.evaluation import Truth
from kfmaps.fmap.confidence import local_confidence
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import MeshFile
from kfmaps.io.bake import encode_png
from kfmaps.kernels.kernels import Gaussian
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import MatchFit, MatchScore
from kfmaps.viz import result_pages
from kfmaps.viz.result_pages import cell_html, match_page

pytest_plugins = ["chromium"]
pytestmark = needs_browser

CHOOSE_MAP = "const m = document.getElementById('map'); m.value = arguments[0]; m.dispatchEvent(new Event('change'))"


@pytest.fixture
def page(browser: Browser, poses: ExamplePair, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Browser:
    """The page of the true map, everything switched on, opened from the disk."""
    n_t = len(poses.truth)
    monkeypatch.setattr(result_pages, "vertex_errors", lambda *_: np.linspace(0, 0.2, n_t)[None])
    monkeypatch.setattr(result_pages, "signatures", lambda *_: (poses.source.vertices, poses.target.vertices))
    found = Match(
        poses.truth,
        functional_map=np.random.default_rng(0).normal(size=(20, 30)),
        local_confidence=np.linspace(0, 1, n_t),
        alternatives=(np.roll(poses.truth, 1),),
        verdict="ambiguous",
        confidence=0.25,
        score=MatchScore(scores=(-1.5, -1.625)),
        fit=MatchFit(residuals=np.array([1, 0.1, 0.01]), energies={NASTY: 2.0}, kernel=NASTY),
        seconds={"solve": 1.5},
        config=Config(kernel=Gaussian(500.0)),
    )
    truth = Truth(poses.truth, np.arange(n_t))
    html = match_page(found, poses.source, poses.target, (NASTY, "b"), truth=truth)
    browser.show(html, tmp_path)
    return browser


def test_page_from_the_disk_asks_for_nothing_else(page: Browser, tmp_path: Path) -> None:
    for mode in ("texture", "descriptor", "error", "distortion", "difference", "confidence", "colours"):
        page.mode(mode)
    page.element("#picture").click()
    page.point("target", page.visible("target", np.arange(300), 1)[0])
    assert page.requests() == [(tmp_path / "page.html").as_uri()]
    assert page.run("return performance.getEntriesByType('resource').length") == 0
    # Names and settings are only text.
    assert page.text("name-source") == NASTY
    assert page.run("return document.title") == f"{NASTY} → b"
    page.until(lambda: NASTY in page.text("energies") and NASTY in page.text("other"))
    assert page.run("return document.querySelectorAll('script, b').length") == 2
    assert page.complaints() == []


def test_pointing_shows_matches(page: Browser, poses: ExamplePair) -> None:
    """Of a target vertex, of a source vertex all that land there or on the nearest that is reached, of another map."""
    for vertex in page.visible("target", np.arange(0, len(poses.truth), 7), 4):
        page.point("target", vertex)
        page.until(lambda v=vertex: page.text("readout").startswith(f"target {v} → source {poses.truth[v]},"))
        assert page.run("return kfmaps.marks('source')") == [poses.truth[vertex]]
        assert page.run("return kfmaps.marks('target')") == [vertex]
    count = np.bincount(poses.truth, minlength=len(poses.source.vertices))
    for vertex in page.visible("source", np.flatnonzero(count >= 2), 3):
        landing = np.flatnonzero(poses.truth == vertex)
        page.point("source", vertex)
        text = f"source {vertex} ← target {', '.join(map(str, landing))}"
        page.until(lambda text=text: page.text("readout") == text)
        assert sorted(page.run("return kfmaps.marks('target')")) == landing.tolist()
    missed = np.setdiff1d(np.arange(len(poses.source.vertices)), poses.truth)
    page.point("source", page.visible("source", missed, 1)[0])
    output = page.until(lambda: re.search(r"← target (\d+).*nearest that has one is (\d+)", page.text("readout")))
    assert poses.truth[int(output[1])] == int(output[2])
    page.run(CHOOSE_MAP, "1")
    vertex = page.visible("target", np.arange(len(poses.truth)), 1)[0]
    page.point("target", vertex, click=True)
    page.until(lambda: page.text("pinned").startswith(f"target {vertex} → source {np.roll(poses.truth, 1)[vertex]}"))


def test_colours_and_texture_are_carried_by_the_map(browser: Browser, poses: ExamplePair, tmp_path: Path) -> None:
    views = {}
    identity = np.arange(len(poses.source.vertices))
    for name, points in (("same", identity), ("other", identity[::-1].copy())):
        browser.show(match_page(Match(points), poses.source, poses.source, descriptors=False), tmp_path)
        if browser.element("#aligned").is_selected():
            browser.element("#aligned").click()  # both lie alike, so the pictures differ by the map alone
        for mode in ("colours", "texture"):
            browser.mode(mode)
            browser.painted()
            boxes = [browser.element(f"#view-{side}") for side in ("source", "target")]
            first, second = (browser.picture(box)[60:, 10:-10] for box in boxes)
            width = min(first.shape[1], second.shape[1])
            views[name, mode] = (np.abs(first[:, :width] - second[:, :width]).max(axis=2) > 24).mean()
            assert (np.ptp(first, axis=2) > 40).mean() > 0.02  # there is something colourful to compare
    for mode in ("colours", "texture"):
        assert views["same", mode] < 0.01
        assert views["other", mode] > 0.05


def test_arrow_keys_turn_both_views_or_one_and_the_turntable_until_it_is_switched_off(page: Browser) -> None:
    vertex = page.visible("target", np.arange(300), 1)[0]
    places = [page.place("target", vertex)]
    for linked in (True, False):
        if page.element("#linked").is_selected() != linked:
            page.element("#linked").send_keys(Keys.SPACE)
        page.element("#view-source").send_keys(Keys.ARROW_RIGHT * 3)
        places.append(page.place("target", vertex))
    assert places[1] != places[0]
    assert places[2] == places[1]
    page.element("#reset").send_keys(Keys.ENTER)
    assert page.place("target", vertex) == places[0]
    page.element("#spin").click()
    assert page.element("#spin").get_attribute("aria-pressed") == "true"
    page.until(lambda: page.place("target", vertex) != places[0])
    page.element("#spin").click()
    page.painted()
    still = page.place("target", vertex)
    page.painted()
    assert page.place("target", vertex) == still


def test_everything_can_be_reached_by_keyboard_and_has_a_name(page: Browser) -> None:
    reached = []
    for _ in range(40):
        page.driver.switch_to.active_element.send_keys(Keys.TAB)
        focused = page.driver.switch_to.active_element
        if focused.tag_name == "body":
            break
        assert focused.accessible_name.strip(), focused.get_attribute("outerHTML")
        reached.append(focused.get_attribute("id") or focused.get_attribute("name"))
    wanted = "linked aligned up spin reset picture mode map view-source goto-source view-target goto-target"
    assert [name for name in reached if name in wanted.split()] == wanted.split()
    assert page.element("#view-source").accessible_name == f"3D view of the source, {NASTY}"
    page.until(lambda: page.element("#matrix").is_displayed())
    assert "20 target by 30 source" in page.element("#matrix").accessible_name
    assert "from 1 to 0.01 in 2 steps" in page.element(".chart").accessible_name


def test_a_vertex_can_be_named_by_number_and_taken_in_the_middle(page: Browser, poses: ExamplePair) -> None:
    page.element("#goto-target").send_keys("17", Keys.ENTER)
    page.until(lambda: page.text("pinned").startswith(f"target 17 → source {poses.truth[17]}"))
    page.element("#goto-target").send_keys(Keys.BACKSPACE * 2, "999999", Keys.ENTER)
    page.until(
        lambda: page.text("message") == f"The target has no vertex 999999: they go from 0 to {len(poses.truth) - 1}."
    )
    assert page.text("pinned").startswith("target 17 "), "what was kept stays"
    assert page.element("#goto-target").get_attribute("aria-invalid") == "true"
    view = page.element("#view-target")
    view.send_keys(Keys.ENTER)
    output = re.match(r"target (\d+) → source (\d+)", page.text("pinned"))
    assert output is not None, "the middle of the view is on the creature"
    assert poses.truth[int(output[1])] == int(output[2])
    view.send_keys(Keys.ESCAPE)
    assert page.text("pinned") == ""


PLACES = "return ['source', 'target'].map((s) => document.getElementById(`view-${s}`).getBoundingClientRect().toJSON())"


@pytest.mark.parametrize(("mark", "ground"), [("true", 245), ("false", 20)])
@pytest.mark.parametrize("width", [420, 1200])
def test_in_a_cell_of_a_notebook(
    browser: Browser, poses: ExamplePair, tmp_path: Path, width: int, mark: str, ground: int
) -> None:
    """Both views beside each other, nothing to scroll, light or dark as the notebook is, whatever the system is."""
    features = [{"name": "prefers-color-scheme", "value": "light" if mark == "false" else "dark"}]
    browser.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
    html = cell_html(match_page(Match(poses.truth), poses.source, poses.target, (NASTY, "b"), descriptors=False), NASTY)
    cell = f'<!DOCTYPE html><body data-jp-theme-light="{mark}"><div style="width: {width}px">{html}</div></body>'
    (tmp_path / "notebook.html").write_text(cell, encoding="utf-8")
    browser.driver.get_log("browser")
    browser.driver.get((tmp_path / "notebook.html").as_uri())
    browser.driver.switch_to.frame(browser.element("iframe"))
    browser.until(lambda: browser.run("return window.kfmaps?.firstPicture != null"))
    first, second = browser.run(PLACES)
    assert first["top"] == pytest.approx(second["top"], abs=1)
    assert min(first["width"], second["width"]) > width / 3
    assert min(first["height"], second["height"]) > 250
    assert second["right"] < width
    assert browser.run("return document.body.scrollHeight") <= 600
    assert f"rgb({ground}," in browser.run("return getComputedStyle(document.body).backgroundColor")
    before = browser.text("readout")
    browser.hover("#view-target")
    browser.until(lambda: browser.text("readout") != before)
    assert browser.complaints() == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_stands_out_from_its_ground(page: Browser, scheme: str) -> None:
    features = [{"name": "prefers-color-scheme", "value": scheme}]
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
    page.run(CHOOSE_MAP, "1")
    page.run("document.getElementById('goto-target').value = -1")
    script = """
        const rgb = (text) => text.match(/[\\d.]+/g).map(Number);
        const light = (c) => [0.2126, 0.7152, 0.0722].reduce((sum, w, i) => {
            const x = c[i] / 255;
            return sum + w * (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
        }, 0);
        const ground = (e) => {
            for (; e; e = e.parentElement) {
                const c = rgb(getComputedStyle(e).backgroundColor);
                if (c.length < 4 || c[3] > 0.99) return c;
            }
            return [255, 255, 255];
        };
        return [...document.querySelectorAll('h1, h2, p, strong, label, button, span, th, td, caption, figcaption')]
            .filter((e) => e.checkVisibility() && e.textContent.trim())
            .map((e) => {
                const [a, b] = [light(rgb(getComputedStyle(e).color)), light(ground(e))].sort((x, y) => y - x);
                return [(a + 0.05) / (b + 0.05), e.outerHTML.slice(0, 80)];
            });"""
    ratios = page.until(lambda: page.run(script))
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})
    assert len(ratios) > 20
    assert min(ratios)[0] >= 4.5, min(ratios)


def test_difference_is_to_the_runner_up(page: Browser, poses: ExamplePair, tmp_path: Path) -> None:
    half = poses.truth.copy()
    upper = poses.target.vertices[:, 1] > np.median(poses.target.vertices[:, 1])
    half[upper] = half[upper][::-1]
    html = match_page(Match(poses.truth, alternatives=(half,)), poses.source, poses.target, descriptors=False)
    page.show(html, tmp_path)
    page.mode("difference")
    page.painted()
    assert "√area" in page.text("legend-text")
    view = page.picture(page.element("#view-target"))
    coloured = np.ptp(view, axis=2) > 60
    on_shape = view.min(axis=2) < 200
    rows = np.flatnonzero(on_shape.any(axis=1))
    top, bottom = np.array_split(coloured[rows[0] : rows[-1]], [int(0.3 * len(rows))])
    assert top.mean() > 0.02
    assert bottom[len(bottom) // 2 :].mean() < 0.001


def test_confidence_is_of_the_map_that_is_shown(browser: Browser, poses: ExamplePair, tmp_path: Path) -> None:
    """A part that is sent elsewhere is dark, the rest bright; the alternative, which is right, is bright all over."""
    side = poses.target.vertices[:, 0]
    part = side > np.quantile(side, 0.93)
    wrong = poses.truth.copy()
    wrong[part] = np.random.default_rng(0).permutation(wrong[part])
    found = Match(wrong, alternatives=(poses.truth,))
    html = match_page(found, poses.source, poses.target, ("a", "b"), descriptors=False)
    browser.show(html, tmp_path)
    browser.mode("confidence")
    assert (browser.text("legend-low"), browser.text("legend-high")) == ("0 %", "100 %")
    assert "local fit" in browser.text("legend-text")
    expected = {"0": wrong, "1": poses.truth}
    for chosen, points in expected.items():
        browser.run(CHOOSE_MAP, chosen)
        sure = local_confidence(poses.source, poses.target, points)
        for vertex in browser.visible("target", np.flatnonzero(part), 1) + browser.visible("target", np.arange(300), 2):
            browser.point("target", vertex)
            begin = f"target {vertex} → source {points[vertex]}, local fit "
            output = browser.until(lambda begin=begin: re.fullmatch(begin + "([0-9]+) %", browser.text("readout")))
            assert float(output[1]) == pytest.approx(100 * sure[vertex], abs=0.51)
        browser.painted()
        view = browser.picture(browser.element("#view-target"))
        # viridis: what is unsure is violet, what is sure is green to yellow
        violet = (view[..., 2] - view[..., 1] > 30) & (view[..., 2] - view[..., 0] > 20)
        green = (view[..., 1] - view[..., 2] > 30) & (view[..., 1] > 80)
        assert green.mean() > 0.02
        assert (violet.mean() > 0.002) == (chosen == "0"), violet.mean()


def test_picture_is_saved(page: Browser, tmp_path: Path) -> None:
    folder = {"behavior": "allow", "downloadPath": str(tmp_path)}
    page.driver.execute_cdp_cmd("Browser.setDownloadBehavior", folder)
    page.element("#picture").click()
    found = page.until(lambda: list(tmp_path.glob("*.png")))
    picture = np.asarray(page.until(lambda: Image.open(found[0])).convert("RGB")).astype(int)
    width = page.run("return document.getElementById('stage').clientWidth")
    assert picture.shape[1] == 2 * width
    for half in np.array_split(picture, 2, axis=1):
        assert (np.ptp(half, axis=2) > 40).mean() > 0.02


def test_verdict_comes_first_and_an_alternative_says_that_it_is_one(page: Browser) -> None:
    assert page.element("#verdict").is_displayed()
    assert page.text("verdict-name") == "Ambiguous, 25 %."
    above = "return document.getElementById('verdict').getBoundingClientRect().bottom"
    assert page.run(above) <= page.run("return document.getElementById('stage').getBoundingClientRect().top")
    best = page.text("facts")
    assert best.startswith("mean error 10 % of √area · mean local fit 50 %")
    assert not page.element("#alternative").is_displayed()
    page.run(CHOOSE_MAP, "1")
    assert page.text("alternative-name") == "Alternative 1, not the answer."
    assert "error" not in page.text("facts"), "only the best map's is known"
    assert page.text("title-target").endswith("(alternative 1)")
    page.run(CHOOSE_MAP, "0")
    assert not page.element("#alternative").is_displayed()
    assert page.text("facts") == best
    page.mode("error")
    assert "√area" in page.text("legend-text")
    assert (page.text("legend-low"), page.text("legend-high")) == ("0", "20")


def test_both_are_seen_from_the_same_side_of_the_body(browser: Browser, poses: ExamplePair, tmp_path: Path) -> None:
    """However the target lies. Of shapes that lie alike, a map that takes back for front is seen to do so."""
    lying = Mesh(poses.source.vertices[:, [0, 2, 1]] * [1, -1, 1], poses.source.faces)  # a quarter round x
    sphere = fibonacci_sphere(1500)
    x, y, z = sphere.vertices.T
    body = Mesh(np.stack([x, 2 * y, 0.5 * z + 0.2 * (y > 0.5)], 1), sphere.faces)
    back_for_front = np.asarray(KDTree(body.vertices).query(body.vertices * [-1, 1, -1])[1])
    for source, target, points in ((poses.source, lying, np.arange(len(x))), (body, body, back_for_front)):
        browser.show(match_page(Match(points), source, target, descriptors=False), tmp_path)
        views = [
            browser.run("return document.getElementById(arguments[0]).getBoundingClientRect().x", f"view-{side}")
            for side in ("source", "target")
        ]
        for vertex in (0, 300, 900):
            (x, y), (x_t, y_t) = browser.place("source", vertex), browser.place("target", vertex)
            assert abs(x - views[0] - (x_t - views[1])) <= 3
            assert abs(y - y_t) <= 3


def test_the_texture_of_the_source_is_on_both_shapes(browser: Browser, poses: ExamplePair, tmp_path: Path) -> None:
    pixels = np.zeros((64, 64, 3))
    pixels[:, :32, 0], pixels[:, 32:, 2] = 1, 1
    source = poses.source
    uv = np.where(source.vertices[:, :1] < np.median(source.vertices[:, 0]), [0.25, 0.5], [0.75, 0.5])
    file = MeshFile(source, None, uv, source.faces, encode_png(pixels))
    found = Match(poses.truth, alternatives=(poses.truth[::-1],))
    html = match_page(found, file, poses.target, ("a", "b"), descriptors=False)
    browser.show(html, tmp_path)
    browser.mode("texture")
    browser.until(lambda: browser.text("legend-text") == "The texture of a, carried to b by the map.")
    browser.painted()
    for side in ("source", "target"):
        view = browser.picture(browser.element(f"#view-{side}"))
        red = (view[..., 0] > 100) & (view[..., 1:].max(axis=2) < 60)
        blue = (view[..., 2] > 100) & (view[..., :2].max(axis=2) < 60)
        assert red.mean() > 0.02
        assert blue.mean() > 0.02
    browser.run(CHOOSE_MAP, "1")
    browser.until(lambda: browser.text("legend-text").startswith("The pattern lies on a"))
    assert browser.complaints() == []
