"""Photos, comparing and exporting by real mouse and keys, on a run that has all of it."""

import json
import math
import shutil
import time

import pytest
from forge_driving import Driver, opened_page

from rcon_console import Console
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.server.server_process import ForgeServer

MOST_MS = 60_000


@pytest.fixture
def run(small_run, tmp_path):
    """A copy of the small run that may be changed."""
    folder = tmp_path / "study"
    shutil.copytree(small_run, folder, ignore=shutil.ignore_patterns("*.forge"))
    return folder


@pytest.fixture
def forge(browser, run, tmp_path, monkeypatch):
    """The run in the editor; the user's games lie in an empty home."""
    monkeypatch.setenv("HOME", str(tmp_path / "user"))
    (tmp_path / "user" / ".minecraft" / "saves").mkdir(parents=True)
    with ForgeServer(Editor.open(run), port=0, home=tmp_path / "home") as server:
        context = browser.new_context(
            viewport={"width": 1280, "height": 760}, accept_downloads=True
        )
        driver = opened_page(context.new_page(), server.link, hints=False)
        yield driver
        context.close()
        assert driver.mistakes == []


def until(driver: Driver, expression: str) -> None:
    end = time.monotonic() + MOST_MS / 1000
    while not driver.page.evaluate(expression):
        assert time.monotonic() < end, f"never: {expression}"
        driver.page.wait_for_timeout(50)


def stood(driver: Driver, number: int) -> dict:
    """Wait until the view stands in a photo; return what is told of it."""
    told = driver.page.evaluate("fetch('api/photos').then((one) => one.json())")
    frame = told["frames"][number]
    x = frame["camera_to_room"][0][3]
    until(driver, f"Math.abs((window.__forge.view.pose?.position[0] ?? 99) - {x}) < 1e-6")
    return frame


def test_photos_are_stood_in_blended_and_left(forge, shot):
    page = forge.page
    page.get_by_role("tab", name="Photos").click()
    page.wait_for_selector("[data-photo='0'] img")
    assert page.locator("[data-photo]").count() == 12
    page.locator("[data-field='photo-cameras']").check()
    forge.idle()
    shot(forge, "photos-strip")
    page.locator("[data-photo='4']").click()
    stood(forge, 4)
    picture = page.locator(".photo-over")
    picture.evaluate("one => one.decode()")
    assert (
        picture.is_visible() and page.locator("[data-photo='4'][aria-pressed='true']").count() == 1
    )
    shot(forge, "photos-photo")
    page.locator("[data-field='photo-classes']").check()
    picture.evaluate("one => one.decode()")
    assert picture.get_attribute("src") == "api/photos/4/classes.jpg"
    shot(forge, "photos-classes")
    page.locator("[data-field='photo-classes']").uncheck()
    assert picture.get_attribute("src") == "api/photos/4/picture.jpg"
    page.locator("canvas.canvas").focus()
    forge.key("p")
    assert picture.evaluate("one => one.style.opacity") == "0.5"
    shot(forge, "photos-blend")
    forge.slide("photo-blend", 0.25)
    assert picture.evaluate("one => one.style.opacity") == "0.25"
    page.locator("canvas.canvas").focus()
    forge.key("p")
    boxes = [page.locator(one).bounding_box() for one in (".photo-over", "canvas.canvas")]
    assert boxes[0]["x"] + boxes[0]["width"] <= boxes[1]["x"] + 1
    shot(forge, "photos-beside")
    forge.key("p")
    assert not picture.is_visible()
    forge.key("Escape")
    assert page.evaluate("window.__forge.view.pose") is None


def test_a_photo_lies_on_the_room_that_was_made_of_it(forge):
    """A corner of an object is where its photo shows it: it projects as the pose says."""
    page = forge.page
    page.get_by_role("tab", name="Photos").click()
    page.locator("[data-photo='2']").click()
    told = stood(forge, 2)
    pose = told["camera_to_room"]
    point = [pose[row][3] + 2 * pose[row][2] + 0.3 * pose[row][0] for row in range(3)]
    x, y = page.evaluate(f"window.__forge.view.project({json.dumps(point)})")
    canvas = page.locator("canvas.canvas").bounding_box()
    box = page.locator(".photo-over").bounding_box()
    focal = box["height"] / 2 / math.tan(math.radians(told["vertical_fov_deg"]) / 2)
    wanted = (box["x"] + box["width"] / 2 + focal * 0.15, box["y"] + box["height"] / 2)
    assert (canvas["x"] + x, canvas["y"] + y) == pytest.approx(wanted, abs=1.5)


def test_the_truth_is_compared_with_live(forge, shot):
    page = forge.page
    page.locator("[data-panel='compare'] .panel-title").click()
    page.get_by_role("button", name="Ground truth").click()
    page.wait_for_selector("[data-compared='iou']")
    forge.until("s.view.colourBy", "difference")
    shot(forge, "compare-truth")
    before = page.locator("[data-compared='added']").inner_text()
    rev = forge.rev()
    page.evaluate(
        """() => {
            const { store, connection } = window.__forge;
            const { labels } = store.get();
            const at = labels.findIndex((one, i) => one === 0 && labels[i + 1] === 0 && i > 3000);
            return connection.do({ op: "set_cells", cells: [[at, 2]], class_id: 11 });
        }"""
    )
    forge.until("s.scene.rev", rev + 1)
    until(forge, f"document.querySelector('[data-compared=added]').textContent !== {before!r}")
    page.get_by_role("button", name="Original scene").click()
    until(forge, "document.querySelector('.compare-with').textContent.includes('original')")
    until(forge, "document.querySelector('[data-compared=added]').textContent === '2 cells'")
    page.get_by_role("button", name="Close comparison").click()
    forge.until("s.view.colourBy", "class")


def test_the_scene_is_downloaded_and_installed(forge, shot, tmp_path):
    page = forge.page
    page.locator("[data-menu='export']").click()
    page.get_by_role("menuitem", name="Export to a file, Minecraft or a server…").click()
    page.wait_for_selector(".sheet.export:visible")
    shot(forge, "export-sheet")
    page.locator("[data-field='export-scale']").select_option("1")
    with page.expect_download(timeout=MOST_MS) as download:
        page.locator("[data-export='occ']").click()
    held = json.loads(download.value.path().read_text())
    assert held["format"] == "world2minecraft/occ"
    page.locator("[data-place='install']").click()
    until(forge, "document.querySelector('.export').textContent.includes('Installed ')")
    saves = tmp_path / "user" / ".minecraft" / "saves"
    assert [(path / "level.dat").is_file() for path in saves.iterdir()] == [True]
    shot(forge, "export-installed")
    with Console() as console:
        page.get_by_text("Build on a running server").click()
        page.get_by_label("Address").fill(f"127.0.0.1:{console.port}")
        page.get_by_label("Password").fill("secret")
        page.locator("[data-place='server']").click()
        until(forge, "/[0-9,]+ commands/.test(document.querySelector('.export').textContent)")
        assert "minecraft:dark_oak_stairs" in {
            name.partition("[")[0] for name in console.blocks.values()
        }
    page.keyboard.press("Escape")
