"""Make docs/images/forge.png: the demo room in SceneForge, the sofa chosen.

Run by hand when the page looks otherwise; it needs chromium and the page built::

    python tools/make_forge_picture.py
"""

import shutil
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, ViewportSize, sync_playwright

from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.scene_sources import demo_room
from world2minecraft.sceneforge.server.server_process import ForgeServer

TARGET = Path(__file__).parents[1] / "docs/images/forge.png"
SIZE: ViewportSize = {"width": 1280, "height": 760}
SOFA = 2
ARGUMENTS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
REMEMBERED = {"sceneforge.hints": "seen", "sceneforge.theme": "dark"}


def main() -> None:
    """Serve the demo room, choose its sofa, and keep a picture of the window."""
    with ForgeServer(Editor(demo_room()), port=0) as server, sync_playwright() as running:
        found = shutil.which("chromium")
        browser = running.chromium.launch(executable_path=found, args=list(ARGUMENTS))
        page = browser.new_page(viewport=SIZE)
        for name, value in REMEMBERED.items():
            page.add_init_script(f"localStorage.setItem('{name}', '{value}')")
        page.goto(server.link)
        choose(page, SOFA)
        page.screenshot(path=TARGET)
        browser.close()
    Image.open(TARGET).convert("RGB").save(TARGET, optimize=True)


def choose(page: Page, number: int) -> None:
    """Show Objects mode with one object chosen, and wait until all of it is drawn."""
    page.locator(f".tree [data-object='{number}']").wait_for()
    page.keyboard.press("Shift+Digit3")
    page.locator(f".tree [data-object='{number}']").click()
    page.locator(".template").nth(1).wait_for()
    page.mouse.move(1, 1)
    page.evaluate("window.__forge.idle()")
    page.wait_for_timeout(1800)  # The frame time is hidden by then.


if __name__ == "__main__":
    main()
