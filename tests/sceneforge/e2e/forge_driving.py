"""Drives the page through real mouse and keys, and reads what it knows by its test hook."""

import json
import time
from typing import Any

PATIENCE_S = 20.0  # Two busy cores draw by software.


class Driver:
    """One tab."""

    def __init__(self, page: Any):
        self.page = page
        self.mistakes: list[str] = []
        page.on("pageerror", lambda error: self.mistakes.append(str(error)))
        page.on("console", lambda said: said.type == "error" and self.mistakes.append(said.text))

    def state(self, expression: str) -> Any:
        """Return an expression of ``s``, the store's state; sets and maps become lists."""
        return self.page.evaluate(
            "(() => { const s = window.__forge.store.get(); const value = "
            + expression
            + "; return value instanceof Set || value instanceof Map ? [...value] : value; })()"
        )

    def until(self, expression: str, wanted: Any = True) -> Any:
        """Wait until an expression of the state is what is wanted, and return it."""
        end = time.monotonic() + PATIENCE_S
        while (now := self.state(expression)) != wanted:
            assert time.monotonic() < end, f"{expression} stays {now!r}, not {wanted!r}"
            self.page.wait_for_timeout(20)
        return now

    def rev(self) -> int:
        return self.state("s.scene.rev")

    def idle(self) -> None:
        """Wait until everything is drawn."""
        self.page.evaluate("window.__forge.idle()")
        self.page.wait_for_timeout(60)

    def key(self, *keys: str) -> None:
        for key in keys:
            self.page.keyboard.press(key)

    def mode(self, name: str) -> None:
        self.page.locator(f"[data-action='mode.{name}']").click()
        self.until("s.mode", name)

    def action(self, name: str):
        return self.page.locator(f"[data-action='{name}']:visible").first

    def object_at(self, number: int) -> tuple[float, float]:
        """Where an object's centre is on the page."""
        return self.point_at(self.state(f"s.objects.get({number}).center_m"))

    def point_at(self, point_m: list[float]) -> tuple[float, float]:
        """Where a point of the room, in metres, is on the page."""
        self.idle()
        x, y = self.page.evaluate(f"window.__forge.view.project({json.dumps(list(point_m))})")
        box = self.page.locator("canvas.canvas").bounding_box()
        return box["x"] + x, box["y"] + y

    def drag(self, start, end, button="left", steps=6, up=True) -> None:
        mouse = self.page.mouse
        mouse.move(*start)
        mouse.down(button=button)
        mouse.move(*end, steps=steps)
        if up:
            mouse.up(button=button)

    def slide(self, field: str, value: float) -> None:
        """Move a slider by its keys to a value near to one."""
        self.page.locator(f"input[data-field='{field}']").fill(str(value))


def opened_page(page: Any, link: str, hints: bool, theme: str = "dark") -> Driver:
    """Open the link and wait for the room."""
    driver = Driver(page)
    if not hints:
        page.add_init_script("localStorage.setItem('sceneforge.hints', 'seen')")
    page.add_init_script(f"localStorage.setItem('sceneforge.theme', '{theme}')")
    page.goto(link)
    end = time.monotonic() + PATIENCE_S
    while not page.evaluate("Boolean(window.__forge?.store.get().scene)"):
        assert time.monotonic() < end, f"the page does not show the room: {driver.mistakes}"
        page.wait_for_timeout(20)
    driver.idle()
    return driver
