"""The phone page as a player sees it: a phone of 390 x 844, touched, from the code to the room."""

import os
import shutil
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from forge_driving import Driver
from PIL import Image

from world2minecraft.sceneforge import phone_captures
from world2minecraft.sceneforge.jobs.export_tasks import share
from world2minecraft.sceneforge.server.server_process import ForgeServer

MOST_MS = 60_000  # No measure of speed: machines that test are busy.
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}


@pytest.fixture
def server(tmp_path):
    with ForgeServer(None, port=0, home=tmp_path / "home", phone="127.0.0.1") as running:
        running.phone.access.new_code()
        yield running


@pytest.fixture
def held(browser, server):
    """A function that opens the phone page by a link, as the camera of a phone does."""
    contexts = []

    def opened(link=None, scheme="dark", **look) -> Driver:
        context = browser.new_context(**PHONE | look, color_scheme=scheme)
        contexts.append(context)
        driver = Driver(context.new_page())
        driver.page.goto(link or server.phone.access.link)
        driver.page.locator("h1").filter(has_not_text="Connecting").wait_for()
        return driver

    yield opened
    for context in contexts:
        context.close()


@pytest.fixture
def photos(tmp_path) -> list[str]:
    """Photos that show nothing, all of one name in folders of their own, as phones give them."""
    paths = []
    for number in range(3):
        path = tmp_path / str(number) / "image.jpg"
        path.parent.mkdir()
        noise = np.random.default_rng(number).integers(0, 255, (120, 160, 3), np.uint8)
        Image.fromarray(noise).save(path)
        paths.append(str(path))
    return paths


@pytest.fixture
def quick(monkeypatch, example_run):
    """A reconstruction that is there at once: the finished run of another capture."""

    def task(name, within, **needs):
        def survey(report):
            report("look", 3, 3)
            return {"can_start": True, "route": "photos", "frames": 3}

        def reconstruct(report):
            report("poses", 1, 3)
            shutil.copytree(example_run.folder, needs["out"], dirs_exist_ok=True)
            while not (within / "go").exists():
                report("fuse", 2, 3)
                time.sleep(0.05)
            return {"objects": 15}

        def page(report):
            return share(**needs, progress=report)

        return {"survey": survey, "reconstruct": reconstruct, "share": page}[name]

    monkeypatch.setattr(phone_captures, "run_in_subprocess", task)


def pick(page, label: str, paths) -> None:
    with page.expect_file_chooser() as chooser:
        page.get_by_label(label, exact=True).tap()
    chooser.value.set_files(paths)


def wait_for(page, words: str) -> None:
    page.get_by_text(words).first.wait_for(timeout=MOST_MS)


def heading(page) -> str:
    return page.locator("h1").inner_text()


def keep(driver, name: str) -> None:
    """Keep a picture in both themes where the one who runs the tests wants some."""
    if folder := os.environ.get("W2M_SHOTS"):
        for scheme in ("light", "dark"):
            driver.page.emulate_media(color_scheme=scheme)
            driver.page.wait_for_timeout(150)
            driver.page.screenshot(path=Path(folder) / f"{name}-{scheme}.png")


def fits(page) -> bool:
    """Whether nothing is wider than the phone."""
    return page.evaluate("document.documentElement.scrollWidth <= innerWidth")


@contextmanager
def cut_off(driver):
    """A connection that is lost."""
    driver.page.context.set_offline(True)
    yield
    driver.page.context.set_offline(False)


