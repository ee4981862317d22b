"""Palettes: the blocks a room may be built of, by name or from a JSON or YAML file.

A palette lists the full blocks allowed for surfaces of each class. A palette for a mod also lists
which of its blocks represent which furniture (``mod_furniture``) and what its blocks mean
(``mod_block_classes``). If a palette lists ``blocks``, the build is restricted to them
(``palette_restriction``). A file may extend another palette with ``extends``, so a user's file
needs only a name and the blocks. Every block is checked against the game's block table, except
blocks of other namespaces, which belong to mods. The format is described in
docs/how-to/palettes.md.
"""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from world2minecraft.construction.mod_block_classes import parse_meanings
from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES, STRUCTURE_CLASSES
from world2minecraft.core.errors import InputError, UnknownNameError, UsageError, one_line
from world2minecraft.core.files import load_plain_yaml, read_bytes
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.minecraft.block_colours import DYES, WOODS, colours_of, nearest_oklab
from world2minecraft.minecraft.block_states import BlockState, check_state, complete, parse_state
from world2minecraft.minecraft.collision_shapes import is_full_cube

if TYPE_CHECKING:
    from world2minecraft.construction.mod_block_classes import Meanings

FILLS = ("one", "row", "floor", "box")
# Where a block's facing looks, of a piece that looks east.
FACINGS = {"front": "east", "back": "west", "left": "north", "right": "south"}
LARGEST = 8  # Blocks a side of a piece made of several.
JOINS = ("sides", "flags", "shape")
PALETTE_FILES = {
    "vanilla": "palette_vanilla.json",
    "tmeo": "palette_tmeo.json",
    "refurbished_furniture": "palette_refurbished_furniture.json",
}
FILE_SUFFIXES = (".yaml", ".yml", ".json")
MAX_BYTES = 1 << 20
MAX_NAMES = 4096
KEYS = (
    "name", "about", "extends", "blocks", "groups", "classes", "prefers", "defaults", "slabs",
    "fences", "glass", "pane", "furniture", "reads",
)  # fmt: skip
PAINTED = (*STRUCTURE_CLASSES, *OBJECT_CLASSES)
# What does not stand by itself for good, by parts of names: it falls, melts, grows, weathers.
_PASSING = ("concrete_powder", "sand", "gravel", "ice", "coral", "leaves", "grass_block",
            "mycelium", "podzol", "nylium", "farmland", "dragon_egg", "anvil", "tnt", "sponge",
            "spawner", "command_block", "structure_block", "jigsaw", "_ore")  # fmt: skip
_LASTING = ("sandstone", "packed_ice", "blue_ice")
_WEATHERING = ("copper",)


class PieceBlock(NamedTuple):
    """One block of a furniture piece, with its offset front to back, sideways and up."""

    at: tuple[int, int, int]
    id: str
    properties: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class FurniturePiece:
    """Mod blocks that replace some furniture templates.

    Attributes:
        designs: Names of the replaced templates or families.
        cells: Blocks of the piece; ``{wood}`` and ``{dye}`` in their names take the object's
            colour.
        fill: ``one`` places the cells once; ``row`` repeats the single cell across the width,
            ``floor`` over the footprint and ``box`` over the whole volume.
        facing: Side to which the ``facing`` property points: ``front``, ``back``, ``left`` or
            ``right``; None if the blocks have no such property.
        joins: How pieces connect: ``sides`` (north, east, ... of tables), ``flags`` (left, right of
            desks) or ``shape`` (the shape of sofas); None if they do not connect.
    """

    designs: tuple[str, ...]
    cells: tuple[PieceBlock, ...]
    fill: str = "one"
    facing: Literal["front", "back", "left", "right"] | None = None
    joins: str | None = None


