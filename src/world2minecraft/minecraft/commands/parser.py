"""Reading of command lists and of data packs written by this program.

Supported commands are ``setblock``, ``fill``, ``data merge block`` and ``summon`` with absolute
coordinates or coordinates after ``~``, which are taken relative to the world origin. Other commands
are counted as losses.
"""

import io
import re
import zipfile
from array import array
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UsageError
from world2minecraft.core.files import UNREADABLE, read_bytes
from world2minecraft.core.types import AIR, BlockEntity, BlockVolume, Entity
from world2minecraft.minecraft.block_renames import read_state
from world2minecraft.minecraft.block_states import parse_state
from world2minecraft.minecraft.commands.snbt import SnbtReader
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.signs import upgrade_command_signs
from world2minecraft.minecraft.unlabelled_volume import (
    MAX_CELLS,
    build_palette,
    check_size,
    unlabelled_volume,
)

# Commands that load chunks, order the parts of a pack, or clear the place of its entities.
ORDERING = ("forceload ", "schedule ", "kill @e[tag=w2m_")
MAX_BYTES = 64 << 20  # Two million commands of this program take about as much.
MAX_LINES = 4_000_000
ANY_VERSION = 1 << 30  # A list does not state its game version; newer names are unambiguous.
MAX_DATA = 50_000  # Entities, and blocks with data.
MAX_FILLED = 4 * MAX_CELLS  # Of all commands together: setting blocks again and again takes time.
Place = tuple[int, int, int]
_PART = re.compile(r"data/[^/]+/functions?/build/part_(\d+)\.mcfunction")
_WHOLE = re.compile(r"~?(-?\d{1,8})|~")
_NUMBER = re.compile(r"~?(-?\d{1,8}(?:\.\d{1,20})?)|~")
_ID = re.compile(r"[a-z0-9_.-]+:[a-z0-9_./-]+")
_OWN_TAG = re.compile(r"w2m_-?\d+_-?\d+_-?\d+")
# Block entities that are not named like their block, by the end of the block's name.
_DATA_OF = {
    "_hanging_sign": "hanging_sign",
    "_sign": "sign",
    "_banner": "banner",
    "_bed": "bed",
    "_shulker_box": "shulker_box",
    "_skull": "skull",
    "_head": "skull",
    "_campfire": "campfire",
    "_command_block": "command_block",
}


def read_command_list(path: str | Path, losses: Losses | None = None) -> BlockVolume:
    """Read a command list as the volume that its commands build.

    Raises:
        InputError: If the file is not found, or no command sets a block.
        DamagedFileError: If a command is invalid.
        LimitError: If there are too many commands, or the commands set too large a box.
    """
    data = read_bytes(path, MAX_BYTES)
    return _build(_lines(data, path), Path(path), Losses() if losses is None else losses)


def read_datapack(path: str | Path, losses: Losses | None = None) -> BlockVolume:
    """Read the volume that the function ``build`` of a data pack of this program builds.

    Raises:
        InputError: If the file is not found or is not a data pack of this program.
        DamagedFileError: If the archive cannot be read or a command is invalid.
        LimitError: If there are too many commands, or the commands set too large a box.
    """
    source = Path(path)
    if not source.is_file():
        raise InputError(source, "not found")
    try:
        with zipfile.ZipFile(source) as archive:
            parts = _parts(archive)
            if sum(part.file_size for part in parts) > MAX_BYTES:
                raise LimitError(source, f"exceeds the limit of {MAX_BYTES:,} bytes of commands")
            texts = [archive.read(part) for part in parts]
            is_world = any(Path(name).name == "level.dat" for name in archive.namelist())
    except UNREADABLE as error:
        raise DamagedFileError(source, f"is not a valid data pack ({error})") from error
    if not texts and is_world:
        raise InputError(
            source, "contains a zipped world; extract it and use the folder with level.dat"
        )
    if not texts:
        raise InputError(
            source,
            "is not a data pack written by World2Minecraft (function build/part_0 is missing); "
            "other data packs are not supported",
        )
    lines = (line for text in texts for line in _lines(text, source))
    return _build(lines, source, Losses() if losses is None else losses)


