"""Build and Walk as a person sees them: blocks by their colours, clicks, walls that stop one."""

import io
import json
import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from forge_driving import opened_page
from PIL import Image
from tests.external_models.scripted_server import scripted

from world2minecraft.sceneforge.agent_walks import WalkAgents
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.server.server_process import ForgeServer

BLOCKS = "window.__forge.build.blocks"
FEET = "window.__forge.walk.walker.feet"


@pytest.fixture(scope="module")
def server(room, tmp_path_factory) -> Iterator[ForgeServer]:
    """One server for all of these tests, which keeps the blocks that it has built."""
    editor = Editor(replace(room, folder=tmp_path_factory.mktemp("built")))
    with ForgeServer(editor, port=0) as running:
        yield running


def build(forge, **wish):
    """Go to Build and wait for its blocks."""
    if forge.state("s.mode") != "build":
        forge.mode("build")
    if wish:
        forge.page.evaluate("wish => window.__forge.build.wish(wish)", wish)
    made(forge)


def made(forge):
    forge.page.evaluate("window.__forge.build.loader.idle()")
    forge.idle()


def picture(forge) -> np.ndarray:
    """The canvas, uint8 [H, W, 3]."""
    forge.idle()
    data = forge.page.locator("canvas.canvas").screenshot()
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))


def facts(forge, name):
    return forge.page.evaluate(f"{BLOCKS}.mesh.facts.{name}")


def seen(forge) -> dict[int, np.ndarray]:
    """Where each object's blocks are seen on the canvas, and the colour that they should have
    there by their texture's mean, tint and shade: rows x, y, red, green, blue."""
    rows = forge.page.evaluate(
        """() => {
          const { build, view } = window.__forge, { blocks } = build, { mesh } = blocks;
          const area = mesh.facts.texture_px ** 2, rows = [], means = new Map();
          const meanOf = (layer) => {
            if (means.has(layer)) return means.get(layer);
            const mean = [0, 0, 0];
            for (let t = 0; t < area; t++)
              for (let c = 0; c < 3; c++) mean[c] += mesh.texels[(layer * area + t) * 4 + c] / area;
            means.set(layer, mean);
            return mean;
          };
          for (let y = 9; y < view.canvas.clientHeight; y += 18)
            for (let x = 9; x < view.canvas.clientWidth; x += 18) {
              const ray = build.rayAt(x, y), met = blocks.meet(ray.from, ray.direction);
              if (!met || !mesh.instance[met.quad]) continue;
              const tint = mesh.colour.slice(met.quad * 16, met.quad * 16 + 4);
              const shade = (1.1 * tint[3]) / 255;
              const mean = meanOf(mesh.kind[met.quad * 16]);
              const colour = mean.map((c, i) => (c * shade * tint[i]) / 255);
              rows.push([mesh.instance[met.quad], x, y, ...colour]);
            }
          return rows;
        }"""
    )
    table = np.array(rows)
    return {int(number): table[table[:, 0] == number, 1:] for number in np.unique(table[:, 0])}


def walk(forge):
    forge.mode("walk")
    until(forge, "Boolean(window.__forge.walk.walker && window.__forge.view.pose)")
    until(forge, "window.__forge.walk.walker.body.onGround")


def until(forge, expression):
    """Wait until an expression of the page is true."""
    for _ in range(400):
        if forge.page.evaluate(expression):
            return
        forge.page.wait_for_timeout(25)
    raise AssertionError(f"{expression} never became true")


def hold(forge, key, until_true):
    forge.page.keyboard.down(key)
    until(forge, until_true)
    forge.page.keyboard.up(key)


def test_build_shows_the_blocks_in_their_colours(forge, shot):
    voxels = picture(forge)
    build(forge)
    shot(forge, "build")
    blocks = picture(forge)
    assert len(np.unique(blocks.reshape(-1, 3), axis=0)) > 3000, "textures have many colours"
    assert (np.abs(blocks.astype(int) - voxels).max(axis=2) > 12).mean() > 0.2
    errors = []
    for places in seen(forge).values():
        if len(places) >= 8:
            x, y = places[:, :2].astype(int).T
            shown = np.median(blocks[y, x], axis=0)
            errors.append(np.abs(shown - np.median(places[:, 2:], axis=0)).max())
    assert len(errors) >= 5
    assert np.median(errors) < 20 and max(errors) < 60, "corners are darker, textures are grained"


