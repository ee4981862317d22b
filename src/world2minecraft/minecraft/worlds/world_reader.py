"""Reading of Minecraft Java world folders as volumes."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError, InputError, LimitError
from world2minecraft.core.files import read_bytes
from world2minecraft.core.types import BlockEntity, BlockVolume, Entity
from world2minecraft.core.whole_reads import read_whole
from world2minecraft.minecraft.bit_packing import SECTION, unpack_section
from world2minecraft.minecraft.nbt import NbtLimits, read_nbt, tree_bytes, unpack
from world2minecraft.minecraft.signs import upgrade_signs
from world2minecraft.minecraft.unlabelled_volume import (
    MAX_CELLS,
    MAX_STATES,
    build_palette,
    unlabelled_volume,
)
from world2minecraft.minecraft.worlds.anvil import read_region, region_position
from world2minecraft.minecraft.worlds.chunks import Section, read_block_entities, read_chunk
from world2minecraft.minecraft.worlds.level_dat import no_world

MAX_SECTIONS = MAX_CELLS // SECTION  # Held before the volume's size is known.
MAX_UNPACKED_BYTES = 512 << 20  # All chunks that are read together.
MAX_HELD_BYTES = 96 << 20  # Of entities and block entities.
LEVEL_LIMITS = NbtLimits(values=200_000, bytes=32 << 20)
Place = tuple[int, int]
# A section's place, its palette as numbers (uint16) and its words (uint64).
Numbered = tuple[tuple[int, int, int], np.ndarray, np.ndarray]
Kept = TypeVar("Kept", BlockEntity, Entity)
Box = tuple[int, int, int, int, int, int]


def read_world(folder: str | Path, *, box: Box | None = None) -> BlockVolume:
    """Read the overworld of a world folder of 1.13 or later.

    Args:
        folder: The folder that contains ``level.dat``.
        box: The box to read as x0, y0, z0, x1, y1, z1 in blocks, with exclusive upper bounds. The
            default is the bounding box of all blocks except air.

    Returns:
        The volume without labels. Its scale is one block per metre, because worlds do not store a
        scale.

    Raises:
        InputError: If the world is not found.
        DamagedFileError: If a file of the world is damaged.
        LimitError: If the world is too large. Use a box in this case.
        ConflictError: If another process is changing the world.
    """
    root = Path(folder)
    return read_whole(root, lambda: _read_world(root, box))


def _read_world(root: Path, box: Box | None) -> BlockVolume:
    read_level(root)
    regions = region_files(root)
    if not regions:
        raise InputError(root, "contains no region files of the overworld; nothing to read")
    found = _gather([path for path in regions if _may_overlap(path, box)], box)
    palette, number_of = build_palette(found.numbers, root)
    numbers = np.array([number_of[state] for state in found.numbers], np.uint16)
    states, corner = _fill(root, found.sections, numbers, box)
    if box is None:
        states, corner = _trim(states, corner)
    high = np.array(corner) + states.shape

    def inside(position: Any) -> bool:
        return bool((np.array(corner) <= position).all() and (position < high).all())

    found.add_entity_files(entity_files(regions, box), box)
    return unlabelled_volume(
        states,
        palette,
        corner,
        (e for e in found.block_entities if inside(e.block_pos)),
        (e for e in found.entities if box is None or inside(e.position)),
    )


def read_level(folder: Path) -> dict[str, Any]:
    """Return the ``Data`` compound of a world's ``level.dat``.

    Raises:
        InputError: If the file is not found.
        DamagedFileError: If the file is damaged.
        LimitError: If the file exceeds the NBT limits.
    """
    path = folder / "level.dat"
    if not path.is_file():
        raise no_world(folder)
    if (folder / "db").is_dir() and not region_files(folder):
        raise InputError(
            folder,
            "is a Bedrock Edition world, but only Java Edition worlds are supported; "
            "export the blocks as .mcstructure in the game",
        )
    data = unpack(read_bytes(path, LEVEL_LIMITS.bytes), path, LEVEL_LIMITS.bytes)
    _, root = read_nbt(data, path, LEVEL_LIMITS)
    if not isinstance(root.get("Data"), dict):
        raise DamagedFileError(path, "contains no Data compound")
    return root["Data"]


def region_files(root: Path) -> list[Path]:
    """Return the region files of the overworld, including the folder layout of 26.1 and later."""
    for folder in (root / "region", root / "dimensions" / "minecraft" / "overworld" / "region"):
        found = sorted(folder.glob("r.*.mca"))
        if found:
            return found
    return []


def _gather(regions: list[Path], box: Box | None) -> "_ChunkContents":
    found = _ChunkContents()
    known: dict[bytes, str] = {}
    unpacked = 0
    for path in regions:
        for place, data in read_region(path, lambda place: _overlaps(place, box)):
            unpacked += len(data)
            root, sections = read_chunk(data, place, path, known)
            for section in sections:
                if box is None or _is_level(section, box):
                    found.add_section(section, path)
            if unpacked > MAX_UNPACKED_BYTES or len(found.sections) > MAX_SECTIONS:
                raise LimitError(
                    path,
                    f"exceeds the limit of {MAX_CELLS:,} blocks or the memory limit; "
                    "use a box (--box) to read a part of the world",
                )
            held = read_block_entities(root, path)
            found.block_entities += found.within(upgrade_signs(held, root["DataVersion"]), path)
            found.entities += found.within(_entities(root.get("Entities", []), path), path)
    return found


class _ChunkContents:
    """The contents of the chunks read so far, with a limit on their memory."""

    def __init__(self) -> None:
        self.numbers: dict[str, int] = {}  # Of each state, in the order in which they were met.
        self.sections: list[Numbered] = []
        self.block_entities: list[BlockEntity] = []
        self.entities: list[Entity] = []
        self._held_bytes = 0

    def add_section(self, section: Section, path: Path) -> None:
        """Add a section and replace its palette by indices."""
        numbers = self.numbers
        own = [numbers.setdefault(state, len(numbers)) for state in section.palette]
        if len(numbers) > MAX_STATES:
            raise LimitError(
                path,
                f"exceeds the limit of {MAX_STATES:,} block states; "
                "use a box (--box) to read a part of the world",
            )
        self.sections.append((section.place, np.array(own, np.uint16), section.words))

    def add_entity_files(self, paths: list[Path], box: Box | None) -> None:
        """Read the entity files, which are separate from region files since 1.17."""
        for path in paths:
            for _, data in read_region(path, lambda place: _overlaps(place, box)):
                _, root = read_nbt(data, path)
                self.entities += self.within(_entities(root.get("Entities"), path), path)

    def within(self, held: Sequence[Kept], path: Path) -> Sequence[Kept]:
        """Return the entities after checking that they are within the memory limit."""
        self._held_bytes += sum(tree_bytes(dict(entity.nbt)) for entity in held)
        if self._held_bytes > MAX_HELD_BYTES:
            raise LimitError(
                path,
                f"exceeds the limit of {MAX_HELD_BYTES:,} bytes of entities; "
                "use a box (--box) to read a part of the world",
            )
        return held


def _is_level(section: Section, box: Box) -> bool:
    return box[1] < section.place[1] * 16 + 16 and section.place[1] * 16 < box[4]


def entity_files(regions: list[Path], box: Box | None) -> list[Path]:
    """Return the entity files next to a world's region files that can overlap a box."""
    folder = regions[0].parent.parent / "entities"
    return [path for path in sorted(folder.glob("r.*.mca")) if _may_overlap(path, box)]


