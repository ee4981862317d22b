"""How soon does SceneForge show a room's real blocks, and how smoothly are they drawn and walked?

``python -m benchmarks.check_forge_build [OUT]``

Needs playwright and a chromium; OUT is a run's folder, the demo room where it is left out. For each
size and style: seconds from the scene to its blocks, from the blocks to the packed mesh, its quads
and size; milliseconds of a whole picture of 748 x 730 pixels on software GL, from the start view
and from where a walk begins, each the best and the median of twelve with a read-back. Then ticks
of walking a second, in Python.
"""

import argparse
import shutil
import tempfile
import time
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from world2minecraft.forge.blocks import Build, BuildOptions, HeldScene
from world2minecraft.forge.editor import Editor
from world2minecraft.forge.serve import ForgeServer
from world2minecraft.walk import BlockWorld, Body, Keys, step

CHROMIUM = shutil.which("chromium") or "/usr/bin/chromium"
FLAGS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
)
WISHES = ((1.0, "blocks"), (2.0, "blocks"), (4.0, "blocks"), (4.0, "display"), (4.0, "voxels"),
          (12.5, "blocks"))  # fmt: skip
FRAMES = """() => {
  const { view } = window.__forge, gl = view.renderer.getContext(), times = [];
  const camera = view.sight.camera();
  for (let i = 0; i < 12; i++) {
    const start = performance.now();
    view.renderer.render(view.scene, camera);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    times.push(performance.now() - start);
  }
  times.sort((a, b) => a - b);
  return `${times[0].toFixed(0)} / ${times[6].toFixed(0)}`;
}"""


def until(page: Any, expression: str) -> None:
    """Wait until an expression of the page is true."""
    while not page.evaluate(f"Boolean({expression})"):
        page.wait_for_timeout(30)


def frames(page: Any, size: float, style: str) -> tuple[str, str]:
    """Return the milliseconds of a picture in Build and in Walk."""
    wish = {"size": size, "style": style}
    page.keyboard.press("Shift+4")
    page.evaluate("async wish => { __forge.build.wish(wish); await __forge.build.loader.idle(); "
                  "await __forge.idle(); }", wish)  # fmt: skip
    build = page.evaluate(FRAMES)
    page.keyboard.press("Shift+5")
    until(page, "__forge.walk.walker && __forge.view.pose")
    page.evaluate("__forge.idle()")
    walk = page.evaluate(FRAMES)
    page.keyboard.press("Escape")
    return build, walk


def made(editor: Editor, size: float, style: str) -> list[str]:
    """Return the best of three times of a build and of its mesh, and how large that is."""
    scene = HeldScene.of(editor)
    build_s, mesh_s, packed = 1e9, 1e9, b""
    for _ in range(3):
        start = time.perf_counter()
        build = Build.of(scene, BuildOptions(size, style))
        middle = time.perf_counter()
        packed = build.mesh_bytes()
        build_s = min(build_s, middle - start)
        mesh_s = min(mesh_s, time.perf_counter() - middle)
    return [f"{build_s:.2f}", f"{mesh_s:.2f}", f"{len(packed) / 1e6:.1f}"]


def ticks_a_second(editor: Editor) -> float:
    """Return how many ticks Python walks a second through the build at 4 blocks a metre."""
    build = Build.of(HeldScene.of(editor), BuildOptions())
    world, scale = BlockWorld.of_volume(build.volume), 4.0
    feet = tuple(a + b for a, b in zip(build.start[0], build.volume.corner, strict=True))
    body, start = Body(feet), time.perf_counter()  # type: ignore[arg-type]
    for tick in range(400):
        body = step(world, body, Keys(forward=True, jump=True, yaw_deg=tick * 7.0), scale)
    return 400 / (time.perf_counter() - start)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", nargs="?", type=Path)
    chosen = parser.parse_args()
    from playwright.sync_api import sync_playwright

    names = ("blocks / m", "style", "build s", "mesh s", "MB", "quads", "Build ms", "Walk ms")
    table = Table(*names)
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as running:
        editor = Editor.open(chosen.out, out=Path(folder))
        with ForgeServer(editor, port=0) as server:
            browser = running.chromium.launch(executable_path=CHROMIUM, args=list(FLAGS))
            page = browser.new_page(viewport={"width": 1280, "height": 800})
            page.goto(server.link)
            until(page, "window.__forge && __forge.store.get().scene")
            for size, style in WISHES:
                row = made(editor, size, style)
                drawn = frames(page, size, style)
                quads = page.evaluate("__forge.build.blocks.mesh.quads")
                table.add_row(f"{size:g}", style, *row, f"{quads:,}", *drawn)
            browser.close()
        ticks = ticks_a_second(editor)
    Console().print(table)
    Console().print(f"walking: {ticks:,.0f} ticks a second of one core, in Python")


if __name__ == "__main__":
    main()