def test_sizes_and_styles_give_other_blocks(forge, shot):
    build(forge)
    few = facts(forge, "blocks")
    page = forge.page
    page.locator("[data-panel='build'] [data-value='12.5']").click()
    made(forge)
    shot(forge, "build-voxel")
    assert facts(forge, "blocks") > 5 * few and facts(forge, "blocks_per_metre") == 12.5
    page.locator("[data-panel='build'] [data-value='4']").click()
    page.locator("[data-panel='build'] [data-value='display']").click()
    made(forge)
    shot(forge, "build-display")
    assert page.evaluate(f"Array.from({BLOCKS}.mesh.state).includes(65535)"), "display entities"
    assert facts(forge, "blocks_per_metre") == 4


def test_a_click_shows_block_and_object_and_can_turn_it(forge, shot):
    build(forge)
    chair = forge.state("[...s.objects.values()].find(one => one.class_id === 5).id")
    x, y = np.median(seen(forge)[chair], axis=0)[:2]
    forge.page.locator("canvas.canvas").click(position={"x": float(x), "y": float(y)})
    forge.until("s.selectedObjects", [chair])
    panel = forge.page.locator("[data-panel='block']")
    assert panel.locator("[data-build='object']").inner_text() == f"Part of chair {chair}"
    assert panel.locator("code").inner_text().startswith("minecraft:")
    forge.idle()
    shot(forge, "build-click")
    before, rev = forge.state(f"s.objects.get({chair}).yaw_deg"), forge.rev()
    forge.key("r")
    forge.until("s.scene.rev", rev + 1)
    made(forge)
    assert facts(forge, "rev") == rev + 1, "the blocks follow the edit"
    assert forge.state(f"s.objects.get({chair}).yaw_deg") != before
    forge.key("Control+z")
    forge.until("s.scene.rev", rev + 2)
    made(forge)
    assert facts(forge, "rev") == rev + 2


def test_near_walls_open_and_the_legend_hides_classes(forge):
    build(forge)
    page = forge.page
    cut = page.evaluate(f"{BLOCKS}.hidden.cuts")
    page.evaluate("view => {view.orbit = {...view.orbit, azimuth: view.orbit.azimuth + Math.PI}}",
                  page.evaluate_handle("window.__forge.view"))  # fmt: skip
    forge.idle()
    assert page.evaluate(f"{BLOCKS}.hidden.cuts") != cut, "other walls are near now"
    whole = picture(forge)
    page.locator("[data-field='cut-open']").uncheck()
    assert (picture(forge) != whole).any(axis=2).mean() > 0.05
    page.locator(".legend-row[data-class='3'] .mini").nth(2).click()
    forge.until("s.view.hidden.has(3)")
    forge.idle()
    assert page.evaluate(f"{BLOCKS}.hidden.classes") & 8


def test_one_walks_until_a_wall_stops_and_jumps(forge, shot):
    build(forge)
    walk(forge)
    page = forge.page
    shot(forge, "walk")
    start = page.evaluate(FEET)
    assert abs(start[2]) < 0.3 and len(np.unique(picture(forge).reshape(-1, 3), axis=0)) > 1000
    page.keyboard.down("ArrowRight")  # To a wall without furniture before it, by keys alone.
    until(
        forge,
        "window.__forge.view.pose.forward[1] < -0.9 || window.__forge.view.pose.forward[0] < -0.9",
    )
    page.keyboard.up("ArrowRight")
    hold(forge, "w", "window.__forge.walk.walker.body.hitWall")
    there = page.evaluate(FEET)
    assert np.hypot(there[0] - start[0], there[1] - start[1]) > 0.2
    page.keyboard.down("w")
    page.wait_for_timeout(400)
    page.keyboard.up("w")
    size = forge.state("s.scene.shape.map(n => n * s.scene.voxel_m)")
    low = forge.state("s.scene.origin_m")
    feet = page.evaluate(FEET)
    assert all(low[i] < feet[i] < low[i] + size[i] for i in (0, 1)), "walls hold"
    shot(forge, "walk-wall")
    page.keyboard.down("Space")
    until(forge, f"{FEET}[2] > {feet[2] + 0.3}")
    page.keyboard.up("Space")
    until(forge, "window.__forge.walk.walker.body.onGround")


