"""One headless Chromium for all tests of the page, and a demo room on a real server.

Set W2M_SHOTS to a folder outside the repository to keep pictures of the main states.
"""

import os
import shutil
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from forge_driving import Driver, opened_page

from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.scene_sources import OpenedScene, demo_room
from world2minecraft.sceneforge.server.server_process import ForgeServer

TESTS = Path(__file__).resolve().parents[2]
for part in ("plans", "server"):  # RoomPlans and a server's console, written for other tests.
    sys.path.insert(0, str(TESTS / part))

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
ARGUMENTS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
)


@pytest.fixture(scope="session")
def browser() -> Iterator:
    """A browser that all tests share; each page has a context of its own."""
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    if CHROMIUM is None:
        pytest.skip("there is no chromium on this machine (apt-get install chromium)")
    with playwright.sync_playwright() as running:
        shared = running.chromium.launch(executable_path=CHROMIUM, args=list(ARGUMENTS))
        yield shared
        shared.close()


@pytest.fixture(scope="session")
def room() -> OpenedScene:
    """The demo room, made once."""
    return demo_room()


@pytest.fixture
def server(room, tmp_path) -> Iterator[ForgeServer]:
    """A server of the demo room that would be saved in ``tmp_path``."""
    with ForgeServer(Editor(replace(room, folder=tmp_path)), port=0) as running:
        yield running


@pytest.fixture
def open_tab(browser, server) -> Iterator[Callable[..., Driver]]:
    """Open another tab on the server; all are closed after the test."""
    contexts = []

    def opened(width=1280, height=760, hints=False) -> Driver:
        context = browser.new_context(viewport={"width": width, "height": height})
        contexts.append(context)
        return opened_page(context.new_page(), server.link, hints)

    yield opened
    for context in contexts:
        context.close()


@pytest.fixture
def forge(open_tab) -> Iterator[Driver]:
    """One tab, the room in it, hints closed. A mistake that the page reports fails the test."""
    driver = open_tab()
    yield driver
    assert driver.mistakes == []


@pytest.fixture
def shot() -> Callable[[Driver, str], None]:
    """Keep a picture of a page where the one who runs the tests wants some."""
    folder = os.environ.get("W2M_SHOTS")

    def keep(driver: Driver, name: str) -> None:
        if folder:
            driver.idle()
            driver.page.screenshot(path=Path(folder) / f"{name}.png")

    return keep
