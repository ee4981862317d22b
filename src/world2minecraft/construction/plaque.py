"""A plaque near the spawn: a sign with the name of the scene.

If the room is larger than life, clicking the sign scales the player up to the room, and clicking
again restores the normal size. The commands are described in docs/reference/formats.md.
"""

from dataclasses import replace

import numpy as np

from world2minecraft.construction.canvas import LIGHT
from world2minecraft.construction.spawn import Spawn, find_spawn
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.minecraft.collision_shapes import boxes_of
from world2minecraft.minecraft.rules.supports import STEPS, UP, faces_of, is_solid
from world2minecraft.minecraft.signs import sign_entity, wrap_sign_text

WALL_SIGN = "minecraft:oak_wall_sign[facing={},waterlogged=false]"
SIGN = "minecraft:oak_sign[rotation={},waterlogged=false]"
NEAR, BEST, FAR = 1.0, 3.0, 12.0  # Blocks from the spawn; nearer it would be in one's face.
ASIDE = 5.0  # Blocks of way that looking straight at it is worth. A guess.
LARGER = 1.5  # Blocks a metre from which on the player's own size matters.
TOGGLE = "/function w2m:toggle_size"
_FACINGS = ("north", "east", "south", "west")


def add_plaque(volume: BlockVolume, name: str) -> BlockVolume:
    """Add a sign with a name to a volume, or return the volume unchanged if no wall is free.

    The sign has class 0, since it is not part of the scan.

    Args:
        volume: Finished blocks of the room.
        name: Printable text; text beyond two lines is cut off.
    """
    spawn = find_spawn(volume)
    found = _on_a_wall(volume, spawn) or _on_the_floor(volume, spawn)
    if found is None:
        return volume
    cell, state = found
    states, palette = volume.states.copy(), volume.palette
    if state not in palette:
        palette = (*palette, state)
    states[cell] = palette.index(state)
    x, y, z = (int(a + b) for a, b in zip(cell, volume.corner, strict=True))
    entity = sign_entity((x, y, z), *_text(volume, name))
    return replace(
        volume,
        states=states,
        palette=palette,
        block_entities=(*volume.block_entities, entity),
    )


def _text(volume: BlockVolume, name: str) -> tuple[list[str], str]:
    """Return the lines of the sign and the command of a click on it."""
    if volume.blocks_per_metre < LARGER:
        return wrap_sign_text(name, 4), ""
    lines = wrap_sign_text(name, 2)
    return [*lines, *[""] * (2 - len(lines)), "Click: your size", "and back"], TOGGLE


def _on_a_wall(volume: BlockVolume, spawn: Spawn) -> tuple[tuple[int, int, int], str] | None:
    """Return the best cell and state of a sign on a wall at eye height, or None."""
    level = int(spawn.position[1]) - volume.corner[1] + 1
    if not 1 <= level < volume.states.shape[1]:
        return None
    free, walls = _free(volume), _walls(volume)
    air = volume.states == volume.palette.index(AIR)
    best: tuple[float, tuple[int, int, int], str] | None = None
    for number, facing in enumerate(_FACINGS):
        dx, _, dz = STEPS[number]
        for x, z in np.argwhere(free[:, level] & free[:, level - 1]).tolist():
            back, front = (x - dx, level, z - dz), (x + dx, level, z + dz)
            if not (_holds(walls, back) and _holds(free, front)) or not air[x, level, z]:
                continue
            cost = _cost(free, spawn, volume, (x, level, z), (dx, dz))
            if cost is not None and (best is None or (cost, (x, level, z)) < best[:2]):
                best = cost, (x, level, z), WALL_SIGN.format(facing)
    return None if best is None else (best[1], best[2])


def _on_the_floor(volume: BlockVolume, spawn: Spawn) -> tuple[tuple[int, int, int], str] | None:
    """Return the best cell and state of a standing sign, or None."""
    level = int(spawn.position[1]) - volume.corner[1]
    if not 1 <= level < volume.states.shape[1] - 1:
        return None
    free = _free(volume)
    carries = np.array([is_solid(s) and faces_of(s).full[UP] for s in volume.palette], bool)
    floor = carries[volume.states[:, level - 1]] & (volume.semantic[:, level - 1] > 0)
    floor &= volume.states[:, level] == volume.palette.index(AIR)
    best: tuple[float, tuple[int, int, int]] | None = None
    for x, z in np.argwhere(free[:, level] & free[:, level + 1] & floor).tolist():
        cost = _cost(free, spawn, volume, (x, level, z), None)
        if cost is not None and (best is None or (cost, (x, level, z)) < best):
            best = cost, (x, level, z)
    if best is None:
        return None
    x, _, z = best[1]
    dx = spawn.position[0] - volume.corner[0] - x - 0.5
    dz = spawn.position[2] - volume.corner[2] - z - 0.5
    # Rotation 0 looks south and grows clockwise: as the game's yaw, in sixteenths.
    yaw = np.degrees(np.arctan2(-dx, dz))
    return best[1], SIGN.format(int(np.rint(yaw / 22.5)) % 16)


def _free(volume: BlockVolume) -> np.ndarray:
    """Return the mask of cells of air and invisible light, bool [X, Y, Z]."""
    numbers = [i for i, state in enumerate(volume.palette) if state in (AIR, LIGHT)]
    return np.isin(volume.states, numbers)


def _walls(volume: BlockVolume) -> np.ndarray:
    """Return the mask of wall cells that can carry a sign, bool [X, Y, Z]."""
    solid = np.array([is_solid(s) and len(boxes_of(s)) == 1 for s in volume.palette], bool)
    return solid[volume.states] & (volume.semantic == SemanticClass.WALL)


def _holds(mask: np.ndarray, cell: tuple[int, int, int]) -> bool:
    inside = all(0 <= i < side for i, side in zip(cell, mask.shape, strict=True))
    return inside and bool(mask[cell])


def _cost(
    free: np.ndarray,
    spawn: Spawn,
    volume: BlockVolume,
    cell: tuple[int, int, int],
    facing: tuple[int, int] | None,
) -> float | None:
    """Return the cost of a sign position by distance and angle, or None if it is not visible."""
    eye = np.array(spawn.position) - volume.corner + [0, 1.0, 0]
    way = np.array(cell) + 0.5 - eye
    far = float(np.hypot(way[0], way[2]))
    if not NEAR <= far <= FAR:
        return None
    yaw = np.radians(spawn.yaw_deg)
    ahead = float((way[0] * -np.sin(yaw) + way[2] * np.cos(yaw)) / far)
    turned = 1.0 if facing is None else float(-(way[0] * facing[0] + way[2] * facing[1]) / far)
    if turned < 0.3 or not _sees(free, eye, way):
        return None
    return round(abs(far - BEST) + ASIDE * (1 - ahead) + ASIDE / 2 * (1 - turned), 6)


def _sees(free: np.ndarray, eye: np.ndarray, way: np.ndarray) -> bool:
    """Return whether all cells between the eye and a position are air."""
    steps = np.linspace(0, 1, max(2, int(np.linalg.norm(way) * 3)))[:-2]
    cells = np.floor(eye + steps[:, None] * way).astype(int)
    cells = np.clip(cells, 0, np.array(free.shape) - 1)
    return bool(free[tuple(cells.T)].all())
