"""Frame times of SceneForge's 3D view on software GL, compared with SVG and instanced cubes.

``python -m benchmarks.check_forge_view [--pictures FOLDER] [--scenes demo room house building]
[--json FILE]``

Requires Node (the page is built for it), Playwright and Chromium. ``demo`` is the demo room in
the whole editor, with the committed bundle. The other scenes are generated and drawn alone:
furnished rooms with 3 % of the cells missing and a crust of wrong ones, as in a raw
reconstruction. ``first`` is the time from the start of the navigation to the first frame, in a
running browser, ``whole`` until everything is drawn at full detail. ``moving`` and ``inside`` are
median frame times while the camera orbits, from outside and inside a room; ``scale`` is the share
of the screen's pixels along a side that they had, which decreases on slow machines. Rivals: an
SVG square per voxel, as D3 draws them, and an instanced cube per voxel.
"""

import argparse
import gzip
import json
import os
import shutil
import statistics
import struct
import subprocess
import tempfile
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from rich.console import Console
from rich.table import Table

from world2minecraft.core.classes import CLASS_COLOURS, CLASS_NAMES

WEB = Path(__file__).parents[1] / "src/world2minecraft/sceneforge/web"
CHROMIUM = shutil.which("chromium") or "/usr/bin/chromium"
FLAGS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
)
VOXEL_M = 0.08
ROOM = (60, 60, 36)  # 4.8 m square and 2.9 m high
# Rooms along x and y, and the rooms' size in cells; occupied cells are 36k, 420k and 3.9M.
SCREEN: Any = {"width": 1280, "height": 720}
SCENES = {"room": (1, 1), "house": (4, 3), "building": (11, 10)}
FURNITURE = (  # class, low corner and size in cells, within a room
    (6, (6, 6, 1), (26, 22, 6)),
    (10, (48, 6, 1), (7, 24, 26)),
    (8, (26, 34, 8), (18, 11, 1)),
    (8, (27, 35, 1), (1, 1, 7)),
    (8, (42, 35, 1), (1, 1, 7)),
    (8, (27, 43, 1), (1, 1, 7)),
    (8, (42, 43, 1), (1, 1, 7)),
    (5, (20, 36, 1), (5, 5, 6)),
    (5, (20, 36, 7), (1, 5, 5)),
    (5, (46, 38, 1), (5, 5, 6)),
    (5, (50, 38, 7), (1, 5, 5)),
    (7, (8, 48, 1), (24, 9, 5)),
    (7, (8, 55, 6), (24, 2, 5)),
    (9, (3, 32, 10), (1, 14, 8)),
    (11, (32, 38, 9), (3, 3, 3)),
    (11, (52, 50, 1), (4, 4, 12)),
)


def scene_of(rooms: tuple[int, int], seed: int = 1) -> np.ndarray:
    """Return rooms side by side, uint8 [X, Y, Z] of class ids."""
    rng = np.random.default_rng(seed)
    labels = np.zeros((ROOM[0] * rooms[0], ROOM[1] * rooms[1], ROOM[2]), np.uint8)
    for x in range(rooms[0]):
        for y in range(rooms[1]):
            place = np.s_[ROOM[0] * x : ROOM[0] * (x + 1), ROOM[1] * y : ROOM[1] * (y + 1)]
            _furnish(labels[place])
    _wear(labels, rng)
    return labels


def _furnish(room: np.ndarray) -> None:
    thick = 3
    room[:thick], room[-thick:], room[:, :thick], room[:, -thick:] = 3, 3, 3, 3
    room[:thick, 18:30, 12:26] = 4
    room[24:36, :thick, 1:27] = 0
    room[-thick:, 24:34, 1:27] = 0
    room[:, :, 0], room[:, :, -1] = 2, 1
    for class_id, low, size in FURNITURE:
        room[tuple(slice(a, a + side) for a, side in zip(low, size, strict=True))] = class_id


def _wear(labels: np.ndarray, rng: np.random.Generator) -> None:
    solid = labels > 0
    near = np.zeros_like(labels)
    for axis in range(3):
        for step in (1, -1):
            near = np.maximum(near, np.roll(labels, step, axis))
    crust = ~solid & (near > 0) & (rng.random(labels.shape) < 0.06)
    labels[solid & (rng.random(labels.shape) < 0.03)] = 0
    labels[crust] = near[crust]


