"""Headless Chromium for the tests of the pages: how it is started, and what a test does with a page."""

from __future__ import annotations

import io
import json
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

webdriver = pytest.importorskip("selenium.webdriver", reason="Selenium is not installed")
from selenium.common.exceptions import NoAlertPresentException  # noqa: E402
from selenium.webdriver.common.action_chains import ActionChains  # noqa: E402
from selenium.webdriver.common.keys import Keys  # noqa: E402

__all__ = ["NASTY", "Browser", "Keys", "needs_browser"]

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
CHROMEDRIVER = shutil.which("chromedriver")
needs_browser = pytest.mark.skipif(
    not (CHROMIUM and CHROMEDRIVER), reason="no browser: Chromium and its chromedriver are not installed"
)

NASTY = "</script><script>alert(1)</script><b>&"
"""A name that would run, or change the page, if it were ever read as HTML."""
FLAGS = (
    "headless no-sandbox disable-gpu disable-quic no-first-run disable-background-networking disable-component-update "
    "disable-sync use-gl=angle use-angle=swiftshader enable-unsafe-swiftshader window-size=1280,1000"
)


class Browser:
    """What the tests do with a page, in the words of the page."""

    def __init__(self, driver: Any) -> None:
        self.driver = driver

    def open(self, address: str) -> None:
        self.driver.get_log("browser")
        self.driver.get_log("performance")
        self.driver.get(address)
        self.until(lambda: self.run("return window.kfmaps?.firstPicture != null"))

    def show(self, html: str, folder: Path) -> str:
        """Open a page from the disk, and return its address."""
        page = folder / "page.html"
        page.write_text(html, encoding="utf-8")
        self.open(page.as_uri())
        return page.as_uri()

    def leave(self) -> None:
        """Go away from the page, whatever it asks."""
        self.driver.execute_cdp_cmd("Page.navigate", {"url": "about:blank"})
        with suppress(NoAlertPresentException):
            self.driver.switch_to.alert.accept()

    def run(self, script: str, *arguments: Any) -> Any:
        return self.driver.execute_script(script, *arguments)

    def until(self, holds: Callable[[], Any]) -> Any:
        for _ in range(2400):
            found = holds()
            if found:
                return found
            time.sleep(0.025)
        raise AssertionError("waited a minute in vain")

    def painted(self) -> None:
        """Return once all that was asked of the page so far is drawn: the second frame from now begins after it."""
        script = "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done(0)))"
        self.driver.execute_async_script(script)

    def element(self, name: str) -> Any:
        return self.driver.find_element("css selector", name)

    def text(self, name: str) -> str:
        return self.run("return document.getElementById(arguments[0]).textContent", name)

    def mode(self, value: str) -> None:
        self.run("document.querySelector(`[name=mode][value=${arguments[0]}]`).click()", value)

    def complaints(self) -> list[str]:
        """Errors on the console: scripts that fail, and whatever the content policy stops."""
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]

    def requests(self) -> list[str]:
        events = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        urls = [e["params"]["request"]["url"] for e in events if e["method"] == "Network.requestWillBeSent"]
        return [url for url in urls if not url.startswith(("data:", "blob:", "chrome:", "chrome-untrusted:"))]

    def place(self, side: str, vertex: int) -> tuple[int, int]:
        at = self.run("return kfmaps.project(arguments[0], arguments[1])", side, int(vertex))
        return round(at["x"]), round(at["y"])

    def visible(self, side: str, vertices: np.ndarray, count: int) -> list[int]:
        """The first ``count`` of ``vertices`` that are in sight and are what is picked where they are seen."""
        script = """const [side, vertices] = arguments;
            return vertices.filter((v) => {
                const p = kfmaps.project(side, v);
                return p.visible && kfmaps.pick(side, Math.round(p.x), Math.round(p.y)) === v;
            });"""
        return self.run(script, side, np.asarray(vertices).tolist())[:count]

    def point(self, side: str, vertex: int, *, click: bool = False) -> None:
        chain = ActionChains(self.driver, duration=0)
        chain.w3c_actions.pointer_action.move_to_location(*self.place(side, vertex))
        if click:
            chain.w3c_actions.pointer_action.click()
        chain.perform()

    def hover(self, name: str) -> None:
        """Point at the middle of an element, also in a frame."""
        ActionChains(self.driver, duration=0).move_to_element(self.element(name)).perform()

    def drag(self, side: str, start: int, end: int) -> None:
        chain = ActionChains(self.driver, duration=0)
        pointer = chain.w3c_actions.pointer_action
        (x, y), (to_x, to_y) = self.place(side, start), self.place(side, end)
        pointer.move_to_location(x, y).pointer_down()
        pointer.move_to_location((x + to_x) // 2, (y + to_y) // 2).move_to_location(to_x, to_y).pointer_up()
        chain.perform()

    def picture(self, element: Any) -> np.ndarray:
        return np.asarray(Image.open(io.BytesIO(element.screenshot_as_png)).convert("RGB")).astype(int)


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """A browser with an empty profile."""
    options = webdriver.ChromeOptions()
    for flag in FLAGS.split():
        options.add_argument(f"--{flag}")
    options.add_argument(f"--user-data-dir={tmp_path_factory.mktemp('browser')}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    options.binary_location = CHROMIUM
    driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(CHROMEDRIVER))
    try:
        yield Browser(driver)
    finally:
        driver.quit()