def _may_overlap(path: Path, box: Box | None) -> bool:
    """Return whether a region can overlap a box, so that its file must be read."""
    if box is None:
        return True
    x, z = (side * 512 for side in region_position(path))
    return box[0] < x + 512 and x < box[3] and box[2] < z + 512 and z < box[5]


def _overlaps(place: Place, box: Box | None) -> bool:
    if box is None:
        return True
    x, z = place[0] * 16, place[1] * 16
    return box[0] < x + 16 and x < box[3] and box[2] < z + 16 and z < box[5]


def _fill(
    root: Path, sections: list[Numbered], numbers: np.ndarray, box: Box | None
) -> tuple[np.ndarray, tuple[int, int, int]]:
    if box is None:
        places = np.array([place for place, _, _ in sections] or [(0, 4, 0)])
        low, high = places.min(axis=0) * 16, (places.max(axis=0) + 1) * 16
    else:
        low, high = np.array(box[:3]), np.array(box[3:])
    size = high - low
    if (size <= 0).any() or size.astype(float).prod() > MAX_CELLS:
        shown = " x ".join(str(side) for side in size.tolist())
        raise LimitError(
            root,
            f"has {shown} blocks, the limit is {MAX_CELLS:,}; "
            "use a box (--box) to read a part of the world",
        )
    states = np.zeros(tuple(size.tolist()), np.uint16)
    for place, own, words in sections:
        origin = np.array(place, np.int64) * 16 - low
        if not unpack_section(words, numbers[own], states, origin):
            raise DamagedFileError(
                root, f"section {place} contains a block index that is not in its palette"
            )
    x, y, z = low.tolist()
    return states, (x, y, z)


def _trim(
    states: np.ndarray, corner: tuple[int, int, int]
) -> tuple[np.ndarray, tuple[int, int, int]]:
    """Remove the outer layers of air."""
    cuts = []
    for axis in range(3):
        filled = np.flatnonzero(states.any(axis=tuple({0, 1, 2} - {axis})))
        cuts.append(slice(filled[0], filled[-1] + 1) if len(filled) else slice(0, 1))
    x, y, z = (int(low + cut.start) for low, cut in zip(corner, cuts, strict=True))
    return np.ascontiguousarray(states[tuple(cuts)]), (x, y, z)


def _entities(held: Any, path: Path) -> list[Entity]:
    """Return the entities of an NBT list."""
    try:
        return [_entity(nbt) for nbt in held]
    except MALFORMED as error:
        raise DamagedFileError(path, "contains an entity without ID or position") from error


def _entity(nbt: dict[str, Any]) -> Entity:
    x, y, z = (float(value) for value in nbt["Pos"])
    rest = {key: nbt[key] for key in nbt if key not in ("id", "Pos")}
    return Entity((x, y, z), str(nbt["id"]), rest)
