"""The walkable graph of a volume: the places where a player can stand and the steps between them.

The player has the body of the game's player, multiplied by a scale that defaults to the volume's
blocks per metre: at 4 blocks per metre, a person of 1.8 m is 7.2 blocks high. The player walks up
steps of 0.6, can optionally jump 1.25, and drops at most 3, all multiplied by the scale. Steps lead
to the eight neighbouring columns without cutting corners. Closed doors and gates count as open,
except iron doors, which need a button or similar.

Each column of a grid has gaps in which a body fits. Their heights are in sixteenths of a block, as
in the game's shapes.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.jit import njit
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.collision_shapes import FULL_CUBE
from world2minecraft.minecraft.physics.collisions import BlockWorld
from world2minecraft.minecraft.physics.player_body import HEIGHT, STEP_HEIGHT, TOUCH, WIDTH

_OPENED = ("_door", "_fence_gate")
_LOCKED = ("minecraft:iron_door",)
HEIGHT_STEPS = 16  # Heights a block.
MAX_FLOORS = 16  # Standing places above each other in one column; towers have more.
SKY = np.iinfo(np.int32).max  # The ceiling of what is open above.
WET = 254  # The class of liquids: neither a way nor a ground.
_FULL = (1 << HEIGHT_STEPS) - 1
JUMP_HEIGHT = 1.25  # Blocks; the game's jump reaches 1.2522.
SLIM = 0.4  # Of a player's scale: where cluttered scans leave no floor, a camera still fits.
DROP = 3.0  # Blocks: from higher a fall hurts.
COARSE_M = 0.15  # Smaller blocks need no columns at their corners.
SPACING_M = 0.25  # Between columns, or finer where a body is narrower.
_LIQUIDS = ("minecraft:water", "minecraft:lava", "minecraft:fire")
_FURNITURE = (int(SemanticClass.CHAIR), int(SemanticClass.FURN))  # From the first to the last.


def is_door(state: str) -> bool:
    """Return whether a block state is a door or a gate of any kind, open or closed."""
    return state.partition("[")[0].endswith(_OPENED)


def is_shut(state: str) -> bool:
    """Return whether a block state is a closed door or gate that a player can open.

    Example:
        >>> is_shut("minecraft:oak_door[facing=west,half=lower,open=false]")
        True
    """
    locked = state.partition("[")[0] in _LOCKED
    return is_door(state) and not locked and "open=false" in state


def open_door(state: str) -> str:
    """Return the open state of a door or gate. Other states are returned unchanged."""
    return state.replace("open=false", "open=true") if is_shut(state) else state


def open_all_doors(volume: BlockVolume) -> BlockVolume:
    """Return a volume with all doors and gates open. The array of states is shared."""
    return replace(volume, palette=tuple(open_door(state) for state in volume.palette))


class CollisionGrid(NamedTuple):
    """The collision boxes of a volume in the form that the kernels use."""

    kinds: np.ndarray  # uint16 [X, Y, Z], shape index; shape 0 has no box.
    start: np.ndarray  # int32 [K + 1], index of the first box of each shape.
    boxes: np.ndarray  # float64 [B, 6], block units relative to the cell.
    classes: np.ndarray  # uint8 [X, Y, Z], semantic class; WET for liquids.
    is_full: np.ndarray  # bool [K]


class StepLimits(NamedTuple):
    """The maximum rise and drop of one step, in sixteenths of a block.

    ``step`` limits the depth of the ground beside a diagonal step.
    """

    climb: float
    drop: float
    step: float


class StandingPlaces(NamedTuple):
    """The gaps in C grid columns in which a body fits. Heights are in sixteenths of a block."""

    counts: np.ndarray  # int32 [C]
    floor: np.ndarray  # int32 [C, MAX_FLOORS]
    ceiling: np.ndarray  # int32 [C, MAX_FLOORS]
    ground: np.ndarray  # uint8 [C, MAX_FLOORS], semantic class of the block under the feet.


def find_standing_places(
    solid: CollisionGrid, columns: tuple[np.ndarray, np.ndarray], half: float, height: float
) -> StandingPlaces:
    """Find the gaps in which a body can stand, in each column of a volume.

    Args:
        solid: The collision boxes.
        columns: Positions of the columns along x and z, float64, in cells from the volume's corner.
        half: Half the width of the body, in blocks.
        height: Height of the body, in blocks.
    """
    xs, zs = columns
    count = len(xs) * len(zs)
    stands = StandingPlaces(
        np.zeros(count, np.int32),
        np.zeros((count, MAX_FLOORS), np.int32),
        np.zeros((count, MAX_FLOORS), np.int32),
        np.zeros((count, MAX_FLOORS), np.uint8),
    )
    need = int(np.ceil(height * HEIGHT_STEPS - 1e-6))
    if count:
        _fill(solid, xs, zs, half, need, stands)
    return stands


@njit
def _fill(solid, xs, zs, half, need, stands):
    masks = np.zeros(solid.kinds.shape[1] + 2, np.int32)
    for column in range(len(stands.counts)):
        x, z = xs[column // len(zs)], zs[column % len(zs)]
        box = (x - half + TOUCH, z - half + TOUCH, x + half - TOUCH, z + half - TOUCH)
        _mask(solid, box, masks)
        _gaps(solid, box, masks, need, column, stands)


@njit
def _mask(solid, box, masks):
    """Set bits in each layer's mask for the sixteenths in which a box meets an obstacle."""
    masks[:] = 0
    nx, ny, nz = solid.kinds.shape
    for i in range(max(0, int(np.floor(box[0]))), min(nx - 1, int(np.floor(box[2]))) + 1):
        for k in range(max(0, int(np.floor(box[1]))), min(nz - 1, int(np.floor(box[3]))) + 1):
            for j in range(ny):
                kind = solid.kinds[i, j, k]
                if kind == 0:
                    continue
                if solid.is_full[kind]:
                    masks[j] |= _FULL
                    continue
                mask = _cell_mask(solid, kind, box, i, k)
                masks[j] |= mask & _FULL
                masks[j + 1] |= mask >> HEIGHT_STEPS