def test_a_phone_sends_photos_and_walks_in_the_room(held, server, photos, quick):
    driver = held()
    page = driver.page
    assert heading(page) == "Scan your room" and "#" not in page.url
    assert fits(page)
    keep(driver, "phone-take")
    pick(page, "Take photos", photos[:1])
    assert heading(page) == "1 photo"
    pick(page, "Choose more", photos[1:])
    assert heading(page) == "3 photos" and fits(page)
    keep(driver, "phone-chosen")
    page.route("**/files/1?at=*", lambda route: route.abort())
    page.get_by_role("button", name="Build the room").tap()
    wait_for(page, "Connection lost")
    keep(driver, "phone-send-lost")
    page.unroute("**/files/1?at=*")
    wait_for(page, "Fusing depth")
    wait_for(page, "left")
    keep(driver, "phone-build")
    with cut_off(driver):
        wait_for(page, "does not answer")
        keep(driver, "phone-build-lost")
    page.reload()
    wait_for(page, "Building your room")
    (one,) = server.workspace.captures.all()
    assert sorted(path.name for path in one.source.iterdir()) == [
        "0001.jpg",
        "0002.jpg",
        "0003.jpg",
    ]
    (one.source.parent / "go").touch()
    wait_for(page, "Your room is ready")
    page.locator(".room-picture").evaluate("one => one.decode()")
    assert fits(page)
    keep(driver, "phone-done")
    assert all("net::ERR_" in one for one in driver.mistakes)  # Those that the test made.
    page.get_by_text("Walk in it").tap()
    page.wait_for_url("**/room")
    end = time.monotonic() + MOST_MS / 1000
    while not page.evaluate("Boolean(window.__room)"):
        assert time.monotonic() < end, driver.mistakes
        page.wait_for_timeout(50)
    page.get_by_role("button", name="Walk", exact=True).tap()
    assert page.evaluate("window.__room.page.mode") == "walk"
    keep(driver, "phone-room")
    page.go_back()
    wait_for(page, "Your room is ready")


def test_photos_that_show_nothing_fail_with_what_helps(held, photos):
    driver = held()
    page = driver.page
    pick(page, "Choose from this phone", photos[:1])
    page.get_by_role("button", name="Build the room").tap()
    wait_for(page, "That did not work")
    assert "pose estimation requires 3 or more" in page.locator(".trouble").inner_text()
    keep(driver, "phone-failed")
    page.get_by_role("button", name="Scan again").tap()
    assert heading(page) == "Scan your room"


def test_wrong_files_are_refused_on_the_phone(held, photos, tmp_path):
    driver = held()
    page = driver.page
    (tmp_path / "notes.pdf").write_bytes(b"hello")
    pick(page, "Choose from this phone", str(tmp_path / "notes.pdf"))
    assert "neither a photo nor a video" in page.locator(".trouble").inner_text()
    keep(driver, "phone-wrong")
    (tmp_path / "room.mp4").write_bytes(b"video")
    pick(page, "Film the room", str(tmp_path / "room.mp4"))
    assert heading(page) == "Your video"
    keep(driver, "phone-video")
    page.get_by_role("button", name="Start over").tap()
    pick(page, "Choose from this phone", [*photos, str(tmp_path / "room.mp4")])
    assert "photos, or one video" in page.locator(".trouble").inner_text()


def test_a_code_works_once_and_says_so(held, server):
    link = server.phone.access.link
    assert heading(held(link).page) == "Scan your room"
    second = held(link)
    assert heading(second.page) == "Scan the code"
    assert "used or too old" in second.page.locator(".trouble").inner_text()
    keep(second, "phone-scan")


def test_the_start_page_shows_a_code_until_it_is_used(held, server, browser):
    context = browser.new_context(viewport={"width": 1280, "height": 720})
    driver = Driver(context.new_page())
    page = driver.page
    page.goto(server.link)
    code = page.locator(".phone-code")
    code.evaluate("one => one.decode()")
    assert page.locator(".phone-link").inner_text() == server.phone.access.link
    keep_start(driver, "start-phone")
    held()
    page.get_by_text("1 phone is connected").wait_for(timeout=MOST_MS)
    (phone,) = server.phone.access.phones
    sent = server.workspace.captures.create("Phone scan", [{"path": "a.jpg", "size": 1}])
    phone.captures.append(sent.id)
    page.locator(".room-row").get_by_text("Phone scan").wait_for(timeout=MOST_MS)
    keep_start(driver, "start-phone-used")
    page.get_by_role("button", name="New code").click()
    code.wait_for(timeout=MOST_MS)
    assert server.phone.access.link
    context.close()


def keep_start(driver, name: str) -> None:
    if folder := os.environ.get("W2M_SHOTS"):
        for theme in ("light", "dark"):
            driver.page.evaluate(f"document.documentElement.dataset.theme = '{theme}'")
            driver.page.screenshot(path=Path(folder) / f"{name}-{theme}.png")
