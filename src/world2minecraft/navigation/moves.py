"""Discrete moves: turns on the spot, and forward steps that succeed completely or not at all.

The body has the game's dimensions times the scene's scale. It climbs 0.6 and drops 3 of its units,
and, like the walk graph, never stands on furniture. With sliding, a blocked body continues along
the obstacle as in the game.

A step is divided into pieces shorter than the body, so that it cannot pass through blocks. For each
piece, only the end is checked: the body must fit there, or on top of the obstacle. Positions are
those of the feet in world blocks.
"""

import math
from typing import NamedTuple

import numpy as np

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.jit import njit
from world2minecraft.minecraft.physics.player_body import HEIGHT, STEP_HEIGHT, TOUCH, WIDTH
from world2minecraft.minecraft.physics.walk_graph import DROP, WET
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.types import MOVE_SETS, Move, MoveSet, Stance

SUBSTEP = 0.4  # Maximum length of the pieces of a step, relative to half the width of the body.
FIRST_FURNITURE, LAST_FURNITURE = 5, 10  # Classes of furniture, on which a body never stands.
_YAW_DIGITS = 6  # Of a yaw in degrees, so that opposite turns cancel exactly.


class BodySize(NamedTuple):
    """The dimensions of a body in blocks.

    Attributes:
        half: Half of the width.
        height: The height.
        climb: The maximum height of an upward step without a jump.
        drop: The maximum height of a downward step.
    """

    half: float
    height: float
    climb: float
    drop: float


@njit
def move_body(solid, corner, x, y, z, dx, dz, size, sliding):
    """Move a body along the ground, and return its feet and whether it was blocked.

    Without sliding, the body either covers the whole distance or stays in place.

    Args:
        solid: The ``Solid`` of a volume.
        corner: The world position of the volume's first cell as int64 [3].
        x: The x coordinate of the feet in world blocks.
        y: The y coordinate of the feet.
        z: The z coordinate of the feet.
        dx: The distance to move along x in blocks.
        dz: The distance to move along z in blocks.
        size: The ``BodySize``.
        sliding: Whether a blocked body continues along the obstacle.
    """
    pieces = max(1, int(np.ceil(np.sqrt(dx * dx + dz * dz) / (size.half * SUBSTEP))))
    px, pz = dx / pieces, dz / pieces
    here_x, here_y, here_z, stopped = x, y, z, False
    for _ in range(pieces):
        free, level = _ground_at(solid, corner, here_x, here_y, here_z, px, pz, size)
        if free:
            here_x, here_y, here_z = here_x + px, level, here_z + pz
            continue
        stopped = True
        if not sliding:
            return x, y, z, True
        for turn in range(2):  # Along the longer side first, as the game does.
            along_x = (turn == 0) == (abs(px) >= abs(pz))
            qx, qz = (px, 0.0) if along_x else (0.0, pz)
            free, level = _ground_at(solid, corner, here_x, here_y, here_z, qx, qz, size)
            if free:
                here_x, here_y, here_z = here_x + qx, level, here_z + qz
    return here_x, here_y, here_z, stopped


@njit
def _ground_at(solid, corner, x, y, z, px, pz, size):
    """Test a piece of a step, and return whether it succeeds and the height of the feet."""
    at_x, at_y, at_z = x + px - corner[0], y - corner[1], z + pz - corner[2]
    if px == 0.0 and pz == 0.0:
        return True, y
    top = _top_in(solid, at_x, at_y, at_z, size)
    level = at_y
    if top > at_y:
        if top - at_y > size.climb + TOUCH:
            return False, y
        level = top
        if _top_in(solid, at_x, level, at_z, size) > level:
            return False, y
        if _top_in(solid, x - corner[0], level, z - corner[2], size) > level:
            return False, y
    ground, kind = _under(solid, at_x, level, at_z, size)
    if level - ground > size.drop + TOUCH or kind == WET:
        return False, y
    if FIRST_FURNITURE <= kind <= LAST_FURNITURE and abs(ground - at_y) > TOUCH:
        return False, y
    return True, ground + corner[1]


@njit
def _top_in(solid, x, y, z, size):
    """Return the highest top in a body's box in grid coordinates, or -1e9 if it is empty."""
    nx, ny, nz = solid.kinds.shape
    low_x, high_x = x - size.half + TOUCH, x + size.half - TOUCH
    low_z, high_z = z - size.half + TOUCH, z + size.half - TOUCH
    low_y, high_y = y + TOUCH, y + size.height - TOUCH
    best = -1e9
    for i in range(max(0, int(np.floor(low_x))), min(nx - 1, int(np.floor(high_x))) + 1):
        # Fences reach half a block into the cell over them.
        for j in range(max(0, int(np.floor(low_y)) - 1), min(ny - 1, int(np.floor(high_y))) + 1):
            for k in range(max(0, int(np.floor(low_z))), min(nz - 1, int(np.floor(high_z))) + 1):
                kind = solid.kinds[i, j, k]
                if kind == 0:
                    continue
                for n in range(solid.start[kind], solid.start[kind + 1]):
                    b = solid.boxes[n]
                    if (
                        i + b[0] < high_x and i + b[3] > low_x
                        and j + b[1] < high_y and j + b[4] > low_y
                        and k + b[2] < high_z and k + b[5] > low_z
                    ):  # fmt: skip
                        best = max(best, j + b[4])
    return best


