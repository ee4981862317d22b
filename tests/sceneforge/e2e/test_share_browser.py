"""The page of a shared room as a friend opens it: from disk, in a browser, on a phone."""

import math
import time

import pytest

import world2minecraft as w2m

PATIENCE_S = 30.0  # Two busy cores draw by software.
ROOM = "window.__room.page"
HINTS = "getComputedStyle(document.querySelector('.thumbs')).display"


@pytest.fixture(scope="module")
def room_page(example_run, example_scan, tmp_path_factory) -> str:
    """The address of a page with photos, and a title that must not break out."""
    path = tmp_path_factory.mktemp("shared") / "room.html"
    w2m.share(example_run, path, photos=3, capture=example_scan, title="</script><b>Our study")
    return path.as_uri()


@pytest.fixture
def opened(browser, room_page):
    """Open the page; a request, an error on the console or a late first frame fails the test."""
    contexts, seen = [], []

    def opening(**look):
        context = browser.new_context(**look)
        contexts.append(context)
        page = context.new_page()
        page.on("request", lambda request: seen.append(request.url))
        page.on("console", lambda said: seen.append(said.text) if said.type == "error" else None)
        page.on("pageerror", lambda error: seen.append(str(error)))
        page.goto(room_page)
        wait(page, "Boolean(window.__room)")
        page.evaluate("window.__room.idle()")
        return page

    yield opening
    for context in contexts:
        context.close()
    assert [one for one in seen if not one.startswith(("data:", "blob:"))] == [room_page] * len(
        contexts
    )


def pixel_of(page, name: str) -> tuple[float, float]:
    """A pixel in which a thing is drawn."""
    return page.evaluate(
        f"""(name) => {{
          const page = {ROOM}, box = document.querySelector("canvas").getBoundingClientRect();
          for (let y = 4; y < box.height; y += 6) for (let x = 4; x < box.width; x += 6)
            if (page.thingAt(x, y)?.name === name
              && document.elementFromPoint(x + box.x, y + box.y).matches("canvas"))
              return [x + box.x, y + box.y];
        }}""",
        name,
    )


def wait(page, expression: str) -> None:
    """Wait without a function in the page, which its policy forbids."""
    end = time.monotonic() + PATIENCE_S
    while not page.evaluate(expression):
        assert time.monotonic() < end, expression
        page.wait_for_timeout(30)


def test_a_friend_looks_around_and_is_led_to_a_thing(opened):
    page = opened(viewport={"width": 1280, "height": 720})
    assert page.title() == "</script><b>Our study" and page.locator("b").count() == 0
    assert page.evaluate("performance.getEntriesByName('room-first').length") == 1
    names = page.locator(".thing-name").all_inner_texts()
    assert len(names) > 3
    azimuth = page.evaluate(f"{ROOM}.view.orbit.azimuth")
    page.mouse.move(700, 90)
    page.mouse.down()
    page.mouse.move(820, 90, steps=4)
    page.mouse.up()
    assert page.evaluate(f"{ROOM}.view.orbit.azimuth") < azimuth - 0.2
    page.evaluate("window.__room.idle()")
    things = page.evaluate(f"{ROOM}.room.facts.things.map(one => one.name)")
    name = next(one for one in things if pixel_of(page, one))
    page.mouse.click(*pixel_of(page, name))
    assert page.locator(".label-name").inner_text().casefold() == name.casefold()
    page.locator(".go-input").fill("where is the zeppelin")
    page.keyboard.press("Enter")
    assert "There is no “zeppelin” here" in page.locator(".go-said").inner_text()
    page.locator(".go-near").first.click()
    wait(page, "/^Here is/.test(document.querySelector('.go-said').textContent)")
    feet = page.evaluate(f"{ROOM}.stroll.walker.feet")
    page.get_by_role("button", name="Walk", exact=True).click()
    page.keyboard.down("KeyS")
    wait(page, f"Math.hypot(...{ROOM}.stroll.walker.feet.map((v, i) => v - {feet}[i])) > 0.1")
    page.keyboard.up("KeyS")
    page.keyboard.press("Escape")
    assert page.evaluate(f"{ROOM}.mode") == "look"
    page.get_by_role("button", name="Photos").click()
    assert page.locator(".photo-picture").evaluate("async (one) => (await one.decode(), one.width)")
    page.get_by_role("slider").fill("100")
    assert "inset(0px 100% 0px 0px)" in page.locator(".photo-picture").get_attribute("style")


def test_thumbs_walk_on_a_phone_and_night_falls(opened):
    page = opened(viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    assert page.evaluate(HINTS) == "none"
    page.get_by_role("button", name="Night").tap()
    assert page.evaluate(f"{ROOM}.light") == "night"
    page.get_by_role("button", name="Walk", exact=True).tap()
    assert page.evaluate(HINTS) == "block"
    feet, yaw = page.evaluate(f"[{ROOM}.stroll.walker.feet, {ROOM}.stroll.walker.yawDeg]")
    touch = page.context.new_cdp_session(page)
    stick = page.locator(".thumb-stick").bounding_box()
    x, y = stick["x"] + stick["width"] / 2, stick["y"] + stick["height"] / 2

    def fingers(kind, *points):
        at = [{"x": a, "y": b, "id": number} for number, (a, b) in enumerate(points)]
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": at})

    fingers("touchStart", (x, y))
    fingers("touchMove", (x, y + 50))
    fingers("touchStart", (x, y + 50), (300, 300))
    fingers("touchMove", (x, y + 50), (240, 300))
    wait(page, f"Math.hypot(...{ROOM}.stroll.walker.feet.map((v, i) => v - {feet}[i])) > 0.05")
    wait(page, f"{ROOM}.stroll.walker.yawDeg < {yaw} - 10")
    fingers("touchEnd")
    assert page.locator(".more").is_visible()
    page.get_by_role("button", name="From above").tap()
    page.locator(".more").tap()
    page.locator(".thing").first.tap()
    distance = page.evaluate(f"{ROOM}.view.orbit.distance")
    assert page.locator(".label").is_visible() and math.isfinite(distance)
