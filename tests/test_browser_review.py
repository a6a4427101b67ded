"""The review of landmarks in a real browser."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from chromium import Browser, Keys, needs_browser
from kfmaps.io import read_mesh
from kfmaps.viz.landmark_review import ReviewServer
from reviewing import N, rows_of

pytest_plugins = ["chromium", "reviewing"]
pytestmark = needs_browser


def test_a_specimen_is_reviewed_in_a_browser(browser: Browser, study: Path, serving: ReviewServer) -> None:
    def flags() -> list[str]:
        return browser.run(
            "return [...document.querySelectorAll('#pairs tbody tr')].map((row) => row.cells[2].textContent)"
        )

    browser.open(serving.address)
    assert "2 of 5 flagged" in browser.text("facts")
    browser.element("#next").click()
    assert browser.text("readout").startswith("b: low confidence")
    browser.element("#accept").click()
    assert browser.text("readout").startswith("e: no counterpart. Click its place on b")
    browser.element("#reset").click()
    mesh = read_mesh(study.parent / "scans" / "b.ply")
    vertex = browser.visible("target", np.arange(N), N)[0]
    browser.point("target", vertex, click=True)
    assert flags() == ["", "checked", "", "", "corrected"]
    browser.element("#view-target").send_keys(Keys.CONTROL, "z")
    assert flags() == ["", "checked", "", "", "no counterpart"]
    browser.point("target", vertex, click=True)
    browser.element("#save").click()
    browser.until(lambda: browser.text("readout").startswith("Saved"))
    row = rows_of(study, "b")["e"]
    off = np.linalg.norm([float(row[axis]) for axis in "xyz"] - mesh.vertices[vertex])
    edges = mesh.vertices[mesh.faces] - mesh.vertices[np.roll(mesh.faces, 1, axis=1)]
    assert off < 0.2 * np.linalg.norm(edges, axis=2).mean()
    assert browser.text("specimen").count("flagged") == 0
    browser.element("#after").click()
    browser.until(lambda: browser.text("name-target") == "c")
    assert browser.complaints() == []
    browser.leave()