@dataclass
class _BuildState:
    """The blocks, block data and entities that the commands have built so far."""

    path: Path
    losses: Losses
    boxes: array = field(default_factory=lambda: array("i"))  # x0 y0 z0 x1 y1 z1 state, ...
    states: dict[str, int] = field(default_factory=lambda: {AIR: 0})
    data: dict[Place, dict[str, Any]] = field(default_factory=dict)
    entities: list[Entity] = field(default_factory=list)
    filled: int = 0
    reader: SnbtReader = field(default_factory=SnbtReader)

    def place(self, box: tuple[int, ...], text: str) -> None:
        """Fill a box with a block, and set the block's data if it has any."""
        name, brace, rest = text.partition("{")
        name = read_state(str(parse_state(name)), ANY_VERSION)
        number = self.states.setdefault(name, len(self.states))
        low = tuple(min(a, b) for a, b in zip(box[:3], box[3:], strict=True))
        high = tuple(max(a, b) for a, b in zip(box[:3], box[3:], strict=True))
        sides = (b + 1 - a for a, b in zip(low, high, strict=True))
        self.filled += prod(sides)
        if self.filled > MAX_FILLED:
            raise LimitError(self.path, f"exceeds the limit of {MAX_FILLED:,} filled blocks")
        self.boxes.extend((*low, *high, number))
        if brace:
            self.merge((low[0], low[1], low[2]), f"{{{rest}")

    def merge(self, place: Place, text: str) -> None:
        """Add data to a block."""
        self.data[place] = self.data.get(place, {}) | self.compound(text)

    def compound(self, text: str) -> dict[str, Any]:
        """Parse the data of a block or an entity."""
        value, _ = self.reader.read(text)
        if not isinstance(value, dict):
            raise UsageError(f"data {text[:40]!r} must have the form {{name:value}}")
        if len(self.data) + len(self.entities) >= MAX_DATA:
            raise LimitError(
                self.path, f"exceeds the limit of {MAX_DATA:,} blocks and entities with data"
            )
        return value


def _build(lines: Iterable[str], path: Path, losses: Losses) -> BlockVolume:
    site = _BuildState(path, losses)
    for line in lines:
        try:
            _run_command(site, line)
        except UsageError as error:
            raise DamagedFileError(path, f"contains an invalid command: {error}") from error
    if not site.boxes:
        raise InputError(path, "contains no setblock or fill command, so there is nothing to read")
    boxes = np.frombuffer(site.boxes, np.int32).reshape(-1, 7).astype(np.int64)
    low = boxes[:, :3].min(axis=0)
    shape = check_size(boxes[:, 3:6].max(axis=0) + 1 - low, path)
    palette, number_of = build_palette(site.states, path)
    ours = [number_of[state] for state in site.states]
    states = np.zeros(shape, np.uint16)
    boxes[:, :3], boxes[:, 3:6] = boxes[:, :3] - low, boxes[:, 3:6] - low
    for row in boxes:
        x0, y0, z0, x1, y1, z1, state = row.tolist()
        states[x0 : x1 + 1, y0 : y1 + 1, z0 : z1 + 1] = ours[state]
    x, y, z = low.tolist()
    blocks = upgrade_command_signs(_block_entities(site, states, palette, (x, y, z)))
    return unlabelled_volume(states, palette, (x, y, z), blocks, site.entities)


def _run_command(site: _BuildState, line: str) -> None:
    words = line.split(" ", 1)
    rest = words[1].strip() if len(words) > 1 else ""
    if words[0] == "setblock":
        *place, state = _arguments(rest, 3)
        state = _without_mode(state, site.losses)
        if state:
            at = _whole(place)
            site.place((*at, *at), state)
    elif words[0] == "fill":
        *corners, state = _arguments(rest, 6)
        state = _without_mode(state, site.losses)
        if state:
            site.place(_whole(corners), state)
    elif words[0] == "data" and rest.startswith("merge block "):
        *place, data = _arguments(rest.removeprefix("merge block "), 3)
        x, y, z = _whole(place)
        site.merge((x, y, z), data)
    elif words[0] == "summon":
        _summon(site, rest)
    elif not line.startswith(ORDERING):
        site.losses.add(f"unsupported commands ({words[0][:20]})")