@njit
def _under(solid, x, y, z, size):
    """Return the highest top under a body's feet and its class, or -1e9 and 0 for none."""
    nx, ny, nz = solid.kinds.shape
    low_x, high_x = x - size.half + TOUCH, x + size.half - TOUCH
    low_z, high_z = z - size.half + TOUCH, z + size.half - TOUCH
    best, found = -1e9, 0
    for j in range(min(ny - 1, int(np.floor(y + TOUCH))), -1, -1):
        if j + 1.5 < max(best, y - size.drop) - TOUCH:
            break
        for i in range(max(0, int(np.floor(low_x))), min(nx - 1, int(np.floor(high_x))) + 1):
            for k in range(max(0, int(np.floor(low_z))), min(nz - 1, int(np.floor(high_z))) + 1):
                kind = solid.kinds[i, j, k]
                if kind == 0:
                    continue
                for n in range(solid.start[kind], solid.start[kind + 1]):
                    b = solid.boxes[n]
                    beside = (
                        i + b[0] >= high_x or i + b[3] <= low_x
                        or k + b[2] >= high_z or k + b[5] <= low_z
                    )  # fmt: skip
                    top = j + b[4]
                    if beside or top > y + TOUCH or top < best - TOUCH:
                        continue
                    label = int(solid.classes[i, j, k])
                    label = 0 if label == 255 else label
                    found = label if top > best + TOUCH else max(found, label)
                    best = max(best, top)
    return best, found


def apply_move(
    scene: VlnScene,
    stance: Stance,
    move: Move,
    move_set: str | MoveSet = "vlnce",
    *,
    sliding: bool = False,
) -> tuple[Stance, bool]:
    """Return the stance after a move, and whether the move collided.

    Args:
        scene: The scene.
        stance: The stance before the move.
        move: The move. STOP changes nothing.
        move_set: The move set or its name.
        sliding: Whether a blocked step continues along the obstacle instead of failing.

    Raises:
        UnknownNameError: If the move set is unknown.

    Example:
        >>> apply_move(scene, Stance(3.0, 65.0, 3.0), Move.LEFT)               # doctest: +SKIP
        (Stance(x=3.0, y=65.0, z=3.0, yaw_deg=-15.0, pitch_deg=0.0), False)
    """
    how = get_move_set(move_set)
    if move == Move.FORWARD:
        return _forward(scene, stance, forward_blocks(scene, how), sliding)
    if move == Move.STOP:
        return stance, False
    turn = how.turn_deg if move == Move.RIGHT else -how.turn_deg
    yaw_deg = wrap_yaw(stance.yaw_deg + turn)
    return Stance(stance.x, stance.y, stance.z, yaw_deg, stance.pitch_deg), False


def get_move_set(move_set: str | MoveSet) -> MoveSet:
    """Return a move set by its name.

    Raises:
        UnknownNameError: If the move set is unknown.
    """
    if isinstance(move_set, MoveSet):
        return move_set
    if move_set not in MOVE_SETS:
        raise UnknownNameError("move set", move_set, MOVE_SETS)
    return MOVE_SETS[move_set]


def forward_blocks(scene: VlnScene, move_set: MoveSet) -> float:
    """Return the length of a forward step in blocks, which is 1 if the move set defines none."""
    return move_set.forward_m * scene.blocks_per_metre or 1.0


def wrap_yaw(yaw_deg: float) -> float:
    """Normalise an angle to [-180, 180), rounded so that opposite turns cancel exactly."""
    return round((yaw_deg + 180.0) % 360.0 - 180.0, _YAW_DIGITS)


def heading_vector(yaw_deg: float) -> tuple[float, float]:
    """Return the horizontal unit vector (x, z) of a yaw."""
    return -math.sin(math.radians(yaw_deg)), math.cos(math.radians(yaw_deg))


def body_size(scene: VlnScene) -> BodySize:
    """Return the dimensions of the scene's body in blocks."""
    scale = scene.scale
    return BodySize(WIDTH * scale / 2, HEIGHT * scale, STEP_HEIGHT * scale, DROP * scale)


def _forward(scene: VlnScene, stance: Stance, length: float, sliding: bool) -> tuple[Stance, bool]:
    x, z = heading_vector(stance.yaw_deg)
    at_x, at_y, at_z, collided = move_body(
        scene.solid, scene.corner, stance.x, stance.y, stance.z,
        x * length, z * length, body_size(scene), sliding,
    )  # fmt: skip
    return Stance(at_x, at_y, at_z, stance.yaw_deg, stance.pitch_deg), collided