def scene_json(labels: np.ndarray) -> dict[str, Any]:
    """Return what /api/scene would say of labels [X, Y, Z]."""
    colours = zip(CLASS_NAMES, CLASS_COLOURS, strict=True)
    return {
        "protocol": 1,
        "name": "bench",
        "rev": 0,
        "saved_rev": 0,
        "read_only": "",
        "voxel_m": VOXEL_M,
        "origin_m": [0.0, 0.0, 0.0],
        "shape": list(labels.shape),
        "classes": [{"id": i, "name": n, "colour": c} for i, (n, c) in enumerate(colours)],
        "counts": np.bincount(labels.ravel(), minlength=12)[:12].tolist(),
        "objects": [],
        "undo": "",
        "redo": "",
        "is_demo": False,
        "has": {"photos": 0, "truth": False},
    }


def block_of(labels: np.ndarray) -> bytes:
    """Return the W2MV block of labels [X, Y, Z]."""
    head = struct.pack("<4sHBB3If3fI", b"W2MV", 1, 0, 0, *labels.shape, VOXEL_M, 0, 0, 0, 12)
    return head + labels.tobytes()


class Handler(SimpleHTTPRequestHandler):
    """Serves the built page and one scene."""

    answers: ClassVar[dict[str, tuple[str, bytes]]] = {}

    def do_GET(self) -> None:
        """Answer a page's request."""
        path = self.path.split("?")[0]
        if path not in self.answers:
            super().do_GET()
            return
        kind, body = self.answers[path]
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Encoding", "gzip")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *args: Any) -> None:
        """Say nothing."""