def parse_piece(raw: Any) -> FurniturePiece:
    """Parse a furniture entry of a palette file.

    Raises:
        ValueError: If the entry is invalid.
        UsageError: If a block id is invalid.
    """
    known = ("for", "id", "properties", "cells", "fill", "facing", "joins")
    if not isinstance(raw, dict) or not set(raw) <= set(known) or "for" not in raw:
        raise ValueError(
            "a furniture entry must contain the keys for and id, and optionally "
            f"{', '.join(known[2:])}"
        )
    designs = raw["for"]
    if not (isinstance(designs, list) and designs and all(isinstance(d, str) for d in designs)):
        raise ValueError(f"for must be a list of design or family names, got {designs!r}")
    for key, choices in (("fill", FILLS), ("facing", tuple(FACINGS)), ("joins", JOINS)):
        if key in raw and raw[key] not in choices:
            raise ValueError(f"{key} must be one of {', '.join(choices)}, got {raw[key]!r}")
    listed = raw.get("cells", [{"id": raw.get("id"), "properties": raw.get("properties", {})}])
    if not isinstance(listed, list) or not listed:
        raise ValueError(
            f"cells must be a list of blocks, such as [{{id: mod:oak_chair}}], got {_short(listed)}"
        )
    cells = tuple(_cell(one) for one in listed)
    if len(cells) > 1 and raw.get("fill", "one") != "one":
        raise ValueError("a furniture piece of several cells must have fill: one")
    return FurniturePiece(
        tuple(designs), cells, raw.get("fill", "one"), raw.get("facing"), raw.get("joins")
    )


def _cell(raw: Any) -> PieceBlock:
    if not isinstance(raw, dict) or not isinstance(raw.get("id"), str):
        raise ValueError(f"a furniture piece must have an id, such as mod:oak_chair, got {raw!r}")
    at = raw.get("at", [0, 0, 0])
    good = isinstance(at, list) and len(at) == 3 and all(type(v) is int for v in at)
    if not good or not all(0 <= v < LARGEST for v in at):
        raise ValueError(f"at must be three integers from 0 to {LARGEST - 1}, got {at!r}")
    properties = raw.get("properties", {})
    if not isinstance(properties, dict):
        raise ValueError(f"properties must be a mapping of names to values, got {properties!r}")
    texts = {str(key): str(value).lower() for key, value in properties.items()}
    for kind in (WOODS[0], DYES[0]):
        BlockState(raw["id"].replace("{wood}", kind).replace("{dye}", kind), texts)
    return PieceBlock((at[0], at[1], at[2]), raw["id"], tuple(sorted(texts.items())))


@dataclass(frozen=True)
class Palette:
    """The blocks allowed for each class, as complete block states.

    Attributes:
        name: Name of the palette.
        blocks: Allowed full blocks by class number.
        preferred: Blocks by class number that win over others of similar colour, such as wood for
            tables.
        defaults: Block by class number for surfaces without a known colour.
        slabs: Slab of each full block.
        fences: Fence of each full block.
        glass: Block of windows.
        pane: Pane of windows.
        only: Names of all allowed blocks; None allows every block.
        furniture: Furniture pieces of a mod.
        meanings: Meanings of the mod's blocks, or None.
    """

    name: str
    blocks: Mapping[int, tuple[str, ...]]
    preferred: Mapping[int, frozenset[str]]
    defaults: Mapping[int, str]
    slabs: Mapping[str, str]
    fences: Mapping[str, str]
    glass: str
    pane: str
    only: frozenset[str] | None = None
    furniture: tuple[FurniturePiece, ...] = field(default=())
    meanings: "Meanings | None" = None

    def allows(self, state: str) -> bool:
        """Return whether a block state is allowed by the palette."""
        return self.only is None or state.partition("[")[0] in self.only


def load_palette(name: str) -> Palette:
    """Load a palette by name, or from the path of a palette file.

    Raises:
        UnknownNameError: If no palette has this name and no such file exists.
        InputError: If the file is not a valid palette.
    """
    if name in PALETTE_FILES:
        return load_shipped(name)
    if name.endswith(FILE_SUFFIXES):
        return read_palette(Path(name))
    if Path(name).is_file():
        raise InputError(name, f"a palette file must end with {' or '.join(FILE_SUFFIXES)}")
    raise UnknownNameError("palette", name, PALETTE_FILES)


def shipped_palette_text(name: str) -> str:
    """Return the text of a built-in palette file."""
    source = files("world2minecraft.construction") / "data" / PALETTE_FILES[name]
    return source.read_text("utf-8")