def test_a_sentence_leads_to_a_thing_before_ones_eyes(forge, shot):
    build(forge)
    page, said = forge.page, forge.page.locator(".go-said")
    forge.key("g")
    forge.until("s.mode", "walk")
    until(forge, "window.__forge.walk.walker !== null")
    assert page.evaluate("document.activeElement.className") == "go-input"
    page.locator(".go-input").fill("where is the zeppelin")
    forge.key("Enter")
    page.locator(".go-near").first.wait_for()
    assert "There is no “zeppelin” here" in said.inner_text()
    shot(forge, "walk-unknown")
    start = page.evaluate(FEET)
    page.locator(".go-near", has_text="lamp").click()
    until(forge, "/^Walking to the lamp/.test(document.querySelector('.go-said').textContent)")
    until(forge, f"Math.hypot({FEET}[0] - {start[0]}, {FEET}[1] - {start[1]}) > 0.3")
    until(forge, "/^Here is the lamp/.test(document.querySelector('.go-said').textContent)")
    forge.until("s.selectedObjects", [16])
    shot(forge, "walk-led")
    page.locator(".go-input").fill("to the tv stand")
    forge.key("Enter")
    until(forge, "/^Walking/.test(document.querySelector('.go-said').textContent)")
    page.keyboard.press("a")
    until(forge, "document.querySelector('.go-said').textContent === ''")


def test_a_model_walks_and_says_what_it_thinks(browser, room, tmp_path, shot):
    turn, go, stop = (
        json.dumps({"thought": thought, "progress": "", "actions": moves, "done": "STOP" in moves})
        for thought, moves in (
            ("Where is the lamp?", ["LEFT", "LEFT", "LEFT"]),
            ("There it is, behind the sofa.", ["RIGHT", "FORWARD"]),
            ("I am there.", ["STOP"]),
        )
    )
    with (
        scripted([turn, go, stop]) as model,
        ForgeServer(
            Editor(replace(room, folder=tmp_path)), port=0, agents=WalkAgents((model.url,))
        ) as server,
    ):
        context = browser.new_context(viewport={"width": 1280, "height": 760})
        forge = opened_page(context.new_page(), server.link, hints=False)
        build(forge)
        page = forge.page
        forge.key("g")
        until(forge, "window.__forge.walk.walker !== null")
        start = page.evaluate(FEET)
        page.locator(".go-who").select_option(model.url)
        page.locator(".go-input").fill("go to the lamp")
        forge.key("Enter")
        until(forge, "/Where is the lamp/.test(document.querySelector('.go-said').textContent)")
        shot(forge, "walk-agent")
        until(
            forge, "/has stopped, [0-9.]+ m/.test(document.querySelector('.go-said').textContent)"
        )
        shot(forge, "walk-agent-end")
        end = page.evaluate(FEET)
        assert 0.15 < math.dist(start[:2], end[:2]) < 0.35
        assert forge.mistakes == []
        page.locator(".go-input").fill("go to the lamp")
        model.script = lambda _asked, _number: go
        forge.key("Enter")
        until(forge, "/There it is/.test(document.querySelector('.go-said').textContent)")
        page.keyboard.press("a")
        until(forge, "document.querySelector('.go-said').textContent === ''")
        context.close()


def test_low_furniture_is_a_step_and_esc_leaves(forge):
    build(forge)
    walk(forge)
    table = forge.state("[...s.objects.values()].find(one => one.class_id === 8)")
    forge.page.evaluate(  # Look at the table: people do that by the mouse.
        """to => { const { walker } = window.__forge.walk, from = walker.feet;
          walker.yawDeg = 180 - Math.atan2(to[0] - from[0], to[1] - from[1]) * -180 / Math.PI; }""",
        table["center_m"],
    )
    hold(forge, "w", f"{FEET}[2] > 0.3")
    forge.key("Escape")
    forge.until("s.mode", "build")
    assert forge.page.evaluate("window.__forge.view.pose") is None


def test_voxels_are_walked_through_too(forge, shot):
    walk(forge)
    forge.page.locator("[data-panel='walk'] [data-value='voxels']").click()
    until(forge, "Math.abs(window.__forge.walk.walker.scale - 12.5) < 1e-6")
    assert not forge.page.evaluate(f"{BLOCKS}.group.visible")
    until(forge, "window.__forge.walk.walker.body.onGround")
    assert abs(forge.page.evaluate(FEET)[2]) < 0.3, "one stands where one stood"
    shot(forge, "walk-voxels")
    start = forge.page.evaluate(FEET)
    forge.page.keyboard.down("s")
    until(forge, f"Math.hypot({FEET}[0] - {start[0]}, {FEET}[1] - {start[1]}) > 0.2")
    forge.page.keyboard.up("s")


def test_the_mouse_looks_around_once_it_is_caught(forge):
    walk(forge)
    page = forge.page
    page.locator("canvas.canvas").click()
    until(forge, "document.pointerLockElement !== null")
    before = page.evaluate("window.__forge.walk.walker.yawDeg")
    page.mouse.move(600, 400)
    page.mouse.move(660, 400, steps=4)
    until(forge, f"Math.abs(window.__forge.walk.walker.yawDeg - {before}) > 2")
    page.evaluate("document.exitPointerLock()")
    forge.until("s.mode", "inspect")
