"""Small packs made up for tests: JSON values and pictures into a folder or a zip."""

import io
import json
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

BLOCK = "assets/minecraft/blockstates/{}.json"
MODEL = "assets/minecraft/models/block/{}.json"
PICTURE = "assets/minecraft/textures/block/{}.png"
CUBE = {
    "elements": [
        {
            "from": [0, 0, 0],
            "to": [16, 16, 16],
            "faces": {
                side: {"texture": "#all", "cullface": side}
                for side in ("down", "up", "north", "south", "west", "east")
            },
        }
    ]
}


def png(pixels: np.ndarray) -> bytes:
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, "PNG")
    return stream.getvalue()


def plain(red: int, green: int, blue: int, alpha: int = 255, side: int = 16) -> np.ndarray:
    return np.full((side, side, 4), (red, green, blue, alpha), np.uint8)


def content(value: Any) -> bytes:
    """The bytes of a pack's file: of a picture, of JSON, or as they are."""
    if isinstance(value, np.ndarray):
        return png(value)
    return value if isinstance(value, bytes) else json.dumps(value).encode()


def folder_pack(folder: Path, files: Mapping[str, Any]) -> Path:
    for name, value in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content(value))
    return folder


def zip_pack(path: Path, files: Mapping[str, Any]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, value in files.items():
            archive.writestr(name, content(value))
    return path


def block_files(block: str, state: Any, model: Any = None, **pictures: np.ndarray) -> dict:
    """A block's blockstates file, its model of the same name and some textures."""
    files = {BLOCK.format(block): state}
    if model is not None:
        files[MODEL.format(block)] = model
    return files | {PICTURE.format(name): pixels for name, pixels in pictures.items()}


def one_model(block: str, **turn: Any) -> dict:
    return {"variants": {"": {"model": f"minecraft:block/{block}", **turn}}}


def cube_files(block: str, pixels: np.ndarray, **turn: Any) -> dict:
    """A block that is a cube with one texture, with a model of its own."""
    model = {**CUBE, "textures": {"all": f"minecraft:block/{block}"}}
    return block_files(block, one_model(block, **turn), model, **{block: pixels})


def look_up(texture: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """The texels, uint8 [N, 4], of texture points, float64 [N, 2]."""
    side = texture.shape[0]
    column, row = (np.clip(np.floor(uv * side), 0, side - 1).astype(int)).T
    return texture[row, column]
