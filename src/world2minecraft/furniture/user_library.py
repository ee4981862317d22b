"""The user's own furniture, block by block, with one file per piece in a user folder.

A file contains the original blocks with their scale, and the boxes that they form. ``user_import``
creates such files. At its own scale the piece consists of exactly these blocks. At other scales its
boxes are fitted like those of any template. The folder may also contain design files of a family.
"""

import math
import os
import re
import sys
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES
from world2minecraft.core.errors import DamagedFileError, UsageError
from world2minecraft.core.file_names import is_reserved
from world2minecraft.core.files import read_json
from world2minecraft.furniture.design_files import MOUNTS, design_from_json
from world2minecraft.furniture.materials import FIXED, Material, block_uses, kinds
from world2minecraft.furniture.template import BlockSize, LocalBlock, Part, Span, Template
from world2minecraft.furniture.template_parameters import Look

NAME = re.compile(r"[a-z][a-z0-9_]{0,39}")
MAX_BYTES = 4 << 20
MAX_SIDE, MAX_BLOCKS, MAX_KINDS, MAX_PARTS = 32, 8192, 256, 512
PARTS_PER_BLOCK = 8
NEAR_SCALE = 1.26  # Up to this factor off its scale a piece keeps its blocks: a third of an octave.


def user_design_folder(
    environment: Mapping[str, str] = os.environ, platform: str = sys.platform
) -> Path:
    """Return the folder of the user's furniture, which may not exist.

    It is ``W2M_FURNITURE`` if this variable is set, else ``world2minecraft/furniture`` in the
    settings folder.
    """
    if environment.get("W2M_FURNITURE"):
        return Path(environment["W2M_FURNITURE"])
    home = Path.home()
    usual = home / ".config" if platform != "win32" else home / "AppData" / "Roaming"
    key = "APPDATA" if platform == "win32" else "XDG_CONFIG_HOME"
    return Path(environment.get(key) or usual) / "world2minecraft" / "furniture"


def user_design_files() -> dict[str, Path]:
    """Return the user's furniture files by name, sorted. Files with other names are ignored."""
    folder = user_design_folder()
    if not folder.is_dir():
        return {}
    found = {path.stem: path for path in sorted(folder.glob("*.json"))}
    return {name: path for name, path in found.items() if NAME.fullmatch(name)}


def check_name(name: str) -> str:
    """Check the name of a piece of furniture, and return it.

    Raises:
        UsageError: If the name is invalid.
    """
    if is_reserved(name):
        raise UsageError(
            f"Windows reserves the name {name!r}; choose another one (--name my_chair)"
        )
    if not NAME.fullmatch(name):
        raise UsageError(
            "a furniture name must start with a letter and have up to 40 characters of a-z, 0-9 "
            f"and _, got {name[:60]!r}; add --name my_chair"
        )
    return name


def read_user_design(path: Path) -> Template:
    """Read the template in a user furniture file.

    Raises:
        InputError: If the file cannot be read.
        DamagedFileError: If the contents are invalid.
        LimitError: If the file is too large.
    """
    raw = read_json(path, MAX_BYTES)
    try:
        found = (
            template_from_json(raw)
            if isinstance(raw, dict) and "blocks" in raw
            else design_from_json(raw)
        )
        if found.name != path.stem:
            raise ValueError(f"the template name must match the file name, got {found.name!r}")
    except (ValueError, UsageError) as error:
        hint = "add it again with w2m furniture add, or remove the file"
        raise DamagedFileError(path, f"{error}; {hint}") from error
    return found


def template_from_json(raw: Mapping[str, Any]) -> Template:
    """Return the template for the contents of a user furniture file.

    Raises:
        ValueError: If a key is missing or invalid. The message names the key and the valid values.
    """
    kind = _text(raw, "class")
    if kind not in CLASS_NAMES or CLASS_NAMES.index(kind) not in OBJECT_CLASSES:
        raise ValueError(f"class must be an object class, got {kind!r}")
    sizes = _mapping(raw, "size_m")
    scale = _number("blocks_per_metre", raw.get("blocks_per_metre"), 0.1, 64.0)
    blocks = _blocks(_mapping(raw, "blocks"))
    parts = _parts(raw.get("parts"), blocks)
    recoloured = _one_of(raw, "colour", ("own", "object")) == "object"

    def build(depth: float, width: float, height: float, look: Look) -> list[Part]:
        size = np.array([depth, width, height] * 2)
        shift = np.array([depth / 2, width / 2, 0.0] * 2)
        return [Part(box * size - shift, role) for box, role in parts]

    def design(size: BlockSize, look: Look) -> list[LocalBlock]:
        off = size.per_metre / scale
        return list(blocks) if 1 / NEAR_SCALE <= off <= NEAR_SCALE else []

    return Template(
        name=check_name(_text(raw, "name")),
        title=_text(raw, "title"),
        class_id=CLASS_NAMES.index(kind),
        family=_text(raw, "name"),
        size_m=(_span(sizes, "depth"), _span(sizes, "width"), _span(sizes, "height")),
        build=build,
        design=design,
        materials={block.role: material_of(block.role, recoloured) for block in blocks},
        turns=_one_of(raw, "turns", (1, 2, 4)),
        mount=_one_of(raw, "mount", MOUNTS),
        matched=_one_of(raw, "match", (True, False)),
    )


