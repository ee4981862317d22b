"""List, add and draw the pieces of the furniture library."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, class_id, display_name
from world2minecraft.core.errors import UsageError
from world2minecraft.core.progress import Progress, no_progress

if TYPE_CHECKING:
    from world2minecraft.furniture import Template
    from world2minecraft.rendering.furniture_sheet import Card

SCALES = (1.0, 2.0, 4.0)  # Blocks per metre of what is shown and drawn.


def list_furniture(word: str = "", *, class_name: str = "") -> list["Template"]:
    """Return the furniture of the library and of the user, in the order used for matching.

    Args:
        word: Part of a name, a title or a family. Empty returns all pieces.
        class_name: ``chair``, ``bed``, ``sofa``, ``table``, ``tvs``, ``furn`` or ``objs``. Empty
            returns all classes.

    Raises:
        UnknownNameError: If the class is unknown.

    Example:
        >>> import world2minecraft as w2m
        >>> [piece.name for piece in w2m.list_furniture("bathtub")]
        ['bathtub', 'bathtub_freestanding']
    """
    from world2minecraft.furniture import TEMPLATES

    number = class_id(class_name) if class_name else None
    every = [furniture_piece(name) for name in TEMPLATES.names()]
    found = [one for one in every if number in (None, one.class_id)]
    return [one for one in found if word.lower() in f"{one.name} {one.title} {one.family}".lower()]


def furniture_piece(name: str) -> "Template":
    """Return the piece of furniture with the given name.

    Raises:
        UnknownNameError: If the name is unknown.
    """
    from world2minecraft.furniture import template

    return template(name)


def is_own(piece: "Template") -> bool:
    """Return whether a piece of furniture was added by the user."""
    from world2minecraft.furniture.user_library import user_design_files

    return piece.name in user_design_files()


def by_heading(pieces: Sequence["Template"]) -> dict[str, list["Template"]]:
    """Group pieces of furniture under class headings such as ``Chairs``, without empty groups."""
    from world2minecraft.furniture.library import group_by_class

    return group_by_class(pieces)


def furniture_markdown(pieces: Sequence["Template"]) -> str:
    """Return pieces of furniture as Markdown tables, with one table per class."""
    from world2minecraft.furniture.library import templates_to_markdown

    return templates_to_markdown(pieces)


def block_counts(piece: "Template", blocks_per_metre: float) -> dict[str, int]:
    """Return the number of blocks of each type in a piece of typical size at a scale.

    The result is empty if the piece has no block design at that scale and its shape is fitted
    instead.

    Example:
        >>> from world2minecraft.api.furniture import block_counts, furniture_piece
        >>> block_counts(furniture_piece("chair"), 1)
        {'oak_stairs': 1}
    """
    from collections import Counter

    from world2minecraft.furniture.block_designs import block_size

    blocks = piece.blocks(block_size(np.array(piece.typical_m), blocks_per_metre))
    kinds = Counter(block.state.partition("[")[0].rpartition(":")[2] for block in blocks)
    return dict(sorted(kinds.items()))


def furniture_json(piece: "Template") -> dict[str, Any]:
    """Return the properties of a piece as JSON values: sizes in metres, parameters, materials."""
    sides = zip(("depth", "width", "height"), piece.size_m, strict=True)
    return {
        "name": piece.name,
        "title": piece.title,
        "class": CLASS_NAMES[piece.class_id],
        "class_display_name": display_name(piece.class_id),
        "family": piece.family,
        "size_m": {side: span._asdict() for side, span in sides},
        "mount": piece.mount,
        "turns": piece.turns,
        "clearance_m": list(piece.clearance_m),
        "parameters": {name: span._asdict() for name, span in piece.parameters.items()},
        "options": dict(piece.options),
        "materials": {role: asdict(material) for role, material in piece.materials.items()},
        "matched": piece.matched,
        "own": is_own(piece),
        "blocks": {f"{scale:g}": block_counts(piece, scale) for scale in SCALES},
    }


@dataclass(frozen=True)
class AddedFurniture:
    """A piece of furniture that was added to the user's library.

    Attributes:
        name: Name in the library.
        path: File that was written.
        blocks: Number of blocks.
        size_m: Typical depth, width and height in metres.
        front: Side that the front faced in the source: ``north``, ``east``, ``south`` or ``west``.
        notes: Parts of the source that were omitted, and assumptions that were made.
    """

    name: str
    path: Path
    blocks: int
    size_m: tuple[float, float, float]
    front: str
    notes: tuple[str, ...]


def add_furniture(
    source: str | Path,
    class_name: str,
    blocks_per_metre: float,
    *,
    name: str = "",
    title: str = "",
    front: str | None = None,
    size_m: tuple[float, float, float] | None = None,
    mount: str = "floor",
    recolour: bool = False,
    match: bool = True,
    force: bool = False,
) -> AddedFurniture:
    """Add a piece of furniture built from blocks to the user's furniture library.

    Surrounding air is removed. At its own scale, the piece is built block for block. At other
    scales, its shape is fitted with blocks. The piece is stored in the folder named by the
    environment variable ``W2M_FURNITURE``, or next to the user's settings.

    Args:
        source: ``.schem``, ``.litematic``, ``.nbt`` or other file with blocks.
        class_name: ``chair``, ``bed``, ``sofa``, ``table``, ``tvs``, ``furn`` or ``objs``.
        blocks_per_metre: Scale at which the piece was built.
        name: Name in the library. Defaults to the file name.
        title: Readable name.
        front: Side that the front faces: ``north``, ``east``, ``south`` or ``west``. Inferred from
            the blocks by default.
        size_m: Real depth, width and height in metres. Defaults to the size of the blocks.
        mount: ``floor``, ``wall``, ``ceiling`` or ``any``.
        recolour: Replace wood, wool and stone with variants in the colour of the matched object.
        match: Match reconstructed objects with this piece.
        force: Replace an existing piece of the user with the same name.

    Raises:
        UsageError: If a name or class is invalid, or if the name is already in use.
        InputError: If the file cannot be read.
        OutputError: If the library cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> add_furniture("my_chair.schem", "chair", 2, name="My Chair!")
        Traceback (most recent call last):
        ...
        world2minecraft.core.errors.UsageError: a furniture name must start with a letter ...
    """
    from world2minecraft.core.files import write_json
    from world2minecraft.furniture.user_import import ImportRequest, import_blocks
    from world2minecraft.furniture.user_library import check_name, template_from_json
    from world2minecraft.minecraft.file_format import Losses
    from world2minecraft.minecraft.formats import read_blocks

    place = Path(source)
    chosen = check_name(name or place.stem.lower().replace("-", "_").replace(" ", "_"))
    target = _free_file(chosen, force)
    losses = Losses()
    volume = read_blocks(place, losses)
    losses.add("block entities", len(volume.block_entities))
    losses.add("entities", len(volume.entities))
    added = import_blocks(
        volume,
        ImportRequest(
            chosen, class_name, blocks_per_metre, front, size_m, title, mount, recolour, match
        ),
    )
    piece = template_from_json(added.content)  # Raises where it could not be read again.
    write_json(target, added.content)
    runs = added.content["blocks"]["runs"]
    return AddedFurniture(
        piece.name,
        target,
        sum(length for number, length in runs if number),
        piece.typical_m,
        added.front,
        (*(f"omitted: {count} {what}" for what, count in losses), *added.notes),
    )


def _free_file(name: str, force: bool) -> Path:
    """Return the file path of a new piece.

    Raises:
        UsageError: If the name is already in use.
    """
    from world2minecraft.furniture.library import builtin_design_files
    from world2minecraft.furniture.user_library import user_design_folder

    if name in builtin_design_files():
        raise UsageError(f"the library already contains {name}; choose another name (--name)")
    target = user_design_folder() / f"{name}.json"
    if target.exists() and not force:
        raise UsageError(
            f"{target} exists; choose another name (--name), or use --force to replace it"
        )
    return target


def draw_furniture(
    out: str | Path,
    names: Sequence[str] = (),
    *,
    class_name: str = "",
    columns: int = 4,
    progress: Progress = no_progress,
) -> dict[Path, list["Template"]]:
    """Draw furniture at 1, 2 and 4 blocks per metre, and write a PNG file for each page.

    The named pieces or those of one class are one page. Without either, each class is a page of its
    own, whose file name ends in the class, such as ``furniture_chair.png``.

    Args:
        out: PNG file to write.
        names: Pieces to draw. Defaults to all pieces.
        class_name: Draw only this class.
        columns: Number of pieces per row.
        progress: Callback that is called before and after each page.

    Returns:
        The pieces on each page, by the page's file.

    Raises:
        UsageError: If no selected piece can be drawn.
        UnknownNameError: If a piece or class is unknown.
        OutputError: If a file cannot be written.

    Example:
        >>> from world2minecraft.api.furniture import draw_furniture
        >>> pages = draw_furniture(tmp / "rug.png", ["rug"])
        >>> [(file.name, [piece.name for piece in pieces]) for file, pieces in pages.items()]
        [('rug.png', ['rug'])]
    """
    from world2minecraft.core.files import write_bytes
    from world2minecraft.rendering.furniture_sheet import contact_sheet, sheet_png

    number = class_id(class_name) if class_name else None
    every = [furniture_piece(name) for name in names] if names else list_furniture()
    chosen = [one for one in every if number in (None, one.class_id)]
    pages = {Path(out): chosen}
    if not names and number is None:
        pages = _class_pages(Path(out), chosen)
    for done, (file, pieces) in enumerate(pages.items()):
        progress("render", done, len(pages))
        groups = {
            heading: [card for one in members for card in _cards(one)]
            for heading, members in by_heading(pieces).items()
        }
        if not any(groups.values()):
            raise UsageError(
                "nothing to draw: no selected piece has a block design at scale 1, 2 or 4"
            )
        write_bytes(file, sheet_png(contact_sheet(groups, columns)))
    progress("render", len(pages), len(pages))
    return pages


def _class_pages(out: Path, pieces: Sequence["Template"]) -> dict[Path, list["Template"]]:
    """Return the pieces of each class by a file named after it."""
    pages: dict[Path, list[Template]] = {}
    for piece in sorted(pieces, key=lambda one: one.class_id):
        name = display_name(piece.class_id)
        pages.setdefault(out.with_stem(f"{out.stem}_{name}"), []).append(piece)
    return pages


def _cards(piece: "Template") -> list["Card"]:
    from world2minecraft.furniture.preview_scene import preview_volume
    from world2minecraft.rendering.furniture_sheet import Card

    wall = piece.mount == "wall"
    volumes = {f"{scale:g} per metre": preview_volume(piece, scale, room=wall) for scale in SCALES}
    drawn = {label: volume for label, volume in volumes.items() if volume is not None}
    size = " x ".join(f"{side:.2f}" for side in piece.typical_m)
    return [Card(piece.title, f"{piece.name}   {size} m", drawn)] if drawn else []
