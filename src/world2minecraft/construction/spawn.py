"""The spawn of the player: on free floor, facing the furnished centre of the room."""

from typing import NamedTuple

import numpy as np

from world2minecraft.construction.canvas import AIR, LIGHT
from world2minecraft.core.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.core.coordinates import PLAYER_EYE_BLOCKS, ROOM_CORNER_BLOCK
from world2minecraft.core.types import BlockVolume
from world2minecraft.geometry.connected_components import label_face_components
from world2minecraft.geometry.morphology import erode_faces, nearest_set_cells

PLAYER_BLOCKS = 2  # 1.8 high.
CLEARANCE = 3.0  # Blocks to the nearest thing beyond which more room is worth no more. A guess.


class Spawn(NamedTuple):
    """The position of the player's feet in world block coordinates, and the game yaw in degrees."""

    position: tuple[float, float, float]
    yaw_deg: float


def find_spawn(volume: BlockVolume) -> Spawn:
    """Find the spawn of a volume.

    The spawn is a free position in the largest walkable part of the floor, with space around it, as
    far as possible from the centre of the furniture but in sight of it. If no position is free, the
    spawn is above the centre of the room.
    """
    ground = ROOM_CORNER_BLOCK[1] - volume.corner[1]
    standing = standing_cells(volume)
    if not standing.any():
        return _on_top(volume)
    parts, sizes = label_face_components(standing)
    largest = parts == int(np.argmax(sizes))
    room = np.minimum(nearest_set_cells(~np.pad(standing, 1))[1][1:-1, 1:-1], CLEARANCE)
    focus = _focus(volume, standing)
    cells = np.argwhere(largest)
    offsets = focus - (cells + 0.5)
    reach = np.hypot(*offsets.T)
    sight = np.array([_free_way(volume, cell, focus, ground) for cell in cells])
    score = room[tuple(cells.T)] * 2 + np.minimum(sight, reach) / max(reach.max(), 1) * CLEARANCE
    best = int(np.argmax(np.round(score, 6)))
    x, z = cells[best]
    yaw = float(np.degrees(np.arctan2(-offsets[best, 0], offsets[best, 1])))
    east, south = float(volume.corner[0] + x + 0.5), float(volume.corner[2] + z + 0.5)
    return Spawn((east, float(ROOM_CORNER_BLOCK[1]), south), round(yaw, 3))


def standing_cells(volume: BlockVolume) -> np.ndarray:
    """Return the bool [X, Z] mask of the columns in which a player can stand on the floor layer."""
    ground = ROOM_CORNER_BLOCK[1] - volume.corner[1]
    free = np.isin(
        volume.states,
        [i for i, state in enumerate(volume.palette) if state in (AIR, LIGHT) or "_sign[" in state],
    )
    floor = volume.semantic[:, ground - 1] == SemanticClass.FLOOR
    return floor & free[:, ground : ground + PLAYER_BLOCKS].all(1) & _within(volume, ground)


def _within(volume: BlockVolume, ground: int) -> np.ndarray:
    """Return the columns whose four neighbours are floor too, excluding the rim beyond walls."""
    return erode_faces(volume.states[:, ground - 1] > 0)


def _focus(volume: BlockVolume, standing: np.ndarray) -> np.ndarray:
    """Return the centre of the furniture, or of the floor without furniture, float64 [2]."""
    things = np.isin(volume.semantic, OBJECT_CLASSES).sum(1)
    if not things.any():
        return np.argwhere(standing).mean(0) + 0.5
    cells = np.argwhere(things > 0)
    return np.average(cells + 0.5, axis=0, weights=things[tuple(cells.T)])


def _free_way(volume: BlockVolume, cell: np.ndarray, focus: np.ndarray, ground: int) -> float:
    """Return the distance, in blocks, that is visible from a cell towards the focus."""
    start = cell + 0.5
    length = float(np.hypot(*(focus - start)))
    steps = np.arange(0.5, max(length, 0.5), 0.5)
    points = start + np.outer(steps / max(length, 1e-9), focus - start)
    x, z = np.clip(points.astype(int), 0, np.array(volume.states.shape)[[0, 2]] - 1).T
    blocked = np.flatnonzero(volume.semantic[x, ground + int(PLAYER_EYE_BLOCKS), z] > 0)
    return float(steps[blocked[0]]) if len(blocked) else length


def _on_top(volume: BlockVolume) -> Spawn:
    x, _, z = (size // 2 for size in volume.states.shape)
    filled = np.flatnonzero(volume.states[x, :, z])
    top = int(filled.max()) + 1 if len(filled) else 0
    feet = np.array([x, top, z]) + volume.corner
    return Spawn((float(feet[0]) + 0.5, float(feet[1]), float(feet[2]) + 0.5), 0.0)
