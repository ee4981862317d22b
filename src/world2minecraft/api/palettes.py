"""List and open palettes, which define the blocks that rooms are built from."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.core.classes import CLASS_NAMES

if TYPE_CHECKING:
    from world2minecraft.construction.palettes import Palette


def list_palettes() -> list["Palette"]:
    """Return the palettes included in the program.

    Example:
        >>> import world2minecraft as w2m
        >>> [palette.name for palette in list_palettes()]
        ['vanilla', 'tmeo', 'refurbished_furniture']
    """
    from world2minecraft.construction.palettes import PALETTE_FILES

    return [open_palette(name) for name in PALETTE_FILES]


def open_palette(name: str | Path) -> "Palette":
    """Return an included palette by name, or read a palette from a YAML or JSON file.

    Raises:
        UnknownNameError: If the palette is unknown.
        InputError: If the file is not a valid palette.

    Example:
        >>> from world2minecraft.api.palettes import open_palette
        >>> open_palette("vanilla").glass
        'minecraft:glass'
    """
    from world2minecraft.construction.palettes import load_palette

    return load_palette(str(name))


def palette_json(palette: "Palette") -> dict[str, Any]:
    """Return a palette as JSON values: blocks by class, furniture, and number of name rules.

    Example:
        >>> from world2minecraft.api.palettes import open_palette, palette_json
        >>> palette_json(open_palette("vanilla"))["restricted_to"] is None
        True
    """
    return {
        "name": palette.name,
        "full_blocks": len({state for states in palette.blocks.values() for state in states}),
        "restricted_to": None if palette.only is None else sorted(palette.only),
        "words": 0 if palette.meanings is None else len(palette.meanings.words),
        "classes": {CLASS_NAMES[number]: list(states) for number, states in palette.blocks.items()},
        "furniture": [
            {"designs": list(piece.designs), "blocks": [cell.id for cell in piece.cells]}
            for piece in palette.furniture
        ],
    }