def read_palette(path: Path) -> Palette:
    """Read a palette file.

    Raises:
        InputError: If the file does not exist or is not a valid palette.
        LimitError: If the file is too large.
    """
    text = read_bytes(path, MAX_BYTES)
    try:
        raw = json.loads(text) if path.suffix == ".json" else load_plain_yaml(text)
    except (ValueError, RecursionError) as error:
        kind = "JSON" if path.suffix == ".json" else "YAML"
        raise InputError(path, f"is not valid {kind} ({one_line(error, 200)})") from error
    try:
        return parse_palette(raw)
    except (ValueError, UsageError) as error:
        raise InputError(path, str(error)) from error


@cache
def load_shipped(name: str) -> Palette:
    """Load a built-in palette by name."""
    return parse_palette(json.loads(shipped_palette_text(name)))


def parse_palette(raw: Any) -> Palette:
    """Parse the content of a palette file.

    Raises:
        ValueError: If the content is not a valid palette.
        UnknownNameError: If a block does not exist in the game.
    """
    keys = _mapping("a palette", raw, KEYS)
    name = keys.get("name")
    if not isinstance(name, str) or not name:
        raise ValueError("a palette must have a name, such as name: nordic")
    whole = dict(keys)
    if "extends" in keys or "blocks" in keys:
        whole = _extend(keys)
    only = _only(keys.get("blocks"))
    groups = {
        group: tuple(_cube(block) for block in _names(f"group {group}", blocks))
        for group, blocks in _mapping("groups", whole.get("groups", {})).items()
    }
    chosen = _by_class("classes", whole.get("classes", {}), groups)
    blocks = {number: _usable(number, chosen, only) for number in PAINTED}
    prefers = _by_class("prefers", whole.get("prefers", {}), groups)
    return Palette(
        name=name,
        blocks=blocks,
        preferred={
            number: frozenset(prefers.get(number, ())) & frozenset(blocks[number])
            for number in PAINTED
        },
        defaults=_defaults(whole.get("defaults", {}), blocks),
        slabs=_shapes("slabs", whole.get("slabs", {}), only),
        fences=_shapes("fences", whole.get("fences", {}), only),
        glass=_glass("glass", whole.get("glass"), only),
        pane=_glass("pane", whole.get("pane"), only),
        only=only,
        furniture=tuple(parse_piece(one) for one in _list("furniture", whole.get("furniture", []))),
        meanings=parse_meanings(whole["reads"]) if "reads" in whole else None,
    )


