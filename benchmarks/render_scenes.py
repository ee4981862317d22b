"""Scenes, poses and timing for the checks and benchmarks of the renderer.

``room(scale)`` is a furnished living room that was processed by find, furnish and build;
``storeys(...)`` is a block of flats of any size, filled with furniture of many boxes: ``small()``
has 60 x 40 x 60 cells, ``large()`` 256 x 64 x 256. ``random_models(seed)`` is a volume of random
models, rotated, flat, hollow or perforated, with the looks ``RandomLooks(seed)``. ``time_all``
measures several renderers alternately, so that the load of the machine affects all of them equally;
the fastest round counts, and the slowest shows the spread.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from world2minecraft.construction import build_volume
from world2minecraft.core.coordinates import apply, block_to_room, look_at
from world2minecraft.core.types import BlockVolume, Camera, OccupancyGrid
from world2minecraft.procgen import generate_room
from world2minecraft.reconstruction.instances import InstanceParameters, find_objects
from world2minecraft.reconstruction.retrieval import RetrievalParameters, place_templates
from world2minecraft.rendering.block_elements import (
    BlockModel,
    Element,
    ElementFace,
    ModelSource,
    face_uv,
)
from world2minecraft.rendering.block_models.builtin import BuiltinModels
from world2minecraft.rendering.texture import Texture

KINDS = 24
NAMES = ("solid", "holes", "glass", "frame")
SIDE_PX = 16
AXIS_TURNS_DEG = (-45.0, -22.5, 22.5, 45.0, 90.0)


class RandomLooks:
    """Models of the states ``odd:0`` to ``odd:23``; the textures ``solid holes glass frame``."""

    def __init__(self, seed: int = 0):
        rng = np.random.default_rng(seed)
        solid = rng.integers(40, 255, (SIDE_PX, SIDE_PX, 4)).astype(np.uint8)
        solid[..., 3] = 255
        holes, glass, frame = solid.copy(), solid.copy(), solid.copy()
        holes[..., 3] = np.where(rng.random((SIDE_PX, SIDE_PX)) < 0.4, 0, 255)
        glass[..., 3] = 90
        frame[2:-2, 2:-2, 3] = 0
        self._textures = {
            "solid": Texture(solid),
            "holes": Texture(holes),
            "glass": Texture(glass, translucent=True),
            "frame": Texture(frame),
        }
        self._models = {f"odd:{n}": BlockModel(_elements(n, rng)) for n in range(KINDS)}

    def model(self, state: str) -> BlockModel | None:
        """Return a state's model."""
        return self._models.get(state)

    def texture(self, name: str) -> Texture | None:
        """Return a texture."""
        return self._textures.get(name)


def random_models(seed: int, shape: tuple[int, int, int] = (9, 8, 10), share: float = 0.25):
    """Return a volume with a ``share`` of its cells filled with any of the odd states."""
    rng = np.random.default_rng([seed, 1])
    states = np.where(rng.random(shape) < share, rng.integers(1, KINDS + 1, shape), 0)
    return BlockVolume(
        states=states.astype(np.uint16),
        palette=("minecraft:air", *(f"odd:{n}" for n in range(KINDS))),
        semantic=np.where(states > 0, 10, 0).astype(np.uint8),
        instance=states.astype(np.uint16),
        corner=(-3, 60, 5),
        block_to_room=block_to_room(np.array([0.5, 2.0]), 2.0),
    )


def _elements(number: int, rng: np.random.Generator) -> tuple[Element, ...]:
    """Return a full cube of each texture, then lists of boxes."""
    if number < len(NAMES):
        return (_box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0), NAMES[number], None, rng, 1.0),)
    return tuple(_random_box(rng) for _ in range(int(rng.integers(1, 6))))


def _random_box(rng: np.random.Generator) -> Element:
    """Return a box in sixteenths, now and then flat, turned or without some of its faces."""
    ends = np.sort(rng.integers(0, 17, (2, 3)), axis=0) / 16
    ends[1] = np.where(ends[1] == ends[0], np.minimum(ends[0] + 0.125, 1.0), ends[1])
    if rng.random() < 0.2:
        axis = rng.integers(3)
        ends[1, axis] = ends[0, axis]
    turn = None
    if rng.random() < 0.4:
        ends = 0.5 + (ends - 0.5) * 0.55  # So that it stays in its block whichever way it turns.
        turn = _turn(rng)
    name = NAMES[int(rng.integers(len(NAMES)))]
    shown = 1.0 if rng.random() < 0.7 else 0.6
    return _box(tuple(ends[0].tolist()), tuple(ends[1].tolist()), name, turn, rng, shown)


def _box(low, high, name: str, turn, rng: np.random.Generator, shown: float) -> Element:
    faces = tuple(
        ElementFace(name, face_uv(side, low, high, rotation_deg=90 * int(rng.integers(4))))
        if rng.random() < shown
        else None
        for side in range(6)
    )
    return Element(low, high, faces, turn)


