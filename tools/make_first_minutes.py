"""Make the pictures of docs/tutorials/first-five-minutes.md from generated rooms.

Run by hand when the pages look otherwise; it needs chromium and the page built::

    python tools/make_first_minutes.py
"""

import shutil
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

import world2minecraft as w2m
from world2minecraft.sceneforge.server.server_process import ForgeServer

TARGET = Path(__file__).parents[1] / "docs/images/first"
WIDTH_PX, QUALITY = 720, 70  # Small: all pictures together are a few hundred kB.
ARGUMENTS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
REMEMBERED = {"sceneforge.hints": "seen", "sceneforge.theme": "light"}
WAIT_MS = 60_000


def main() -> None:
    """Draw every page that the text shows."""
    TARGET.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch, sync_playwright() as running:
        found = shutil.which("chromium") or shutil.which("chromium-browser")
        browser = running.chromium.launch(executable_path=found, args=list(ARGUMENTS))
        editor_pictures(browser, Path(scratch) / "home")
        run_pictures(browser, Path(scratch))
        browser.close()


def editor_pictures(browser: Browser, home: Path) -> None:
    """Draw the start page, another sofa, and the walk to the lamp."""
    with ForgeServer(None, port=0, home=home) as server:
        page = browser.new_page(viewport={"width": 1280, "height": 720})
        for name, value in REMEMBERED.items():
            page.add_init_script(f"localStorage.setItem('{name}', '{value}')")
        page.goto(server.link)
        page.get_by_role("button", name="Open the example room").wait_for()
        page.wait_for_timeout(500)
        keep(page, "start")
        page.get_by_role("button", name="Open the example room").click()
        open_editor(page)
        page.get_by_role("tab", name="Objects").click()
        page.locator(".tree-leaf", has_text="sofa").click()
        page.keyboard.press("t")
        page.wait_for_timeout(1500)
        keep(page, "sofa")
        page.get_by_role("tab", name="Walk").click()
        until(page, "window.__forge.walk.walker !== null")
        page.locator(".go-input").fill("go to the lamp")
        page.keyboard.press("Enter")
        page.get_by_text("Here is the lamp").wait_for(timeout=WAIT_MS)
        keep(page, "walk")
        page.close()


def open_editor(page: Page) -> None:
    """Wait for the editor, by way of the finished room where the page shows that first."""
    page.locator("[data-do='open'], .mode-tab").first.wait_for(timeout=WAIT_MS)
    if page.locator("[data-do='open']").count():
        page.locator("[data-do='open']").click()
    until(page, "Boolean(window.__forge?.store.get().scene)")
    page.evaluate("window.__forge.idle()")


def run_pictures(browser: Browser, scratch: Path) -> None:
    """Draw the report and the shared page of a run, the page on a phone in the evening."""
    capture = scratch / "study"
    w2m.scan_room(w2m.generate_room("study", seed=3), capture, frames=12)
    run = w2m.reconstruct(str(capture), out=str(scratch / "OUT"))
    page = browser.new_page(viewport={"width": 1280, "height": 720}, color_scheme="light")
    page.goto((scratch / "OUT/report.html").as_uri())
    page.locator(".pair.over").nth(1).evaluate("one => one.scrollIntoView({block: 'center'})")
    page.wait_for_timeout(500)
    keep(page, "report")
    w2m.share(run, scratch / "room.html", title="My study")
    page = browser.new_page(viewport={"width": 390, "height": 700}, has_touch=True)
    page.goto((scratch / "room.html").as_uri())
    page.get_by_role("button", name="Night").click()
    page.wait_for_timeout(1500)
    keep(page, "share", 300)


def until(page: Page, expression: str) -> None:
    """Wait until an expression is true; the page's policy forbids what Playwright waits with."""
    for _ in range(WAIT_MS // 50):
        if page.evaluate(expression):
            return
        page.wait_for_timeout(50)
    raise TimeoutError(expression)


def keep(page: Page, name: str, width_px: int = WIDTH_PX) -> None:
    """Keep a small picture of what the page shows."""
    raw = TARGET / f"{name}.png"
    page.screenshot(path=raw)
    picture = Image.open(raw).convert("RGB")
    size = (width_px, round(picture.height * width_px / picture.width))
    picture.resize(size, Image.Resampling.LANCZOS).save(TARGET / f"{name}.webp", quality=QUALITY)
    raw.unlink()


if __name__ == "__main__":
    main()
