"""Which blocks a room may be built of: palettes by name, or a file of one's own.

A palette says which full blocks a surface of each class may be made of. A mod's says beside it
which of its blocks stand for which furniture (``own_furniture``) and what its blocks mean
(``meanings``). One that lists ``blocks`` is restricted to them (``restricting``). Files are read
and checked by ``palette_files``; docs/palettes.md says how they are written.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.core.errors import InputError, UnknownNameError

if TYPE_CHECKING:
    from world2minecraft.construction.block_meanings import Meanings
    from world2minecraft.construction.pieces import Piece

PALETTE_FILES = {
    "vanilla": "palette_vanilla.json",
    "tmeo": "palette_tmeo.json",
    "refurbished_furniture": "palette_refurbished_furniture.json",
}
FILE_SUFFIXES = (".yaml", ".yml", ".json")


@dataclass(frozen=True)
class Palette:
    """Blocks by class. States are complete; ``slabs`` and ``fences`` go by full block.

    ``preferred`` are the blocks that win where colours are about as near: a table is of wood.
    ``only`` are the names of all blocks that may be seen; None allows every one. ``furniture``
    are the pieces of a mod, ``meanings`` what its blocks stand for.
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
    furniture: tuple["Piece", ...] = field(default=())
    meanings: "Meanings | None" = None

    def allows(self, state: str) -> bool:
        """Whether a state, as text, may be used: it is one of ``only``, where there are such."""
        return self.only is None or state.partition("[")[0] in self.only


def load_palette(name: str) -> Palette:
    """Return a palette by its name, or by the path of a file of one's own.

    Raises:
        UnknownNameError: no palette and no file has this name.
        InputError: the file is no palette; the message says what it lacks.
    """
    from world2minecraft.construction.palette_files import read_palette, source_of  # noqa: PLC0415

    if name in PALETTE_FILES:
        return source_of(name)
    if name.endswith(FILE_SUFFIXES):
        return read_palette(Path(name))
    if Path(name).is_file():
        raise InputError(name, f"a palette's file ends with {', '.join(FILE_SUFFIXES)}")
    raise UnknownNameError("palette", name, PALETTE_FILES)


def shipped(name: str) -> str:
    """Return the text of a palette file of the program."""
    source = files("world2minecraft.construction") / "data" / PALETTE_FILES[name]
    return source.read_text("utf-8")