@lru_cache(maxsize=4096)
def material_of(role: str, recoloured: bool) -> Material:
    """Return the material of a role of user furniture, where the role is a block name.

    A block of a known kind can be recoloured within its kind if ``recoloured`` is True. Any other
    block is fixed, and rendered as the full block with the most similar colour.
    """
    places = [place for place in block_uses(f"minecraft:{role}") if place.shape != "bed"]
    if places and recoloured:
        return Material(places[0].kind, places[0].value, True)
    if places and "full" in kinds()[places[0].kind].blocks[places[0].value]:
        full = kinds()[places[0].kind].blocks[places[0].value]["full"]
        return Material(FIXED, full.removeprefix("minecraft:"))
    return Material(FIXED, _full_block_like(f"minecraft:{role}"))


def _full_block_like(block: str) -> str:
    from world2minecraft.minecraft.block_colours import colour_of, nearest_block  # noqa: PLC0415
    from world2minecraft.minecraft.block_states import known_blocks  # noqa: PLC0415
    from world2minecraft.minecraft.collision_shapes import is_full_cube  # noqa: PLC0415

    if block in known_blocks() and is_full_cube(block):
        return block.removeprefix("minecraft:")
    offered = sorted(
        shapes["full"]
        for name in ("paint", "wood", "stone")
        for shapes in kinds()[name].blocks.values()
    )
    rgb = np.array([colour_of(block)], np.uint8)
    return offered[int(nearest_block(rgb, offered)[0])].removeprefix("minecraft:")


def _blocks(raw: Mapping[str, Any]) -> tuple[LocalBlock, ...]:
    size = tuple(_whole("size", one, 1, MAX_SIDE) for one in _list("size", raw.get("size"), 3, 3))
    count = math.prod(size)
    if count > MAX_BLOCKS:
        raise ValueError(f"size must have at most {MAX_BLOCKS:,} blocks in total, got {count:,}")
    palette = [_state(one) for one in _list("palette", raw.get("palette"), 1, MAX_KINDS)]
    numbers: list[int] = []
    for run in _list("runs", raw.get("runs"), 1, count):
        number, length = _list("a run", run, 2, 2)
        length = _whole("run length", length, 1, count - len(numbers))
        numbers += [_whole("run state index", number, 0, len(palette))] * length
    if len(numbers) != count or not any(numbers):
        raise ValueError(
            f"runs must contain {count} blocks, at least one of them not air, got {len(numbers)}"
        )
    cells = np.array(numbers).reshape(size)
    found = [
        (tuple(map(int, cell)), palette[cells[tuple(cell)] - 1]) for cell in np.argwhere(cells)
    ]
    return tuple(LocalBlock(cell, state, role_of(state)) for cell, state in found)  # pyright: ignore


def role_of(state: str) -> str:
    """Return the role of a block: its name without namespace and properties."""
    return state.partition("[")[0].rpartition(":")[2]


def _parts(raw: Any, blocks: tuple[LocalBlock, ...]) -> tuple[tuple[np.ndarray, str], ...]:
    """Return boxes as shares of the piece's own box, float64 [6], and their roles."""
    roles = {block.role for block in blocks}
    found = []
    for one in _list("parts", raw, 1, MAX_PARTS):
        role, *corners = _list("a part", one, 7, 7)
        if role not in roles:
            raise ValueError(f"the block of a part must be a block of the piece, got {role!r}")
        box = np.array([_whole("a corner", value, 0, MAX_SIDE * 16) for value in corners], float)
        if (box[3:] <= box[:3]).any():
            raise ValueError(f"a part must have a positive volume, got {corners}")
        found.append((box, role))
    boxes = np.array([box for box, _ in found])
    low, high = boxes[:, :3].min(axis=0), boxes[:, 3:].max(axis=0)
    spread = np.tile(high - low, 2)
    return tuple(((box - np.tile(low, 2)) / spread, role) for box, role in found)


def _state(value: Any) -> str:
    from world2minecraft.minecraft.block_states import parse_state  # noqa: PLC0415

    if not isinstance(value, str):
        raise ValueError(f"a block state must be a string, got {value!r:.60}")
    return str(parse_state(value))


def _text(raw: Mapping[str, Any], key: str) -> str:
    value = raw.get(key)
    if not isinstance(value, str) or not 0 < len(value) <= 200:
        raise ValueError(f"{key} must be a string of 1 to 200 characters, got {value!r:.60}")
    return value


def _mapping(raw: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    value = raw.get(key)
    if not isinstance(value, dict):
        raise ValueError(f"{key} must be a JSON object, got {value!r:.60}")
    return value


def _list(key: str, value: Any, least: int, most: int) -> list:
    if not isinstance(value, list) or not least <= len(value) <= most:
        raise ValueError(f"{key} must be a list of {least} to {most} items, got {value!r:.60}")
    return value


def _whole(key: str, value: Any, least: int, most: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise ValueError(f"{key} must be an integer from {least} to {most}, got {value!r:.60}")
    return value


def _number(key: str, value: Any, least: float, most: float) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not least <= value <= most:
        raise ValueError(f"{key} must be a number from {least:g} to {most:g}, got {value!r:.60}")
    return float(value)


def _span(sizes: Mapping[str, Any], key: str) -> Span:
    return Span(*(_number(key, one, 0.01, 64.0) for one in _list(key, sizes.get(key), 3, 3)))


def _one_of(raw: Mapping[str, Any], key: str, choices: tuple) -> Any:
    value = raw.get(key)
    if not any(value == one and type(value) is type(one) for one in choices):
        raise ValueError(f"{key} must be one of {', '.join(map(str, choices))}, got {value!r:.60}")
    return value
