"""Materials of the surfaces of a room, which determine the textures in photos.

Every voxel of a room gets one material from its class, object and colour. As in real rooms, wood,
fabric, rugs and pictures have strong textures, while painted walls and cupboards are nearly plain.
"""

from enum import IntEnum

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.procgen.rooms.room import Room

RUG_RUN = 25  # Voxels of one colour that are a rug: boards are 7 wide, and tiles 20.
TALL_M = 0.9  # The grain of a cupboard runs upwards, that of a table lengthwise.
CLOTH_NAMES = frozenset(
    (
        "curtain", "coats", "armchair", "sofa", "bed", "office_chair", "chair", "ottoman",
        "single_bed", "bunk_bed", "shower_curtain", "coat_stand",
    )
)  # fmt: skip
TEXT_NAMES = frozenset(("books", "bookshelf", "box", "monitor", "microwave", "toy_shelf"))
STONE_NAMES = frozenset(("counter", "sink_counter", "washstand"))


class Material(IntEnum):
    """The material of a surface, which ``surface_textures`` renders."""

    BARE = 0
    WALL = 1
    WOOD_X = 2
    WOOD_Y = 3
    WOOD_Z = 4
    CLOTH = 5
    PRINT = 6
    RUG = 7
    TILE = 8
    PICTURE = 9
    LEAF = 10
    TEXT = 11
    STONE = 12
    VIEW = 13


def room_materials(room: Room) -> np.ndarray:
    """Return the material of each voxel of a room as uint8 [X, Y, Z]. Air is ``BARE``."""
    labels, wooden = room.labels, _is_brown(room.colour)
    materials = np.zeros(labels.shape, np.uint8)
    materials[labels == int(SemanticClass.WALL)] = int(Material.WALL)
    materials[labels == int(SemanticClass.WINDOW)] = int(Material.VIEW)
    floor = labels == int(SemanticClass.FLOOR)
    materials[floor] = np.where(wooden[floor], int(Material.WOOD_X), int(Material.TILE))
    materials[_rugs(room)] = int(Material.RUG)
    materials[_is_white(room.colour) & (room.instance == 0) & ~floor] = int(Material.BARE)
    boxes = ndimage.find_objects(room.instance)
    for number, (box, item) in enumerate(zip(boxes, room.objects, strict=False), start=1):
        if box is not None:
            own = room.instance[box] == number
            found = _object_materials(item.name, box, room.colour[box], wooden[box], number)
            materials[box][own] = found[own]
    return materials


def _object_materials(
    name: str,
    box: tuple[slice, ...],
    colour: np.ndarray,
    wooden: np.ndarray,
    number: int,
) -> np.ndarray:
    """Return the materials of the voxels of an object."""
    base = Material.BARE
    if name == "picture":
        return np.full(colour.shape[:3], int(Material.PICTURE), np.uint8)
    if name in TEXT_NAMES:
        base = Material.TEXT
    elif name in STONE_NAMES:
        base = Material.STONE
    elif name in CLOTH_NAMES:
        # Half of the beds and chairs are of one colour, the others have a print.
        base = Material.PRINT if number * 2654435761 >> 16 & 1 else Material.CLOTH
    found = np.full(colour.shape[:3], int(base), np.uint8)
    if name == "plant":
        found[_is_green(colour)] = int(Material.LEAF)
    if base in (Material.STONE, Material.PRINT, Material.CLOTH):
        found[_is_white(colour) if base != Material.STONE else ~_is_grey(colour)] = 0
    sides = [(part.stop - part.start) for part in box]
    along = Material.WOOD_X if sides[0] >= sides[1] else Material.WOOD_Y
    grain = Material.WOOD_Z if sides[2] * 0.02 > TALL_M else along
    if name in CLOTH_NAMES:  # Some cloths are brown too, but more vivid than wood.
        wooden = wooden & _is_dull(colour) & (name != "curtain")
    found[wooden & (base != Material.TEXT or name == "bookshelf")] = int(grain)
    return found


def _rugs(room: Room) -> np.ndarray:
    """Return which floor voxels are part of a rug, as the boxes of large uniform areas."""
    rugs = np.zeros(room.labels.shape, bool)
    floor = room.labels == int(SemanticClass.FLOOR)
    for z in np.flatnonzero(floor.any(axis=(0, 1))):
        tone = room.colour[:, :, z].astype(np.int32) @ np.array([65536, 256, 1], np.int32)
        tone[~floor[:, :, z]] = 0
        low = ndimage.minimum_filter1d(tone, RUG_RUN, axis=1, mode="constant")
        same = (low == ndimage.maximum_filter1d(tone, RUG_RUN, axis=1, mode="constant")) & (low > 0)
        same = ndimage.maximum_filter1d(same, RUG_RUN, axis=1, mode="constant")
        parts, _ = label_components(same, corners=False)
        for number, box in enumerate(ndimage.find_objects(parts), start=1):
            if box[0].stop - box[0].start >= RUG_RUN:
                # A turned rug does not fill its box.
                own = np.isin(tone[box], np.unique(tone[box][parts[box] == number]))
                rugs[:, :, z][box] |= floor[:, :, z][box] & own
    return rugs


def _is_brown(colour: np.ndarray) -> np.ndarray:
    red, green, blue = (colour[..., n].astype(np.int16) for n in range(3))
    return (red - blue > 30) & (green > red // 2) & (green < red * 0.88)


def _is_dull(colour: np.ndarray) -> np.ndarray:
    red, green, blue = (colour[..., n].astype(np.int16) for n in range(3))
    return (green > red * 0.6) & (blue > red * 0.37)


def _is_white(colour: np.ndarray) -> np.ndarray:
    return (colour.min(axis=-1) > 218) & (np.ptp(colour, axis=-1) < 14)


def _is_grey(colour: np.ndarray) -> np.ndarray:
    return np.ptp(colour, axis=-1) < 14


def _is_green(colour: np.ndarray) -> np.ndarray:
    return (colour[..., 1] > colour[..., 0]) & (colour[..., 1] > colour[..., 2])


def wall_planes(room: Room) -> np.ndarray:
    """Return which wall planes are large enough for a poster, as bool [4, N] by face and index.

    The sides of recesses and columns are too narrow for a poster.
    """
    wall = room.labels == int(SemanticClass.WALL)
    air = room.labels == 0
    least = round(1.6 / room.voxel_m**2)
    found = np.zeros((4, max(room.labels.shape[:2])), bool)
    for axis in (0, 1):
        near = np.moveaxis(wall, axis, 0), np.moveaxis(air, axis, 0)
        low = (near[0][1:] & near[1][:-1]).sum(axis=(1, 2)) > least
        high = (near[0][:-1] & near[1][1:]).sum(axis=(1, 2)) > least
        found[2 * axis, 1 : len(low) + 1] = low  # Its face looks to lower values.
        found[2 * axis + 1, : len(high)] = high
    return found


def heights_m(room: Room) -> np.ndarray:
    """Return the height of each voxel layer above the floor of its storey, as float64 [Z]."""
    z = room.origin_m[2] + np.arange(room.labels.shape[2]) * room.voxel_m
    floors = np.array(sorted({layout.floor_z_m for layout in room.layouts}))
    return z - floors[np.maximum(np.searchsorted(floors, z + 0.05, side="right") - 1, 0)]
