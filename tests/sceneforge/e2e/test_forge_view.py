"""The picture of the scene: what is meshed when, what pixels show, what the mouse and keys turn."""

import io

import numpy as np
from PIL import Image

STATS = "window.__forge.view.stats()"
ORBIT = "window.__forge.view.orbit"
BRIGHT = {"dark": (0x16, 0x18, 0x1D), "light": (0xF1, 0xF2, 0xF4)}


def picture(forge) -> np.ndarray:
    """The canvas as it stands on the screen, without what lies over it; uint8 [H, W, 3]."""
    forge.page.add_style_tag(content=".stage > :not(canvas) { visibility: hidden !important; }")
    forge.idle()
    data = forge.page.locator("canvas.canvas").screenshot()
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))


def share_of(shown: np.ndarray, colour, slack: int = 2) -> float:
    """Which share of the pixels has a colour."""
    return float((np.abs(shown.astype(int) - colour).max(axis=2) <= slack).mean())


def look(forge, **change) -> None:
    """Set parts of how the scene is shown."""
    forge.page.evaluate("(change) => window.__forge.store.setView(change)", change)
    forge.idle()


def test_hiding_needs_no_mesh_and_an_edit_only_touched_ones(forge):
    before = forge.page.evaluate(STATS)
    with_floor = picture(forge)
    forge.page.evaluate("window.__forge.store.setView({hidden: new Set([1, 2])})")
    without = picture(forge)
    assert share_of(with_floor, BRIGHT["dark"]) < share_of(without, BRIGHT["dark"])
    look(forge, slice={"axis": 2, "low": 0, "high": 9})
    assert (picture(forge) != without).any()
    assert forge.page.evaluate(STATS)["made"] == before["made"]
    made = before["made"]
    assert made > 4
    rev = forge.rev()
    flat = forge.page.evaluate(
        """() => { const {labels, scene: {shape: [, Y, Z]}} = window.__forge.store.get();
        for (let f = 0; f < labels.length; f++) {
          const cell = [Math.floor(f / (Y * Z)), Math.floor(f / Z) % Y, f % Z];
          if (labels[f] === 7 && cell.every((c) => c % 32 > 0 && c % 32 < 31)) return f; } }"""
    )
    command = {"op": "set_cells", "cells": [[flat, 1]], "class_id": 0, "verb": "erase"}
    forge.page.evaluate("(command) => window.__forge.connection.do(command)", command)
    forge.until("s.scene.rev", rev + 1)
    forge.idle()
    assert forge.page.evaluate(STATS)["made"] == made + 1


def test_pixels_show_the_theme_and_the_class_colours(forge, shot):
    dark = picture(forge)
    assert share_of(dark, BRIGHT["dark"]) > 0.2
    by_class = share_of(dark, (43, 160, 4), 25)
    assert by_class > 0.02, "the floor is seen in its class's colour"
    for by in ("confidence", "colour", "difference"):
        look(forge, colourBy=by)
        shown = picture(forge)
        assert share_of(shown, (43, 160, 4), 25) < by_class / 4, f"{by} still shows the class"
        assert share_of(shown, (0, 0, 0)) < 0.02, f"{by} is black"
        shot(forge, f"by_{by}")
    look(forge, colourBy="class")
    forge.page.evaluate("window.__forge.store.set({theme: 'light'})")
    assert share_of(picture(forge), BRIGHT["light"]) > 0.2
    forge.page.evaluate("window.__forge.store.set({theme: 'dark'})")
    whole = picture(forge)
    for change in ({"voxelSize": 0.5}, {"voxelSize": 1, "opacity": 0.3}):
        look(forge, **change)
        shown = picture(forge)
        assert (np.abs(shown.astype(int) - whole).max(axis=2) > 30).mean() > 0.05
        shot(forge, "_".join(change))


def test_cuts_apply_to_picking_and_an_idle_view_is_not_drawn(forge):
    x, y = forge.page.evaluate(
        "(() => { const {clientWidth: w, clientHeight: h} = window.__forge.view.canvas;"
        " return [w / 2, h / 2]; })()"
    )
    pick = f"window.__forge.view.pick({x}, {y})"
    assert forge.page.evaluate(pick)["cell"][2] > 0
    look(forge, slice={"axis": 2, "low": 0, "high": 0})
    hit = forge.page.evaluate(pick)
    assert hit["cell"][2] == 0 and hit["face"] == 2
    look(forge, slice=None, section={"low": [0, 0, 0], "high": [2, 2, 2]})
    assert forge.page.evaluate(pick) is None
    look(forge, section=None)
    forge.idle()
    forge.page.evaluate("window.__drawn = 0; window.__forge.view.onFrame.push(() => __drawn++)")
    forge.page.wait_for_timeout(300)
    assert forge.page.evaluate("__drawn") == 0
    forge.drag((620, 600), (640, 600))
    forge.idle()
    assert forge.page.evaluate("__drawn") > 1


def test_keys_wheel_and_corner_cube_move_the_camera(forge):
    start = forge.page.evaluate(ORBIT)
    forge.key("Control+ArrowLeft", "Control+ArrowUp")
    forge.idle()
    turned = forge.page.evaluate(ORBIT)
    assert turned["azimuth"] < start["azimuth"] and turned["elevation"] > start["elevation"]
    forge.key("Shift+PageUp")
    forge.idle()
    near = forge.page.evaluate(ORBIT)
    assert near["distance"] < turned["distance"]
    forge.key("Shift+ArrowRight")
    forge.idle()
    assert forge.page.evaluate(ORBIT)["target"] != near["target"]
    box = forge.page.locator("canvas.canvas").bounding_box()
    x, y = box["width"] * 0.4, box["height"] * 0.55
    point = forge.page.evaluate(f"window.__forge.view.pointAt({x}, {y})")
    forge.page.mouse.move(box["x"] + x, box["y"] + y)
    forge.page.mouse.wheel(0, -300)
    forge.idle()
    after = forge.page.evaluate("(point) => window.__forge.view.project(point)", point)
    assert np.allclose(after, [x, y], atol=1.5)
    sides = forge.page.locator(".compass-side:not(.is-off)")
    assert sides.count() == 3
    forge.page.locator(".compass-side", has_text="Top").click()
    forge.idle()
    assert forge.page.evaluate(ORBIT)["elevation"] > 1.5
    assert sides.count() == 1
    forge.page.locator(".compass-side", has_text="Top").click()
    forge.idle()
    assert forge.page.evaluate(ORBIT)["elevation"] < -1.5