def _extend(keys: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keys of a palette merged with those of the palette it extends."""
    base = keys.get("extends", "vanilla")
    if not isinstance(base, str) or base not in PALETTE_FILES:
        raise ValueError(f"extends must be one of {', '.join(PALETTE_FILES)}, got {base!r}")
    below = json.loads(shipped_palette_text(base))
    if "extends" in below:
        below = _extend(below)
    result = dict(below)
    for key, value in keys.items():
        both = isinstance(value, dict) and isinstance(below.get(key), dict)
        result[key] = {**below[key], **value} if both else value
    return result


def _only(named: Any) -> frozenset[str] | None:
    """Return the full names of the blocks a palette is restricted to, or None for all."""
    if named is None:
        return None
    names = frozenset(_state(block).partition("[")[0] for block in _names("blocks", named))
    if not any(is_full_cube(str(complete(parse_state(name)))) for name in names):
        raise ValueError("blocks must contain at least one full block, such as white_concrete")
    return names


def _usable(
    number: int, chosen: Mapping[int, tuple[str, ...]], only: frozenset[str] | None
) -> tuple[str, ...]:
    """Return the allowed full blocks of a class, or other allowed blocks if there are none."""
    usual = chosen.get(number, ())
    if only is None:
        if not usual:
            raise ValueError(
                f"classes does not contain {CLASS_NAMES[number]!r}; add it with a list of groups"
            )
        return usual
    kept = tuple(block for block in usual if block.partition("[")[0] in only)
    if kept:
        return kept
    whole = (str(complete(parse_state(name))) for name in sorted(only))
    return tuple(state for state in whole if is_full_cube(state) and "glass" not in state) or tuple(
        state for state in map(str, sorted(only)) if is_full_cube(state)
    )


def _by_class(
    what: str, raw: Any, groups: Mapping[str, tuple[str, ...]]
) -> dict[int, tuple[str, ...]]:
    """Return blocks by class number; each class lists groups or blocks."""
    result = {}
    for name, listed in _mapping(what, raw).items():
        if name not in CLASS_NAMES[1:]:
            raise ValueError(
                f"{what} contains an unknown class {name!r}; known: {', '.join(CLASS_NAMES[1:])}"
            )
        result[CLASS_NAMES.index(name)] = tuple(
            block
            for group in _names(f"{what} of {name}", listed)
            for block in (groups[group] if group in groups else (_cube(group),))
        )
    return result


def _defaults(raw: Any, blocks: Mapping[int, tuple[str, ...]]) -> dict[int, str]:
    """Return the block of each class for unknown colours: the allowed block like the stated."""
    stated = _by_class("defaults", {k: [v] for k, v in _mapping("defaults", raw).items()}, {})
    result = {}
    for number, choices in blocks.items():
        wanted = stated.get(number, choices)[0]
        offered = srgb_to_oklab(colours_of(choices))
        nearest = nearest_oklab(srgb_to_oklab(colours_of([wanted])), offered)[0]
        result[number] = wanted if wanted in choices else choices[int(nearest)]
    return result


def _shapes(what: str, raw: Any, only: frozenset[str] | None) -> dict[str, str]:
    """Return allowed slabs or fences by their allowed full block."""
    result = {}
    for block, shape in _mapping(what, raw).items():
        full, name = _cube(block), _state(shape)
        if only is None or {full.partition("[")[0], name.partition("[")[0]} <= only:
            result[full] = name.partition("[")[0] if ":" in str(shape) else str(shape)
    return result


def _glass(what: str, stated: Any, only: frozenset[str] | None) -> str:
    """Return the window block: the stated block if allowed, otherwise a glass of ``only``."""
    if stated is None:
        raise ValueError(f"a palette must contain the key {what}, such as {what}: glass")
    state = str(complete(parse_state(_state(stated))))
    if only is None or state.partition("[")[0] in only:
        return state
    kinds = ("glass_pane", "glass") if what == "pane" else ("glass",)
    for kind in kinds:
        for name in sorted(only):
            if name.endswith(kind):
                return str(complete(parse_state(name)))
    raise ValueError(
        "blocks must contain a glass block for windows, such as glass or white_stained_glass"
    )


def _cube(text: Any) -> str:
    """Return a complete state of a full block that does not fall, melt, grow or change."""
    state = str(complete(parse_state(_state(text))))
    name = state.partition("[")[0].partition(":")[2]
    if not is_full_cube(state):
        raise ValueError(f"{text} is not a full block; surfaces require full blocks")
    passing = any(part in name.split("_") or name.endswith(part) for part in _PASSING)
    passing |= any(part in name for part in _WEATHERING) and not name.startswith("waxed_")
    if passing and not any(part in name for part in _LASTING):
        raise ValueError(f"{text} falls, melts, grows or changes by itself; choose another block")
    return state


def _state(text: Any) -> str:
    """Return a validated block state; blocks of other namespaces are not checked."""
    if not isinstance(text, str):
        raise ValueError(f"a block must be a name such as oak_planks, got {_short(text)}")
    state = parse_state(text)
    return str(check_state(state)) if state.name.startswith("minecraft:") else str(state)


def _mapping(what: str, value: Any, known: Iterable[str] = ()) -> dict[str, Any]:
    if not isinstance(value, dict) or not all(isinstance(key, str) for key in value):
        raise ValueError(f"{what} must be a mapping, got {_short(value)}")
    names = tuple(known)
    strange = [key for key in value if names and key not in names]
    if strange:
        raise ValueError(
            f"{what} contains an unknown key {strange[0]!r}; known: {', '.join(names)}"
        )
    return value


def _list(what: str, value: Any) -> list[Any]:
    if not isinstance(value, list) or len(value) > MAX_NAMES:
        raise ValueError(
            f"{what} must be a list of at most {MAX_NAMES} entries, got {_short(value)}"
        )
    return value


def _names(what: str, value: Any) -> list[str]:
    listed = _list(what, value)
    wrong = [one for one in listed if not isinstance(one, str)]
    if wrong or not listed:
        raise ValueError(f"{what} must be a list of names, got {_short(wrong[0] if wrong else [])}")
    return listed


def _short(value: Any) -> str:
    text = " ".join(repr(value).split())
    return text if len(text) <= 60 else text[:57] + "..."
