"""A resource pack: opening a zip as large as a client jar and reading 200 block states from it.

The pack is generated from noise: 1,500 blocks of four boxes each, one of them rotated freely,
with a parent and a grandparent, each in four directions with locked textures.
"""

import io
import json
import tempfile
import time
import zipfile
from pathlib import Path

import numpy as np
from PIL import Image

from benchmarks.rows import Row
from world2minecraft.minecraft.block_table import block_table
from world2minecraft.rendering.resource_packs import ResourcePackModels

BLOCKS, OTHER_FILES, STATES, REPEATS = 1500, 20_000, 200, 4
FACINGS = ("north", "east", "south", "west")
SIDES = ("down", "up", "north", "south", "west", "east")


def run() -> list[Row]:
    """Measure CPU time, the best of a few runs."""
    block_table()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "pack.jar"
        path.write_bytes(made_up_pack())
        times = np.array([_times(path) for _ in range(REPEATS)]).min(axis=0)
    return [
        Row(f"open a jar of {3 * BLOCKS + OTHER_FILES + 2:,} files", times[0], "s", 0.5),
        Row(f"models and textures of {STATES} block states", times[1], "s", 1.5),
    ]


def _times(path: Path) -> tuple[float, float]:
    start = time.process_time()
    looks = ResourcePackModels([path])
    opened = time.process_time()
    for index in range(STATES):
        model = looks.model(f"minecraft:block_{index}[facing={FACINGS[index % 4]}]")
        if model is None:
            raise RuntimeError(looks.problems[0])
        for face in (face for one in model.elements for face in one.faces if face):
            looks.texture(face.texture)
    return opened - start, time.process_time() - opened


def made_up_pack() -> bytes:
    """Return the zip of the pack."""
    random, stream = np.random.default_rng(0), io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, value in _objects().items():
            archive.writestr(f"assets/minecraft/{name}.json", json.dumps(value))
        for index in range(BLOCKS):
            picture = io.BytesIO()
            pixels = random.integers(0, 256, (16, 16, 4)).astype(np.uint8)
            Image.fromarray(pixels).save(picture, "PNG")
            archive.writestr(f"assets/minecraft/textures/block/t{index}.png", picture.getvalue())
        for index in range(OTHER_FILES):
            archive.writestr(f"net/minecraft/{index}.class", bytes(100))
    return stream.getvalue()


def _objects() -> dict[str, dict]:
    faces = {side: {"texture": f"#{side}", "cullface": side} for side in SIDES}
    boxes = [([0, 0, 0], [16, 8, 16]), ([8, 8, 0], [16, 16, 16])] + [([1, 8, 1], [3, 16, 3])] * 2
    elements = [{"from": low, "to": high, "faces": faces} for low, high in boxes]
    elements[-1] |= {"rotation": {"origin": [8, 8, 8], "axis": "y", "angle": 45}}
    objects: dict[str, dict] = {"models/block/grandparent": {"elements": elements}}
    objects["models/block/parent"] = {
        "parent": "block/grandparent",
        "textures": dict.fromkeys(SIDES, "#all"),
    }
    for index in range(BLOCKS):
        textures = {"all": f"block/t{index}", "up": f"block/t{index * 7 % BLOCKS}"}
        objects[f"models/block/m{index}"] = {"parent": "block/parent", "textures": textures}
        objects[f"blockstates/block_{index}"] = {
            "variants": {
                f"facing={facing}": {"model": f"block/m{index}", "y": 90 * turn, "uvlock": True}
                for turn, facing in enumerate(FACINGS)
            }
        }
    return objects