def _arguments(rest: str, count: int) -> list[str]:
    """Return ``count`` words and the rest of the text."""
    words = rest.split(" ", count)
    if len(words) <= count:
        raise UsageError(f"command {rest[:60]!r} must have {count} coordinates and a value")
    return words


def _whole(words: Iterable[str]) -> tuple[int, ...]:
    found = [_WHOLE.fullmatch(word) for word in words]
    if not all(found):
        raise UsageError(f"coordinates must be integers, got {' '.join(words)[:60]!r}")
    return tuple(int(match[1] or 0) for match in found if match)


def _without_mode(state: str, losses: Losses) -> str:
    """Return a block without the mode after it, or an empty string for an unsupported mode."""
    end = state.rfind("}") if "{" in state else state.rfind("]")
    head, _, mode = state[end + 1 :].partition(" ")
    mode = mode.strip()
    if mode in ("", "replace", "destroy", "strict"):
        return state[: end + 1] + head
    losses.add(f"fill and setblock commands with the mode {mode.split(' ')[0][:20]}")
    return ""


def _summon(site: _BuildState, rest: str) -> None:
    name, *place = rest.split(" ", 4)
    data = place.pop() if len(place) > 3 else "{}"
    full = name if ":" in name else f"minecraft:{name}"
    numbers = [_NUMBER.fullmatch(word) for word in place]
    if len(place) != 3 or not all(numbers) or not _ID.fullmatch(full):
        raise UsageError(
            f"summon {rest[:60]!r} must have the form: summon minecraft:cat 1.0 64.0 2.0"
        )
    x, y, z = (float(match[1] or 0) for match in numbers if match)
    nbt = site.compound(data)
    if isinstance(nbt.get("Tags"), list):
        nbt["Tags"] = [tag for tag in nbt["Tags"] if not _OWN_TAG.fullmatch(str(tag))]
        nbt = nbt if nbt["Tags"] else {key: nbt[key] for key in nbt if key != "Tags"}
    site.entities.append(Entity((x, y, z), full, nbt))


def _block_entities(
    site: _BuildState, states: np.ndarray, palette: tuple[str, ...], corner: Place
) -> Iterator[BlockEntity]:
    for place, nbt in sorted(site.data.items()):
        cell = tuple(a - b for a, b in zip(place, corner, strict=True))
        if not all(0 <= c < side for c, side in zip(cell, states.shape, strict=True)):
            site.losses.add("block data outside the blocks that the commands set")
            continue
        name = parse_state(palette[states[cell]]).name
        plain = name.partition(":")[2].replace("_wall_", "_")
        kind = next((held for end, held in _DATA_OF.items() if f"_{plain}".endswith(end)), None)
        yield BlockEntity(place, f"minecraft:{kind}" if kind else name, nbt)


def _lines(data: bytes, path: str | Path) -> Iterator[str]:
    """Yield the commands, without empty lines and comments."""
    for number, raw in enumerate(io.BytesIO(data)):
        if number >= MAX_LINES:
            raise LimitError(path, f"exceeds the limit of {MAX_LINES:,} lines")
        try:
            line = raw.decode("utf-8").strip().removeprefix("/")
        except UnicodeError as error:
            raise DamagedFileError(path, f"is not a UTF-8 text file ({error})") from error
        if line and not line.startswith("#"):
            yield line


def _parts(archive: zipfile.ZipFile) -> list[zipfile.ZipInfo]:
    """Return the parts of the function ``build`` in order, without duplicates."""
    found: dict[int, zipfile.ZipInfo] = {}
    for entry in archive.infolist():
        part = _PART.fullmatch(entry.filename)
        if part is not None and len(part[1]) <= 6:
            found.setdefault(int(part[1]), entry)
    return [found[number] for number in sorted(found)]