def _turn(rng: np.random.Generator) -> np.ndarray:
    """Return a turn about the block's middle: about an axis as model files have it, or any."""
    from scipy.spatial.transform import Rotation

    if rng.random() < 0.5:
        axis = "xyz"[int(rng.integers(3))]
        turning = Rotation.from_euler(axis, float(rng.choice(AXIS_TURNS_DEG)), degrees=True)
    else:
        turning = Rotation.random(rng=rng)
    turn = np.eye(4)
    turn[:3, :3] = turning.as_matrix()
    turn[:3, 3] = 0.5 - turn[:3, :3] @ np.full(3, 0.5)
    return turn


ROUNDS = 2


class Timing(NamedTuple):
    """Milliseconds a picture, the mean over the poses of a round."""

    cpu_ms: float  # the least round's
    most_cpu_ms: float
    wall_ms: float  # the least

    @property
    def spread(self) -> float:
        """How much more the slowest round took than the fastest, as a share."""
        return self.most_cpu_ms / self.cpu_ms - 1


def time_all(
    works: Mapping[str, Callable[[np.ndarray], object]],
    poses: Sequence[np.ndarray],
    rounds: int = ROUNDS,
) -> dict[str, Timing]:
    """Return the timing of each work, called once a pose and round; one call warms it up."""
    spent: dict[str, list[tuple[float, float]]] = {name: [] for name in works}
    for work in works.values():
        work(poses[0])
    for _ in range(rounds):
        for name, work in works.items():
            cpu, wall = time.process_time(), time.perf_counter()
            for pose in poses:
                work(pose)
            took = time.process_time() - cpu, time.perf_counter() - wall
            spent[name].append(took)
    return {name: _timing(rows, len(poses)) for name, rows in spent.items()}


def _timing(rows: list[tuple[float, float]], count: int) -> Timing:
    cpu, wall = 1000 * np.array(rows).T / count
    return Timing(float(cpu.min()), float(cpu.max()), float(wall.min()))


VERTICAL_FOV_DEG = 70.0
VOXEL_STEP = 3  # Of the 2 cm cells of the generator: 6 cm, which its origin is a multiple of.
STOREY, ROOM = 6, 12  # Blocks, floor to floor and wall to wall.
AIR, PLANKS, WALL, STONE, PANE_X, PANE_Z, LAMP = 0, 1, 2, 3, 4, 5, 6
PALETTE = (
    "minecraft:air",
    "minecraft:oak_planks",
    "minecraft:white_concrete",
    "minecraft:stone",
    "minecraft:glass_pane[east=true,north=false,south=false,waterlogged=false,west=true]",
    "minecraft:glass_pane[east=false,north=true,south=true,waterlogged=false,west=false]",
    "minecraft:sea_lantern",
    "minecraft:bookshelf",
    "minecraft:spruce_stairs[facing=east,half=bottom,shape=straight,waterlogged=false]",
    "minecraft:spruce_stairs[facing=north,half=bottom,shape=straight,waterlogged=false]",
    "minecraft:oak_slab[type=bottom,waterlogged=false]",
    "minecraft:birch_slab[type=top,waterlogged=false]",
    "minecraft:oak_fence[east=false,north=true,south=true,waterlogged=false,west=false]",
    "minecraft:chest[facing=south,type=single,waterlogged=false]",
    "minecraft:oak_trapdoor[facing=west,half=bottom,open=true,powered=false,waterlogged=false]",
    "minecraft:red_carpet",
    "minecraft:flower_pot",
    "minecraft:torch",
    "minecraft:light_blue_stained_glass",
)
FURNITURE = range(7, len(PALETTE))


def camera_of(width: int, height: int) -> Camera:
    """Return a camera with the vertical field of view that all figures are taken with."""
    focal_px = height / 2 / np.tan(np.radians(VERTICAL_FOV_DEG / 2))
    return Camera(width, height, focal_px, focal_px, width / 2, height / 2)


