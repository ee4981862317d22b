"""The furniture of a mod that a palette offers: blocks that stand for some templates."""

from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

from world2minecraft.minecraft.block_colours import DYES, WOODS
from world2minecraft.minecraft.block_states import BlockState

FILLS = ("one", "row", "floor", "box")
# Where a block's facing looks, of a piece that looks east.
FACINGS = {"front": "east", "back": "west", "left": "north", "right": "south"}
LARGEST = 8  # Blocks a side of a piece made of several.
JOINS = ("sides", "flags", "shape")


class Cell(NamedTuple):
    """One block of a piece of several: front-to-back, side, up from its first; its block."""

    at: tuple[int, int, int]
    id: str
    properties: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Piece:
    """What stands for some templates.

    designs: the names of templates, or of families, that it stands for.
    cells: its blocks; ``{wood}`` and ``{dye}`` in their names take the object's colour.
    fill: ``one`` as they are; ``row`` across its width, ``floor`` over its footprint, ``box``
        over all of it, each by the one cell.
    facing: where ``facing`` looks: ``front``, ``back``, ``left`` or ``right``; none without it.
    joins: how it joins its like: ``sides`` (north, east ... of tables), ``flags`` (left, right of
        desks), ``shape`` (the shape of sofas); none for blocks that stand alone.
    """

    designs: tuple[str, ...]
    cells: tuple[Cell, ...]
    fill: str = "one"
    facing: Literal["front", "back", "left", "right"] | None = None
    joins: str | None = None


def piece_of(raw: Any) -> Piece:
    """Return the piece that an entry of a palette file holds.

    Raises:
        ValueError: it is none. UsageError: it names no block.
    """
    known = ("for", "id", "properties", "cells", "fill", "facing", "joins")
    if not isinstance(raw, dict) or not set(raw) <= set(known) or "for" not in raw:
        raise ValueError(f"furniture must have for and id, and may have {', '.join(known[2:])}")
    designs = raw["for"]
    if not (isinstance(designs, list) and designs and all(isinstance(d, str) for d in designs)):
        raise ValueError(f"for must be a list of designs or families, not {designs!r}")
    for key, choices in (("fill", FILLS), ("facing", tuple(FACINGS)), ("joins", JOINS)):
        if key in raw and raw[key] not in choices:
            raise ValueError(f"{key} must be one of {', '.join(choices)}, not {raw[key]!r}")
    listed = raw.get("cells", [{"id": raw.get("id"), "properties": raw.get("properties", {})}])
    cells = tuple(_cell(one) for one in listed)
    if len(cells) > 1 and raw.get("fill", "one") != "one":
        raise ValueError("a piece of several cells cannot fill a place")
    return Piece(tuple(designs), cells, raw.get("fill", "one"), raw.get("facing"), raw.get("joins"))


def _cell(raw: Any) -> Cell:
    if not isinstance(raw, dict) or not isinstance(raw.get("id"), str):
        raise ValueError(f"a piece of furniture needs an id, such as mod:oak_chair, not {raw!r}")
    at = raw.get("at", [0, 0, 0])
    good = isinstance(at, list) and len(at) == 3 and all(type(v) is int for v in at)
    if not good or not all(0 <= v < LARGEST for v in at):
        raise ValueError(f"at must be three whole numbers from 0 to {LARGEST - 1}, not {at!r}")
    properties = raw.get("properties", {})
    if not isinstance(properties, dict):
        raise ValueError(f"properties must be keys with values, not {properties!r}")
    texts = {str(key): str(value).lower() for key, value in properties.items()}
    for kind in (WOODS[0], DYES[0]):
        BlockState(raw["id"].replace("{wood}", kind).replace("{dye}", kind), texts)
    return Cell((at[0], at[1], at[2]), raw["id"], tuple(sorted(texts.items())))