@njit
def _cell_mask(solid, kind, box, i, k):
    """Return the sixteenths, from the bottom of the cell, in which a shape meets a box."""
    mask = 0
    for n in range(solid.start[kind], solid.start[kind + 1]):
        b = solid.boxes[n]
        if i + b[0] < box[2] and i + b[3] > box[0] and k + b[2] < box[3] and k + b[5] > box[1]:
            low = max(0, int(np.floor(b[1] * HEIGHT_STEPS + 1e-6)))
            top = int(np.ceil(b[4] * HEIGHT_STEPS - 1e-6))
            mask |= ((1 << max(top - low, 0)) - 1) << low
    return mask


@njit
def _gaps(solid, box, masks, need, column, stands):
    """Write the gaps of a column that are high enough and have a floor."""
    found, floor, is_free = 0, -1, True
    for j in range(len(masks)):
        mask = masks[j]
        if (mask == 0 and is_free) or (mask == _FULL and not is_free):
            continue
        for bit in range(HEIGHT_STEPS):
            if bool(mask >> bit & 1) != is_free:
                continue
            at = j * HEIGHT_STEPS + bit
            if not is_free:
                floor = at
            elif floor >= 0 and at - floor >= need:
                found = _add(solid, box, floor, at, column, found, stands)
            is_free = not is_free
    if is_free and floor >= 0:
        found = _add(solid, box, floor, SKY, column, found, stands)
    stands.counts[column] = found


@njit
def _add(solid, box, floor, ceiling, column, found, stands):
    ground = _ground(solid, box, floor)
    if ground == WET or found == MAX_FLOORS:
        return found
    stands.floor[column, found] = floor
    stands.ceiling[column, found] = ceiling
    stands.ground[column, found] = ground
    return found + 1