@lru_cache(maxsize=4)
def room(scale: float, seed: int = 1, kind: str = "living", style: str = "blocks") -> BlockVolume:
    """Return a generated room, built at ``scale`` blocks a metre by the stages themselves."""
    from world2minecraft.construction.parameters import BuildParameters

    made = generate_room(seed, kind=kind)
    step = slice(VOXEL_STEP // 2, None, VOXEL_STEP)
    labels = np.ascontiguousarray(made.labels[step, step, step])
    grid = OccupancyGrid(
        labels=labels,
        confidence=np.ones(labels.shape, np.float16),
        colour=np.ascontiguousarray(made.colour[step, step, step]),
        source=np.ones(labels.shape, np.uint8),
        instance=np.zeros(labels.shape, np.uint16),
        voxel_m=made.voxel_m * VOXEL_STEP,
        origin_m=made.origin_m,
    )
    found = find_objects(grid, InstanceParameters())
    placements = place_templates(found.grid, found.instances, RetrievalParameters())
    return build_volume(
        found.grid,
        placements,
        found.instances,
        corner_m=np.array([0.0, float(made.size_m[1])]),
        blocks_per_metre=scale,
        parameters=BuildParameters(style=style),
    )


def small() -> BlockVolume:
    """Return 60 x 40 x 60 cells, some 45,000 of them filled."""
    return storeys((60, 40, 60), ground=0, furnished=0.1)


@lru_cache(maxsize=1)
def large() -> BlockVolume:
    """Return 256 x 64 x 256 cells, some 1.8 million of them filled."""
    return storeys((256, 64, 256), ground=8, furnished=0.2)


def storeys(
    shape: tuple[int, int, int], *, ground: int, furnished: float, seed: int = 0
) -> BlockVolume:
    """Return flats: floors, walls with doorways and windows, lamps, furniture.

    Args:
        shape: cells along x, y (up) and z.
        ground: layers of stone at the bottom.
        furnished: the share of the floor that has something on it.
        seed: of what stands where.
    """
    rng = np.random.default_rng(seed)
    states = np.zeros(shape, np.uint16)
    states[:, :ground] = STONE
    for floor in range(ground, shape[1], STOREY):
        _put_storey(states, floor, furnished, rng)
    filled = states > 0
    return BlockVolume(
        states=states,
        palette=PALETTE,
        semantic=np.where(filled, 10, 0).astype(np.uint8),
        instance=np.where(filled, states, 0).astype(np.uint16),
        corner=(0, 64, 0),
        block_to_room=block_to_room(np.array([0.0, float(shape[2])]), 1.0),
    )


def _put_storey(states: np.ndarray, floor: int, furnished: float, rng: np.random.Generator) -> None:
    """Fill one storey: its floor, then what stands, then walls and what is in them."""
    states[:, floor] = PLANKS
    rooms = states[:, floor + 1 : floor + STOREY]
    if rooms.shape[1] < STOREY - 1:  # The roof's remainder stays open.
        return
    wide, high, deep = rooms.shape
    things = rng.choice(np.array(FURNITURE), (wide, 2, deep))
    stands = rng.random((wide, 2, deep)) < furnished
    stands[:, 1] &= stands[:, 0] & (rng.random((wide, deep)) < 0.5)  # Some things are two high.
    rooms[:, :2] = np.where(stands, things, AIR)
    for at in range(0, wide, ROOM):
        rooms[at] = WALL
    for at in range(0, deep, ROOM):
        rooms[:, :, at] = WALL
    rooms[-1], rooms[:, :, -1] = WALL, WALL
    middles = np.arange(ROOM // 2, max(wide, deep), ROOM)
    for x in middles[middles < wide]:
        rooms[x : x + 2, :3, ROOM : deep - ROOM : ROOM] = AIR  # Doorways.
        rooms[x - 3 : x + 3, 1:4, 0] = rooms[x - 3 : x + 3, 1:4, -1] = PANE_X
        for z in middles[middles < deep]:
            rooms[x, high - 1, z] = LAMP
    for z in middles[middles < deep]:
        rooms[ROOM : wide - ROOM : ROOM, :3, z : z + 2] = AIR
        rooms[0, 1:4, z - 3 : z + 3] = rooms[-1, 1:4, z - 3 : z + 3] = PANE_Z


def scene_looks() -> ModelSource:
    """Return where the models and textures of these scenes come from: the renderer's own."""
    return BuiltinModels()


def poses(
    volume: BlockVolume,
    count: int,
    seed: int,
    *,
    looks: ModelSource | None = None,
    inside: bool = False,
) -> list[np.ndarray]:
    """Return cameras that stand indoors: a block lies above and below each.

    Args:
        volume: the scene.
        count: how many.
        seed: of where they stand and look: any way, 25 degrees down to 10 up.
        looks: tell which blocks fill their cell only in part.
        inside: whether they stand in cells of furniture in place of free ones.

    Returns:
        Poses, float64 [4, 4], camera to room.
    """
    rng = np.random.default_rng(seed)
    filled = volume.states > 0
    below = np.maximum.accumulate(filled, axis=1)
    above = np.maximum.accumulate(filled[:, ::-1], axis=1)[:, ::-1]
    indoors = below & above
    indoors &= _partly(volume, looks or scene_looks()) if inside else ~filled
    cells = np.argwhere(indoors)
    found = []
    for cell in cells[rng.integers(len(cells), size=count)]:
        eye = cell + volume.corner + rng.uniform(0.2, 0.8, 3)
        yaw, pitch = rng.uniform(0, 2 * np.pi), np.radians(rng.uniform(-25, 10))
        ahead = np.array([np.cos(yaw) * np.cos(pitch), np.sin(pitch), np.sin(yaw) * np.cos(pitch)])
        ends = apply(volume.block_to_room, np.stack([eye, eye + ahead]))
        found.append(look_at(ends[0], ends[1]))
    return found


def _partly(volume: BlockVolume, looks: ModelSource) -> np.ndarray:
    """Tell, bool [X, Y, Z], which cells hold more or less than one cube."""
    partly = np.zeros(len(volume.palette), bool)
    for row, state in enumerate(volume.palette):
        model = looks.model(state)
        ends = [(one.low, one.high) for one in model.elements] if model else []
        partly[row] = bool(ends) and ends != [((0, 0, 0), (1, 1, 1))]
    return partly[volume.states]
