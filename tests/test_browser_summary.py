"""The summary of a collection in a real browser: its tables sort, and nothing is blocked or fetched."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from chromium import NASTY, Browser, needs_browser
from kfmaps.batch.page import summary_page
from kfmaps.batch.results import Result

pytest_plugins = ["chromium"]
pytestmark = needs_browser
COLUMN = (
    "return Array.from(document.querySelectorAll('table.sorts tbody tr')).map(r => r.cells[arguments[0]].textContent)"
)
WIDE = "return document.documentElement.scrollWidth <= window.innerWidth"


def test_tables_sort_by_a_click(browser: Browser, tmp_path: Path) -> None:
    base = Result("s", "t", "done", "d", "i", verdict="sure", seconds={"total": 9.0})
    errors = {"a10": 0.3, "a2": 0.04, NASTY: None}
    results = [replace(base, target=name, error_mean=error) for name, error in errors.items()]
    page = tmp_path / "summary.html"
    page.write_text(summary_page(NASTY, results, {}, {}, 3), encoding="utf-8")
    browser.driver.get_log("browser")
    browser.driver.get(page.as_uri())
    heads = browser.run("return Array.from(document.querySelectorAll('table.sorts th')).map(h => h.textContent)")
    mean, target = heads.index("mean"), heads.index("target")

    def click(column: int) -> list[str]:
        browser.run("document.querySelectorAll('table.sorts th button')[arguments[0]].click()", column)
        return browser.run(COLUMN, column)

    assert click(mean) == ["4.00", "30.00", ""]
    assert click(mean) == ["30.00", "4.00", ""]  # what is not known stays last
    assert browser.run("return document.querySelectorAll('th')[arguments[0]].ariaSort", mean) == "descending"
    assert [name for name in click(target) if name != NASTY] == ["a2", "a10"]
    browser.driver.set_window_size(400, 800)
    assert browser.run(WIDE)
    assert [entry["message"] for entry in browser.driver.get_log("browser")] == []
