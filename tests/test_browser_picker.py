"""The landmark picker in a real browser, from the first click to the file."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from chromium import NASTY, Browser, Keys, needs_browser
from kfmaps import Match
from kfmaps._arrays import InvalidInput
from kfmaps._progress import Progress
from kfmaps.datasets import ExamplePair
from kfmaps.geometry.mesh import Mesh, surface_area
from kfmaps.io import load_map, read_landmark_names, read_landmarks
from kfmaps.viz.document import forwarding_page
from kfmaps.viz.picker import PickerServer
from serving import answering

pytest_plugins = ["chromium"]
pytestmark = needs_browser


GOING = threading.Event()
"""Not set while a test wants to see a run that is under way."""
GOING.set()


def a_matcher(landmarks: np.ndarray, progress: Progress) -> Match:
    """Sends every target vertex to the first landmark's source vertex."""
    if len(landmarks) > 2:
        raise InvalidInput("too many <b>landmarks</b>")
    progress("solve", 0.5)
    assert GOING.wait(60)
    return Match(np.full(1200, landmarks[0, 0]))


@pytest.fixture
def picker(
    browser: Browser, poses: ExamplePair, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Browser]:
    """The page, opened as the command does: from a file that leads to the server's address."""
    serving = PickerServer(
        poses.source,
        poses.target,
        (NASTY, "b"),
        tmp_path / "pairs.txt",
        matcher=a_matcher,
        map_output=tmp_path / "m.npz",
    )
    with answering(serving):
        opened = tmp_path_factory.mktemp("opened") / "page.html"
        opened.write_text(forwarding_page(serving.address), encoding="utf-8")
        browser.open(opened.as_uri())
        yield browser
        browser.leave()


def cells(picker: Browser) -> list[list[str]]:
    """The table of pairs, as text."""
    script = """return [...document.querySelectorAll('#pairs tbody tr')]
        .map((row) => [...row.cells].map((cell) => cell.textContent));"""
    return picker.run(script)


def rows(picker: Browser) -> list[list[int]]:
    """The pairs in the page's table."""
    return [[int(cell) for cell in row[1:3]] for row in cells(picker)]


def spread(picker: Browser, side: str, mesh: Mesh, count: int) -> list[int]:
    """Vertices in sight, at least 40 pixels from each other."""
    chosen: list[int] = []
    for vertex in picker.visible(side, np.arange(len(mesh.vertices)), len(mesh.vertices)):
        place = picker.place(side, vertex)
        if all(np.hypot(*np.subtract(place, picker.place(side, other))) > 40 for other in chosen):
            chosen.append(vertex)
            if len(chosen) == count:
                break
    return chosen


def add(picker: Browser, source: int, target: int) -> None:
    """A pair by its numbers, from the keyboard."""
    picker.element("#add-source").send_keys(str(source))
    picker.element("#add-target").send_keys(str(target), Keys.ENTER)


def test_pairs_are_clicked_undone_dragged_and_saved(picker: Browser, poses: ExamplePair, tmp_path: Path) -> None:
    s = spread(picker, "source", poses.source, 4)
    t = spread(picker, "target", poses.target, 4)
    picker.point("source", s[0], click=True)
    assert "click its match on b" in picker.text("readout")
    picker.point("target", t[0], click=True)
    picker.point("target", t[1], click=True)  # either shape may come first
    picker.point("source", s[1], click=True)
    picker.point("source", s[2], click=True)
    picker.point("target", t[2], click=True)
    assert rows(picker) == [[s[0], t[0]], [s[1], t[1]], [s[2], t[2]]]
    assert picker.run("return kfmaps.marks('source')") == s[:3]
    picker.drag("target", t[2], t[3])
    assert rows(picker)[2] == [s[2], t[3]]
    picker.element("#undo").click()
    assert rows(picker)[2] == [s[2], t[2]]
    picker.element("[aria-label='Delete pair 1']").click()
    assert rows(picker) == [[s[1], t[1]], [s[2], t[2]]]
    assert not (tmp_path / "pairs.txt").exists()
    picker.element("#save").click()
    picker.until(lambda: picker.text("readout").startswith("Saved 2 pairs"))
    assert read_landmarks(tmp_path / "pairs.txt").tolist() == [[s[1], t[1]], [s[2], t[2]]]
    assert picker.complaints() == []


