"""From a capture to a room that is open in the editor, by real mouse, without a shell."""

import base64
import io
import json
import os
import time
import zipfile
from pathlib import Path

import numpy as np
import pytest
from forge_driving import Driver
from PIL import Image
from scipy.ndimage import gaussian_filter

from roomplans import captured_room
from world2minecraft.procgen import generate_room, scan_room
from world2minecraft.sceneforge.server.server_process import ForgeServer

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


def drop(page, files: dict[str, bytes]) -> None:
    """Drop files anywhere on the page."""
    told = [[name, base64.b64encode(data).decode()] for name, data in files.items()]
    page.evaluate(
        """(told) => {
            const files = new DataTransfer();
            for (const [name, data] of told) {
                const bytes = Uint8Array.from(atob(data), (one) => one.charCodeAt(0));
                files.items.add(new File([bytes], name));
            }
            const page = document.querySelector(".start-page");
            for (const kind of ["dragenter", "dragover", "drop"]) {
                page.dispatchEvent(
                    new DragEvent(kind, { dataTransfer: files, bubbles: true, cancelable: true }),
                );
            }
        }""",
        told,
    )
    page.wait_for_selector(".survey", timeout=MOST_MS)


def test_a_folder_is_looked_at_before_anything_is_made(start, capture, shot):
    page = start.page
    assert page.locator(".drop strong").inner_text() == "Drop a capture here"
    keep(shot, start, "start")
    choose(page, "folder", "Choose folder…", str(capture))
    page.wait_for_selector(".survey", timeout=MOST_MS)
    assert page.locator(".capture-head h2").inner_text() == "study"
    assert "osed RGB-D frames, about" in page.locator(".survey-called").inner_text()
    picture = page.locator(".survey-picture img")
    picture.evaluate("one => one.decode()")
    assert picture.evaluate("one => one.naturalWidth") == 1600
    assert page.locator("[data-field='known']").count() == 0, "depth tells the scale"
    keep(shot, start, "start-found")
    assert unexpected(start) == []


def test_a_dropped_plan_becomes_a_room_and_closes_again(start, shot):
    """Apple's RoomPlan as JSON: from the drop to the room in the editor, and back."""
    page = start.page
    layout = generate_room(3, kind="study").layout
    drop(page, {"Room.json": json.dumps(captured_room(layout)).encode()})
    page.locator(".choices [data-value='2']").click()
    assert "as players usually build rooms" in page.locator(".choices").inner_text()
    page.locator("[data-do='start']").click()
    page.wait_for_selector(".progress-bar")
    until(page, "document.querySelector('.progress-foot .note')?.textContent.includes('left')")
    keep(shot, start, "start-making")
    page.locator("[data-do='open']").click(timeout=MOST_MS)
    until(page, "Boolean(window.__forge?.store.get().scene)")
    start.until("s.scene.objects.length > 0")
    start.idle()
    keep(shot, start, "start-opened")
    page.locator("[data-action='start']").click()
    page.wait_for_selector(".drop")
    assert "Ready" in page.locator(".room-row").first.inner_text()
    assert unexpected(start) == []


def test_a_dropped_video_is_asked_for_a_length_that_is_known(start, tmp_path):
    page = start.page
    write_video(tmp_path / "IMG_2041.MOV")
    drop(page, {"IMG_2041.MOV": (tmp_path / "IMG_2041.MOV").read_bytes()})
    assert page.locator(".capture-head h2").inner_text() == "IMG_2041"
    button = page.locator("[data-do='start']")
    page.locator("[data-field='known']").select_option("ceiling height")
    assert button.get_attribute("aria-disabled") == "true", "how high is it?"
    page.locator("[data-field='metres']").fill("2.6")
    assert button.get_attribute("aria-disabled") != "true"
    with page.expect_request("**/reconstruct") as asked:
        button.click()
    assert asked.value.post_data_json["known"] == ["ceiling height", 2.6]
    page.get_by_role("button", name="Cancel").click()
    until(page, "document.querySelector('.trouble:not([hidden])')?.textContent === 'Cancelled'")
    assert unexpected(start) == []


def write_video(path: Path) -> None:
    """Write two seconds of a phone's video: sideways along a wall with marks of all sizes."""
    av = pytest.importorskip("av")
    random = np.random.default_rng(0)
    layers = [
        gaussian_filter(random.standard_normal((128, 900)), size) * size for size in (1, 2, 6)
    ]
    wall = np.clip(128 + 60 * sum(layers) / np.std(sum(layers)), 0, 255).astype(np.uint8)
    with av.open(str(path), "w", format="mov") as container:
        stream = container.add_stream("mpeg4", rate=24)
        stream.width, stream.height, stream.pix_fmt = 192, 128, "yuv420p"
        stream.bit_rate = 4_000_000
        for left in np.linspace(0, 600, 48).astype(int):
            picture = np.stack([wall[:, left : left + 192]] * 3, -1)
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        container.mux(stream.encode(None))


def keep(shot, driver, name) -> None:
    """Keep a picture, where wanted, of a page that may show no scene."""
    if folder := os.environ.get("W2M_SHOTS"):
        driver.page.screenshot(path=Path(folder) / f"{name}.png")


def test_what_is_no_capture_teaches_what_is(start, tmp_path):
    page = start.page
    (tmp_path / "notes.pdf").write_bytes(b"hello")
    choose(page, "files", "Choose files…", str(tmp_path / "notes.pdf"))
    page.wait_for_selector(".trouble:visible", timeout=MOST_MS)
    until(page, "document.body.innerText.includes('supported formats: ')")
    assert "supported formats: " in page.locator(".trouble:visible").inner_text()
    page.get_by_role("button", name="Back", exact=True).click()
    page.wait_for_selector(".drop")
    row = page.locator(".room-row")
    assert row.count() == 1 and "Not started" in row.inner_text()
    row.click()
    page.get_by_role("button", name="Delete").click()
    page.get_by_role("button", name="Delete capture and room?").click()
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


def test_a_zip_of_photos_of_a_phone_is_looked_at(start):
    """HEIC, as phones write it, and JPEG in one zip."""
    heif = pytest.importorskip("pillow_heif")
    heif.register_heif_opener()
    page, packed = start.page, io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for number, suffix in enumerate((".HEIC", ".HEIC", ".jpg")):
            noise = np.random.default_rng(number).integers(0, 255, (12, 16, 3), np.uint8)
            picture = Image.fromarray(noise.repeat(20, axis=0).repeat(20, axis=1))
            held = io.BytesIO()
            picture.save(held, "HEIF" if suffix == ".HEIC" else "JPEG")
            archive.writestr(f"den/IMG_{number}{suffix}", held.getvalue())
    drop(page, {"den.zip": packed.getvalue()})
    assert page.locator(".capture-head h2").inner_text() == "den"
    assert "3 " in page.locator(".survey").first.inner_text()
    picture = page.locator(".survey-picture img")
    picture.evaluate("one => one.decode()")
    assert unexpected(start) == []