@njit
def _ground(solid, box, floor):
    """Return the largest semantic class below the feet of a body. Unknown counts as 0."""
    nx, ny, nz = solid.kinds.shape
    top, found = (floor - 1) // HEIGHT_STEPS, 0
    for i in range(max(0, int(np.floor(box[0]))), min(nx - 1, int(np.floor(box[2]))) + 1):
        for k in range(max(0, int(np.floor(box[1]))), min(nz - 1, int(np.floor(box[3]))) + 1):
            for j in range(max(0, top - 1), min(ny - 1, top) + 1):
                kind = solid.kinds[i, j, k]
                if kind == 0:
                    continue
                mask = _cell_mask(solid, kind, box, i, k)
                if mask >> (floor - 1 - j * HEIGHT_STEPS) & 1 and solid.classes[i, j, k] != 255:
                    found = max(found, int(solid.classes[i, j, k]))
    return found


class Edges(NamedTuple):
    """The steps from N places in compressed rows.

    The steps of place n are at indices ``start[n]`` to ``start[n + 1]``.
    """

    start: np.ndarray  # int64 [N + 1]
    to: np.ndarray  # int32 [E]
    length_m: np.ndarray  # float64 [E]


@dataclass(frozen=True)
class WalkRule:
    """Rules for walking. Lengths apply to a player of the game's size.

    ``scale`` defaults to the volume's blocks per metre. ``on_furniture`` allows standing on blocks
    labelled as furniture, such as chairs, and on beds. Unlabelled blocks can always be stood on.
    ``at_corners`` adds the columns in which a body touches the side of a block, where shortest
    paths turn. It has no effect if blocks are so small that the columns make little difference.
    """

    scale: float | None = None
    step: float = STEP_HEIGHT
    jump: bool = False
    drop: float = DROP
    on_furniture: bool = False
    opens_doors: bool = True
    at_corners: bool = False


@dataclass(frozen=True, eq=False)
class WalkGraph:
    """N standing places and E steps between them, in compressed rows.

    The steps of place n lead to ``edge_to[edge_start[n]:edge_start[n + 1]]``. Steps down may have
    no way back.
    """

    feet: np.ndarray  # float64 [N, 3], world block coordinates
    headroom: np.ndarray  # float64 [N], blocks above the feet; inf under the open sky.
    ground: np.ndarray  # uint8 [N], semantic class of the block under the feet.
    edge_start: np.ndarray  # int64 [N + 1]
    edge_to: np.ndarray  # int32 [E]
    edge_m: np.ndarray  # float64 [E], length in metres.
    scale: float  # The player's scale.
    blocks_per_metre: float
    spacing: float  # Maximum distance between columns, in blocks.

    def __len__(self) -> int:
        return len(self.feet)

    def nearest(self, position: np.ndarray | tuple[float, float, float]) -> int:
        """Return the index of the place nearest to a position in world block coordinates.

        Raises:
            ValueError: If the graph has no places.
        """
        if not len(self):
            raise ValueError("the walkable graph has no places to stand; check the volume")
        return int(((self.feet - np.asarray(position)) ** 2).sum(axis=1).argmin())

    def part(self, places: np.ndarray) -> "WalkGraph":
        """Return the subgraph of some places, in the given order, with the steps between them."""
        number = np.full(len(self), -1, np.int32)
        number[places] = np.arange(len(places))
        inside = (number[self.edge_from] >= 0) & (number[self.edge_to] >= 0)
        begins, ends = number[self.edge_from[inside]], number[self.edge_to[inside]]
        order = np.argsort(begins, kind="stable")
        counts = np.bincount(begins, minlength=len(places))
        return replace(
            self,
            feet=self.feet[places],
            headroom=self.headroom[places],
            ground=self.ground[places],
            edge_start=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
            edge_to=ends[order],
            edge_m=self.edge_m[inside][order],
        )

    @cached_property
    def edge_from(self) -> np.ndarray:
        """The index of the place at which each step starts, int32 [E]."""
        return np.repeat(np.arange(len(self), dtype=np.int32), np.diff(self.edge_start))

    @cached_property
    def edges(self) -> "Edges":
        """The steps of the graph in the form that the kernels use."""
        return Edges(self.edge_start, self.edge_to, self.edge_m)

    @cached_property
    def backward(self) -> "Edges":
        """The steps of the graph in reverse direction."""
        order = np.argsort(self.edge_to, kind="stable")
        counts = np.bincount(self.edge_to, minlength=len(self))
        start = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
        return Edges(start, self.edge_from[order], self.edge_m[order])