def test_undo_goes_back_to_the_beginning_and_a_program_that_is_gone_is_told(picker: Browser) -> None:
    add(picker, 7, 9)
    add(picker, 8, 6)
    picker.element("[aria-label='Delete pair 1']").click()
    history = [rows(picker)]
    while picker.element("#undo").is_enabled():
        picker.element("#view-source").send_keys(Keys.CONTROL, "z")
        history.append(rows(picker))
    assert history == [[[8, 6]], [[7, 9], [8, 6]], [[7, 9]], []]
    picker.run("window.fetch = () => Promise.reject(new TypeError('gone'))")
    picker.element("#match").click()
    picker.until(lambda: "was probably stopped" in picker.text("message"))


def test_existing_file_is_replaced_after_asking(picker: Browser, tmp_path: Path) -> None:
    (tmp_path / "pairs.txt").write_text("1 1\n")
    add(picker, 7, 9)
    picker.element("#save").send_keys(Keys.ENTER)
    picker.until(lambda: picker.element("#overwrite").is_displayed())
    assert str(tmp_path / "pairs.txt") in picker.text("overwrite-text")
    picker.element("#overwrite-no").click()
    assert (tmp_path / "pairs.txt").read_text() == "1 1\n"
    picker.element("#save").click()
    picker.until(lambda: picker.element("#overwrite").is_displayed())
    picker.element("#overwrite-yes").click()
    picker.until(lambda: picker.text("readout").startswith("Saved 1 pair"))
    assert read_landmarks(tmp_path / "pairs.txt").tolist() == [[7, 9]]


def test_match_shows_progress_its_map_and_its_errors(picker: Browser, poses: ExamplePair) -> None:
    add(picker, 3, 5)
    add(picker, 8, 6)
    GOING.clear()
    try:
        picker.element("#match").click()
        picker.until(lambda: picker.text("stage-name").startswith("solve"))
        assert picker.element("#cancel").is_displayed()
    finally:
        GOING.set()
    picker.until(lambda: picker.element("#map-choice").is_displayed())
    assert picker.run("return document.querySelector('[name=mode]:checked').value") == "colours"
    picker.point("target", picker.visible("target", np.arange(200), 1)[0])
    picker.until(lambda: picker.run("return kfmaps.marks('source')") == [3, 3, 8])
    off = [float(row[4]) / 100 for row in cells(picker)]
    apart = np.linalg.norm(poses.source.vertices[8] - poses.source.vertices[3]) / np.sqrt(surface_area(poses.source))
    assert off == [0, pytest.approx(apart, rel=0.06)]  # shown with two digits
    picker.mode("confidence")  # of a map that sends everything to one point: none
    assert "local fit" in picker.text("legend-text")
    assert picker.element("#verdict").is_displayed()
    picker.painted()
    view = picker.picture(picker.element("#view-target"))
    violet = (view[..., 2] - view[..., 1] > 30) & (view[..., 2] - view[..., 0] > 15)
    assert violet.mean() > 0.02
    add(picker, 20, 30)
    picker.element("#match").click()
    picker.until(lambda: picker.text("message") == "The match failed: too many <b>landmarks</b>")
    assert picker.complaints() == []


