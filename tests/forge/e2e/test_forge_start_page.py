"""From a capture to a room that is open in the editor, by real mouse, without a shell."""

import os
import shutil
import time
from pathlib import Path

import pytest
from forge_driving import Driver

from world2minecraft.forge.serve import ForgeServer
from world2minecraft.rooms import generate_room, scan_room

MOST_MS = 60_000  # A room of ten frames takes ten seconds; machines that test are busy.


@pytest.fixture(scope="module")
def capture(tmp_path_factory) -> Path:
    """A generated study, scanned with ten frames."""
    folder = tmp_path_factory.mktemp("capture") / "study"
    scan_room(generate_room(3, kind="study"), folder, frames=10, width=200, height=150)
    return folder


@pytest.fixture
def start(browser, tmp_path):
    """The start page of a server whose home is empty."""
    with ForgeServer(None, port=0, home=tmp_path / "home") as server:
        context = browser.new_context(viewport={"width": 1280, "height": 800})
        driver = Driver(context.new_page())
        driver.page.goto(server.link)
        driver.page.wait_for_selector(".drop")
        driver.page.evaluate("localStorage.setItem('sceneforge.hints', 'seen')")
        yield driver
        context.close()


def choose(page, kind: str, label: str, paths) -> None:
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name=label).click()
    assert page.locator(f"[data-pick='{kind}']").count() == 1
    chooser.value.set_files(paths)


def until(page, expression: str) -> None:
    """Wait until an expression is true; the page forbids what Playwright would wait with."""
    end = time.monotonic() + MOST_MS / 1000
    while not is_true(page, expression):
        assert time.monotonic() < end, f"never: {expression}"
        page.wait_for_timeout(50)


def is_true(page, expression: str) -> bool:
    """Whether an expression is true now; not while the page is loaded anew."""
    try:
        return bool(page.evaluate(expression))
    except Exception as error:
        if "navigation" not in str(error):
            raise
        return False


def unexpected(driver) -> list[str]:
    """What went wrong; that no room is open yet is told as 404."""
    return [text for text in driver.mistakes if "404 (Not Found)" not in text]


def test_a_folder_becomes_a_room_in_the_editor(start, capture, shot):
    page = start.page
    assert page.locator(".drop strong").inner_text() == "Drop a capture here"
    keep(shot, start, "start")
    choose(page, "folder", "Choose a folder…", str(capture))
    page.wait_for_selector(".survey", timeout=MOST_MS)
    assert page.locator(".capture-head h2").inner_text() == "study"
    assert "osed RGB-D frames, about" in page.locator(".survey-called").inner_text()
    picture = page.locator(".survey-picture img")
    picture.evaluate("one => one.decode()")
    assert picture.evaluate("one => one.naturalWidth") == 1600
    keep(shot, start, "start-found")
    page.locator(".choices [data-value='2']").click()
    assert "usual size of rooms" in page.locator(".choices").inner_text()
    page.locator("[data-do='start']").click()
    page.wait_for_selector(".progress-bar")
    until(page, "document.querySelector('.progress-foot .note')?.textContent.includes('left')")
    keep(shot, start, "start-making")
    until(page, "Boolean(window.__forge?.store.get().scene)")
    start.until("s.scene.objects.length > 0")
    start.idle()
    keep(shot, start, "start-opened")
    assert unexpected(start) == []


def keep(shot, driver, name) -> None:
    """Keep a picture, where wanted, of a page that may show no scene."""
    if folder := os.environ.get("W2M_SHOTS"):
        driver.page.screenshot(path=Path(folder) / f"{name}.png")


def test_what_is_no_capture_teaches_what_is(start, tmp_path):
    page = start.page
    (tmp_path / "notes.pdf").write_bytes(b"hello")
    choose(page, "files", "Choose files…", str(tmp_path / "notes.pdf"))
    page.wait_for_selector(".trouble:visible", timeout=MOST_MS)
    until(page, "document.body.innerText.includes('a capture is one of these')")
    assert "a capture is one of these" in page.locator(".trouble:visible").inner_text()
    page.get_by_role("button", name="Back").click()
    page.wait_for_selector(".drop")
    row = page.locator(".room-row")
    assert row.count() == 1 and "Not started" in row.inner_text()
    row.click()
    page.get_by_role("button", name="Delete").click()
    page.get_by_role("button", name="Delete it and its room?").click()
    page.wait_for_selector(".drop")
    until(page, "document.querySelectorAll('.room-row').length === 0")


def test_making_a_room_can_be_cancelled(start):
    page = start.page
    page.locator("[data-demo='study']").click()
    page.wait_for_selector(".progress-bar")
    page.get_by_role("button", name="Cancel").click()
    page.wait_for_selector(".drop", timeout=MOST_MS)
    assert page.locator(".trouble:visible").inner_text() == "Cancelled"
    assert unexpected(start) == []


def test_a_zip_dropped_on_the_page_is_looked_at(start, capture, tmp_path):
    page = start.page
    packed = shutil.make_archive(str(tmp_path / "den"), "zip", capture.parent, capture.name)
    data = list(Path(packed).read_bytes())
    page.evaluate(
        """(data) => {
            const files = new DataTransfer();
            files.items.add(new File([new Uint8Array(data)], "den.zip"));
            const page = document.querySelector(".start-page");
            for (const kind of ["dragenter", "dragover", "drop"]) {
                page.dispatchEvent(
                    new DragEvent(kind, { dataTransfer: files, bubbles: true, cancelable: true }),
                );
            }
        }""",
        data,
    )
    page.wait_for_selector(".survey", timeout=MOST_MS)
    assert page.locator(".capture-head h2").inner_text() == "den"