def walk_graph(volume: BlockVolume, rule: WalkRule | None = None) -> WalkGraph:
    """Build the walkable graph of a volume.

    Args:
        volume: The blocks. The space outside is air without a floor.
        rule: The rules for walking. The default is ``WalkRule()``.

    Example:
        >>> from world2minecraft.minecraft.physics.shortest_paths import shortest_path
        >>> graph = walk_graph(volume)                                  # doctest: +SKIP
        >>> path = shortest_path(graph, graph.nearest(spawn), goal)     # doctest: +SKIP
    """
    how = rule or WalkRule()
    scale = volume.blocks_per_metre if how.scale is None else how.scale
    width, height = WIDTH * scale, HEIGHT * scale
    per_block = columns_per_block(volume.blocks_per_metre, width)
    half = width / 2 if how.at_corners and 1 / volume.blocks_per_metre >= COARSE_M else None
    xs, zs = (_columns(volume.states.shape[axis], per_block, half) for axis in (0, 2))
    stands = find_standing_places(
        collision_grid(volume, how.opens_doors), (xs, zs), width / 2, height
    )
    if not how.on_furniture:
        stands = _drop_furniture(stands)
    deep = len(zs)
    column, level = np.nonzero(np.arange(stands.floor.shape[1]) < stands.counts[:, None])
    first = np.concatenate([[0], np.cumsum(stands.counts)]).astype(np.int64)
    climb = (JUMP_HEIGHT if how.jump else how.step) * scale * HEIGHT_STEPS + 1e-6
    limits = StepLimits(
        climb, how.drop * scale * HEIGHT_STEPS + 1e-6, how.step * scale * HEIGHT_STEPS + 1e-6
    )
    need = int(np.ceil(height * HEIGHT_STEPS - 1e-6))
    start, to = _steps(stands, first, deep, need, limits)
    feet = np.stack([xs[column // deep], np.zeros(len(column)), zs[column % deep]], axis=1)
    feet += np.array(volume.corner)
    feet[:, 1] += stands.floor[column, level] / HEIGHT_STEPS
    ceiling = stands.ceiling[column, level]
    rooms = np.where(ceiling == SKY, np.inf, (ceiling - stands.floor[column, level]) / HEIGHT_STEPS)
    origin = np.repeat(np.arange(len(feet)), np.diff(start))
    length_m = np.linalg.norm(feet[to] - feet[origin], axis=1) / volume.blocks_per_metre
    return WalkGraph(
        feet, rooms, stands.ground[column, level], start, to, length_m, scale,
        volume.blocks_per_metre, 1 / per_block,
    )  # fmt: skip


def _columns(count: int, per_block: int, half: float | None) -> np.ndarray:
    """Return the positions of columns along one side, float64, in cells."""
    even = 0.5 + np.arange(per_block * (count - 1) + 1 if count else 0) / per_block
    if half is None:
        return even
    touching = np.add.outer(np.arange(count + 1), [-half, half]).ravel()
    touching = touching[(touching > 0.5) & (touching < count - 0.5)]
    return np.unique(np.round(np.concatenate([even, touching]), 9))


def columns_per_block(blocks_per_metre: float, width: float) -> int:
    """Return the number of columns per block along one axis.

    The columns are at most about 0.25 m apart and no farther apart than the width of the body.
    """
    return max(1, round(1 / (SPACING_M * blocks_per_metre)), int(np.ceil(1 / width - 1e-6)))


def collision_grid(volume: BlockVolume, opens_doors: bool = True) -> CollisionGrid:
    """Return the collision boxes of a volume. Liquids are full blocks that cannot be stood on."""
    world = BlockWorld.of_volume(open_all_doors(volume) if opens_doors else volume)
    wet = np.array([state.startswith(_LIQUIDS) for state in volume.palette])[volume.states]
    shapes = [*world.shapes, FULL_CUBE]
    kinds = np.where(wet, len(shapes) - 1, world.kinds).astype(np.uint16)
    beds = np.array([state.partition("[")[0].endswith("_bed") for state in volume.palette])
    classes = np.where(beds[volume.states], int(SemanticClass.BED), volume.semantic)
    counts = [len(shape) for shape in shapes]
    full = [len(shape) == 1 and np.array_equal(shape, FULL_CUBE) for shape in shapes]
    return CollisionGrid(
        kinds,
        np.concatenate([[0], np.cumsum(counts)]).astype(np.int32),
        np.concatenate(shapes).astype(np.float64).reshape(-1, 6),
        np.where(wet, WET, classes).astype(np.uint8),
        np.array(full),
    )


def _drop_furniture(stands: StandingPlaces) -> StandingPlaces:
    """Remove the standing places on chairs, beds, sofas, tables, screens and furniture."""
    low, high = _FURNITURE
    there = np.arange(stands.floor.shape[1]) < stands.counts[:, None]
    stays = there & ~((stands.ground >= low) & (stands.ground <= high))
    order = np.argsort(~stays, axis=1, kind="stable")
    moved = [np.take_along_axis(part, order, axis=1) for part in stands[1:]]
    return StandingPlaces(stays.sum(axis=1).astype(np.int32), *moved)


@njit
def _steps(stands, first, deep, need, limits):
    """Return ``edge_start`` and ``edge_to`` of all standing places.

    ``first``, int64 [C + 1], is the index of the lowest place of each column. ``deep`` is the
    number of columns along z, and ``need`` is the height of the body in sixteenths.
    """
    count, floor, ceiling = stands.counts, stands.floor, stands.ceiling
    total = first[-1]
    start, to = np.zeros(total + 1, np.int64), np.empty(total * 8, np.int32)
    edges, wide = 0, len(count) // deep if deep > 0 else 0
    for column in range(len(count)):
        x, z = column // deep, column % deep
        for level in range(count[column]):
            low, high = floor[column, level], ceiling[column, level]
            for dx in range(-1, 2):
                for dz in range(-1, 2):
                    if (dx == 0 and dz == 0) or not (0 <= x + dx < wide and 0 <= z + dz < deep):
                        continue
                    other = column + dx * deep + dz
                    there = _step_target(stands, other, low, high, need, limits)
                    if there < 0:
                        continue
                    goal = floor[other, there]
                    lift, least = max(low, goal), min(low, goal) - limits.step
                    if dx != 0 and dz != 0:
                        one = _can_brush_past(stands, column + dz, lift, least, need)
                        two = _can_brush_past(stands, column + dx * deep, lift, least, need)
                        if not (one and two):
                            continue
                    to[edges] = first[other] + there
                    edges += 1
            start[first[column] + level + 1] = edges
    return start, to[:edges].copy()


@njit
def _step_target(stands, other, low, high, need, limits):
    """Return the level of another column to which one step leads, or -1 if there is none."""
    for n in range(stands.counts[other]):
        goal = stands.floor[other, n]
        lift = max(low, goal)
        if goal - low > limits.climb or low - goal > limits.drop:
            continue
        if high - lift >= need and stands.ceiling[other, n] - lift >= need:
            return n
    return -1


@njit
def _can_brush_past(stands, side, lift, least, need):
    """Return whether a body can pass the edge of a column diagonally without falling."""
    for n in range(stands.counts[side]):
        if least <= stands.floor[side, n] <= lift and stands.ceiling[side, n] - lift >= need:
            return True
    return False