def serve(page: Path, labels: np.ndarray) -> ThreadingHTTPServer:
    """Start to serve a built page with a scene; the caller shuts it down."""
    made = {
        "/api/scene": ("application/json", json.dumps(scene_json(labels)).encode()),
        "/api/volume": ("application/octet-stream", block_of(labels)),
    }
    answers = {path: (kind, gzip.compress(body, 1)) for path, (kind, body) in made.items()}
    handler = type("SceneHandler", (Handler,), {"answers": answers})
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(handler, directory=str(page)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server


def build(page: Path) -> None:
    """Build the page that draws one scene."""
    command = ["npx", "vite", "build", "--config", "bench/vite.config.ts", "--outDir", str(page)]
    subprocess.run(command, cwd=WEB, check=True, capture_output=True)


# A mark is set when a frame is queued; the read-back waits until it is there.
WATCH = """window.__seen = {};
const watch = setInterval(() => {
  for (const name of ['first', 'whole']) {
    if (__seen[name] || !performance.getEntriesByName('scene-' + name).length) continue;
    const gl = document.querySelector('canvas')?.getContext('webgl2');
    gl?.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    __seen[name] = performance.now();
    if (name === 'whole') clearInterval(watch);
  }
}, 4);"""

# Frames end with a read-back: without it the time of queueing would be told.
ORBIT = """async ([inside, frames]) => {
  const {view, store} = window.__forge;
  const {shape, voxel_m} = store.get().scene;
  await view.idle();
  const before = view.orbit;
  if (inside) view.orbit = {...before, target: [2.4, 2.4, 1.3], distance: 1.6, elevation: 0.25};
  const gl = view.renderer.getContext();
  const times = [];
  for (let i = 0; i < frames; i++) {
    const start = performance.now();
    const drawn = new Promise((resolve) => view.onFrame.push(function call() {
      view.onFrame.splice(view.onFrame.indexOf(call), 1);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
      times.push(performance.now() - start);
      resolve();
    }));
    view.orbit = {...view.orbit, azimuth: view.orbit.azimuth + 0.05};
    await drawn;
  }
  window.__scale = view.stats().drawn.scale;
  view.orbit = before;
  await view.idle();
  return times;
}"""


def measure(page: Any, url: str, picture: Path | None) -> dict[str, float]:
    """Return seconds to the first frame and milliseconds of later ones."""
    page.add_init_script(WATCH)
    page.goto(url)
    page.wait_for_function("() => window.__seen?.whole", timeout=60_000)
    seen = page.evaluate("window.__seen")
    found = {name: seen[name] / 1000 for name in ("first", "whole")}
    if "each=" in url:
        turn = """async () => { const times = []; for (let i = 0; i < 4; i++) {
          const start = performance.now(); window.__forge.turn();
          await new Promise(requestAnimationFrame);
          times.push(performance.now() - start); } return times; }"""
        return found | {"moving": statistics.median(page.evaluate(turn))}
    for name, inside in (("moving", False), ("inside", True)):
        found[name] = statistics.median(page.evaluate(ORBIT, [inside, 20]))
    scale = page.evaluate("window.__scale")
    page.evaluate("() => window.__forge.idle()")
    if picture:
        page.screenshot(path=picture)
    found["scale"] = scale
    found["quads"] = page.evaluate("window.__forge.view.stats().quads")
    found["mb"] = page.evaluate("window.__forge.view.stats().bytes") / 1e6
    return found


def wake(browser: Any) -> None:
    """Draw something: the start of the browser's own graphics is not the page's time."""
    page = browser.new_page(viewport=SCREEN)
    page.set_content("<h1>A page</h1><p>with <b>words</b> <button>and</button> <input value=more>")
    page.evaluate("""() => { const gl = document.createElement('canvas').getContext('webgl2');
      gl.clear(gl.COLOR_BUFFER_BIT);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); }""")
    page.screenshot()  # Waits until the page has been drawn.
    page.close()


def demo_rows(browser: Any, pictures: Path | None) -> Iterator[dict[str, Any]]:
    """Yield the figures of the demo room in the whole editor: a browser's first page, and a later.

    Software GL compiles what it draws shadows, icons and letters with for the first page that has
    any: half a second, which no later page of that browser waits for.
    """
    from world2minecraft.sceneforge.editor import Editor
    from world2minecraft.sceneforge.scene_sources import demo_room
    from world2minecraft.sceneforge.server.server_process import ForgeServer

    with tempfile.TemporaryDirectory() as folder:
        editor = Editor(demo_room(Path(folder)))
        cells = int((editor.draft.labels > 0).sum())
        with ForgeServer(editor) as server:
            for name in ("demo, first page", "demo"):
                page = browser.new_context(bypass_csp=True, viewport=SCREEN).new_page()
                picture = pictures / "demo.png" if pictures else None
                found = measure(page, server.link, picture)
                yield {"scene": name, "by": "SceneForge", "cells": cells, **found}
                page.context.close()
        editor.close()


def main() -> None:
    """Print the table."""
    from playwright.sync_api import sync_playwright

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--scenes", nargs="+", choices=("demo", *SCENES), default=["demo", *SCENES])
    parser.add_argument("--alone", action="store_true", help="without the drawings a voxel")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    options = parser.parse_args()
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as play:
        build(Path(folder))
        browser = play.chromium.launch(executable_path=CHROMIUM, args=list(FLAGS))
        wake(browser)
        for name in options.scenes:
            if name == "demo":
                rows += demo_rows(browser, options.pictures)
                continue
            labels = scene_of(SCENES[name])
            server = serve(Path(folder), labels)
            url = f"http://127.0.0.1:{server.server_port}/index.html"
            each = [] if options.alone or name == "building" else ["cubes"]
            each += ["svg"] if each and name == "room" else []
            for how in ("", *each):
                page = browser.new_page(viewport=SCREEN)
                picture = options.pictures / f"{name}.png" if options.pictures else None
                found = measure(page, url + (f"?each={how}" if how else ""), picture)
                cells = int((labels > 0).sum())
                rows.append({"scene": name, "by": how or "SceneForge", "cells": cells, **found})
                page.close()
            server.shutdown()
        browser.close()
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n")
    Console(width=120).print(table_of(rows))
    Console().print(f"load of the machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")


def table_of(rows: list[dict[str, Any]]) -> Table:
    """Return the figures as a table."""
    columns = ("scene", "drawn by", "cells", "first s", "whole s", "moving ms", "inside ms")
    table = Table(*columns, "scale", "quads", "MB")
    for row in rows:
        table.add_row(row["scene"], row["by"], f"{row['cells']:,}", *_told(row))
    return table


def _told(found: dict[str, Any]) -> list[str]:
    digits = {"first": 2, "whole": 2, "moving": 0, "inside": 0, "scale": 2, "quads": 0, "mb": 1}
    return [f"{found[key]:,.{n}f}" if key in found else "" for key, n in digits.items()]


if __name__ == "__main__":
    main()
