"""axe-core finds no serious fault in any page, on a screen and a phone, dark and light.

Skipped where axe-core is not installed: `npm ci` in sceneforge/web installs it.
"""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from forge_driving import opened_page

import world2minecraft as w2m
from world2minecraft.sceneforge.server.server_process import ForgeServer

ROOT = Path(__file__).resolve().parents[3]
AXE = ROOT / "src/world2minecraft/sceneforge/web/node_modules/axe-core/axe.min.js"
SIZES = {"screen": (1280, 720), "phone": (390, 844)}
LOOKS = [(size, theme) for size in SIZES for theme in ("dark", "light")]
RUN = """axe.run(document, {resultTypes: ["violations"]}).then((found) => found.violations
  .filter(({impact}) => impact === "serious" || impact === "critical")
  .flatMap(({id, nodes}) => nodes.map((node) => `${id}: ${node.target.join(" ")}: `
    + [...node.any, ...node.all, ...node.none][0]?.message)))"""
UNFOLD = """for (const one of document.querySelectorAll(".panel-title[aria-expanded=false]"))
  if (one.offsetParent) one.click()"""


@pytest.fixture(scope="module")
def axe() -> str:
    if not AXE.is_file():
        pytest.skip("axe-core is not installed (npm ci in sceneforge/web)")
    return AXE.read_text()


@pytest.fixture(params=LOOKS, ids="-".join)
def look(request) -> tuple[str, str]:
    return request.param


@pytest.fixture
def opened(browser, axe, look) -> Iterator[Callable]:
    """Open an address in the look of the test; `faults` says what is wrong with a page."""
    size, theme = look
    width, height = SIZES[size]
    context = browser.new_context(
        viewport={"width": width, "height": height}, color_scheme=theme, reduced_motion="reduce"
    )
    context.add_init_script(f"localStorage.setItem('sceneforge.theme', '{theme}')")

    def opening(address: str | None = None):
        page = context.new_page()
        if address:
            page.goto(address)
        return page

    yield opening
    context.close()


def faults(page, axe: str, where: str) -> list[str]:
    if not page.evaluate("'axe' in window"):
        page.evaluate(axe)
    return [f"{where}: {one}" for one in page.evaluate(RUN)]


def test_every_workspace_of_the_editor(opened, server, axe, look, shot):
    page = opened()
    forge, found = opened_page(page, server.link, hints=True, theme=look[1]), []
    for mode in ("inspect", "voxels", "objects", "build", "walk"):
        state = "selectedObjects: new Set([2]), selectedCells: new Set([5])"
        page.evaluate(f"window.__forge.store.set({{mode: '{mode}', {state}}})")
        page.evaluate(UNFOLD)
        page.wait_for_timeout(150)
        shot(forge, f"axe-{mode}-{'-'.join(look)}")
        found += faults(page, axe, mode)
    page.evaluate("window.__forge.store.set({mode: 'objects'})")
    for name, key in (("palette", "Control+k"), ("help", "F1"), ("export", "Control+e")):
        page.keyboard.press(key)
        page.wait_for_timeout(200)
        found += faults(page, axe, name)
        page.keyboard.press("Escape")
    assert not found


def test_the_start_page(opened, tmp_path, axe):
    with ForgeServer(None, port=0, home=tmp_path) as server:
        page = opened(server.link)
        page.wait_for_selector(".drop")
        assert not faults(page, axe, "start")


def test_the_report_and_a_shared_room(opened, example_run, tmp_path_factory, axe):
    page = opened((example_run.folder / "report.html").as_uri())
    found = faults(page, axe, "report")
    shared = tmp_path_factory.mktemp("shared") / "room.html"
    w2m.share(example_run, shared)
    page = opened(shared.as_uri())
    page.wait_for_selector(".go-input")
    found += faults(page, axe, "shared")
    page.get_by_role("button", name="Walk", exact=True).click()
    assert not found + faults(page, axe, "shared, walking")