def test_change_is_white_where_nothing_moved_and_red_where_it_did(picker: Browser, poses: ExamplePair) -> None:
    far = int(np.linalg.norm(poses.source.vertices - poses.source.vertices[3], axis=1).argmax())
    coloured = []
    for number, source in enumerate((3, 3, far), 1):
        # The matcher looks at the first pair alone.
        add(picker, source, 5)
        picker.element("#match").click()
        picker.until(lambda n=number: picker.run("return document.querySelectorAll('#map option').length") == n)
        picker.until(lambda: picker.element("#match").is_enabled())
        picker.element("[aria-label='Delete pair 1']").click()
        picker.mode("change")
        picker.painted()
        coloured.append((np.ptp(picker.picture(picker.element("#view-target")), axis=2) > 40).mean())
    assert coloured[0] < 0.001  # no run before the first
    assert coloured[1] < 0.001
    assert coloured[2] > 0.05
    assert "√area" in picker.text("legend-text")


def test_everything_can_be_reached_by_keyboard_and_has_a_name(picker: Browser) -> None:
    add(picker, 3, 5)
    picker.element("#match").click()
    picker.until(lambda: picker.element("#map-choice").is_displayed() and picker.element("#match").is_enabled())
    picker.run("document.getElementById('linked').focus()")
    reached = []
    for _ in range(40):
        focused = picker.driver.switch_to.active_element
        if focused.tag_name == "body":
            break
        assert focused.accessible_name.strip(), focused.get_attribute("outerHTML")
        reached.append(focused.get_attribute("id") or focused.get_attribute("name"))
        focused.send_keys(Keys.TAB)
    wanted = "linked up spin reset picture save undo match mode map propose save-map view-source view-target"
    wanted += " add-source add-target"
    assert [name for name in reached if name in wanted.split()] == wanted.split()
    assert picker.element("[aria-label='Delete pair 1']").is_displayed()
    assert picker.element("#view-source").accessible_name == f"3D view of the source, {NASTY}"


def test_a_vertex_that_is_taken_or_does_not_exist_is_refused(picker: Browser) -> None:
    add(picker, 7, 9)
    add(picker, 7, 20)
    picker.until(lambda: "belongs to pair 1" in picker.text("message"))
    assert rows(picker) == [[7, 9]]
    picker.run("document.getElementById('add').reset()")
    add(picker, 99999, 20)
    picker.until(lambda: "no vertex 99999: they go from 0 to 1499" in picker.text("message"))
    assert rows(picker) == [[7, 9]]


def test_names_go_into_the_file_and_leaving_without_it_asks_first(picker: Browser, tmp_path: Path) -> None:
    add(picker, 7, 9)
    add(picker, 8, 6)
    picker.element("[aria-label='Name of pair 2']").send_keys("left hand", Keys.TAB)
    assert picker.run("return !window.dispatchEvent(new Event('beforeunload', { cancelable: true }))")
    picker.element("#save").click()
    picker.until(lambda: picker.text("readout").startswith("Saved 2 pairs"))
    assert picker.run("return window.dispatchEvent(new Event('beforeunload', { cancelable: true }))")
    assert read_landmark_names(tmp_path / "pairs.txt") == ["", "left hand"]
    assert read_landmarks(tmp_path / "pairs.txt").tolist() == [[7, 9], [8, 6]]


def test_the_map_of_a_run_proposes_matches_and_is_saved(picker: Browser, tmp_path: Path) -> None:
    """The matcher sends everything to the first pair's source vertex, which is taken; so it is moved away first."""
    add(picker, 3, 5)
    picker.element("#match").click()
    picker.until(lambda: picker.element("#propose").is_displayed() and picker.element("#match").is_enabled())
    picker.element("[aria-label='Delete pair 1']").click()
    picker.element("#propose").click()
    picker.until(lambda: picker.run("return kfmaps.marks('source')") == [3])
    [target] = picker.run("return kfmaps.marks('target')")
    assert "proposes" in picker.text("readout")
    picker.element("#take").click()
    assert rows(picker) == [[3, target]]
    assert not picker.element("#take").is_displayed()
    picker.element("#save-map").click()
    picker.until(lambda: picker.text("readout").startswith("Saved the map"))
    assert set(load_map(tmp_path / "m.npz").target_to_source) == {3}
