import numpy as np
import pytest
from build_samples import Sketch, furnished, l_room

from world2minecraft.construction import BuildParameters, build_volume, find_spawn
from world2minecraft.construction.lighting import LEVEL, passes_light
from world2minecraft.construction.spawn import standing_cells
from world2minecraft.core.classes import OBJECT_CLASSES
from world2minecraft.minecraft.collision_shapes import boxes_of
from world2minecraft.minecraft.rules.light import block_light, spread_light

SKETCHES = {
    "furnished": furnished(),
    "l_room": l_room(),
    "unwalled": Sketch(walls=False, ceiling=False),
}
SCALES = (2.0, 4.0, 12.5)
UNSOLID = ("minecraft:air", "minecraft:light[level=15,waterlogged=false]")
each_case = pytest.mark.parametrize(
    "name,scale", [(name, scale) for name in SKETCHES for scale in SCALES]
)


def build(name, scale):
    sketch = SKETCHES[name]
    return build_volume(sketch.grid(), (), (), corner_m=sketch.corner_m, blocks_per_metre=scale)


def slow_light(sources, clear):
    """The reading of the game's rule: one less for each step, until nothing changes."""
    light = sources.astype(int)
    while True:
        padded = np.pad(light, 1)
        best = light.copy()
        for axis in range(3):
            for step in (-1, 1):
                moved = np.roll(padded, step, axis)[1:-1, 1:-1, 1:-1]
                best = np.maximum(best, np.where(clear, moved - 1, 0))
        if np.array_equal(best, light):
            return light
        light = best


@pytest.mark.parametrize("seed", range(5))
def test_light_spreads_as_the_game_s_does(seed):
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(2, 12, 3))
    clear = rng.random(shape) < 0.7
    sources = np.where(rng.random(shape) < 0.03, LEVEL, 0).astype(np.uint8)
    assert np.array_equal(spread_light(sources, clear), slow_light(sources, clear))


@each_case
def test_every_walkable_floor_cell_is_lit(name, scale):
    volume = build(name, scale)
    light = block_light(volume)[:, 64 - volume.corner[1]]
    standing = standing_cells(volume)
    assert standing.any()
    assert light[standing].min() >= 8


def test_a_dark_room_is_dark():
    sketch = furnished()
    volume = build_volume(
        sketch.grid(), (), (), corner_m=sketch.corner_m, parameters=BuildParameters(lights=False)
    )
    assert block_light(volume).max() == 0


@each_case
def test_a_player_stands_where_he_comes_into_the_world(name, scale):
    volume = build(name, scale)
    spawn = find_spawn(volume)
    feet = np.array(spawn.position)
    low, high = feet - np.array([0.3, 0, 0.3]), feet + np.array([0.3, 1.8, 0.3])
    assert feet[1] == 64.0
    for cell in np.argwhere(volume.states > 0):
        state = volume.palette[volume.states[tuple(cell)]]
        if state in UNSOLID:
            continue
        boxes = boxes_of(state).reshape(-1, 2, 3) + cell + volume.corner
        meets = ((boxes[:, 0] < high - 1e-9) & (boxes[:, 1] > low + 1e-9)).all(1)
        assert not meets.any()
    under = (feet - np.array([0, 0.5, 0]) - volume.corner).astype(int)
    assert volume.palette[volume.states[tuple(under)]] not in UNSOLID


@pytest.mark.parametrize("scale", [2.0, 4.0])
@pytest.mark.parametrize("name", ["furnished", "l_room"])
def test_the_player_looks_at_the_furniture(name, scale):
    volume = build(name, scale)
    spawn = find_spawn(volume)
    things = np.argwhere(np.isin(volume.semantic, OBJECT_CLASSES)) + 0.5 + volume.corner
    towards = (things.mean(0) - spawn.position)[[0, 2]]
    yaw = np.radians(spawn.yaw_deg)
    looks = np.array([-np.sin(yaw), np.cos(yaw)])
    assert looks @ towards / np.linalg.norm(towards) > np.cos(np.radians(30))


@each_case
def test_nobody_walks_into_the_void(name, scale):
    """From every place where one stands, each way on is floor or is blocked at feet or head."""
    volume = build(name, scale)
    ground = 64 - volume.corner[1]
    walks = np.isin(
        volume.states, [i for i, state in enumerate(volume.palette) if state in UNSOLID]
    )
    free = walks[:, ground] & walks[:, ground + 1]
    floor = ~walks[:, ground - 1]
    reached = standing_cells(volume) & free
    for axis in (0, 1):
        for step in (-1, 1):
            onto = np.roll(reached, step, axis)
            falls = onto & free & ~floor
            assert not falls.any()


@pytest.mark.parametrize("scale", [2.0, 4.0])
def test_panes_and_fences_join_as_the_game_joins_them(scale):
    volume = build("furnished", scale)
    steps = {"east": (1, 0), "west": (-1, 0), "south": (0, 1), "north": (0, -1)}
    cells = [
        cell
        for cell in np.argwhere(volume.states > 0)
        if "_pane[" in volume.palette[volume.states[tuple(cell)]]
        or "_fence[" in volume.palette[volume.states[tuple(cell)]]
    ]
    assert cells or scale == 2.0
    for x, y, z in cells:
        state = volume.palette[volume.states[x, y, z]]
        kind = "_pane" if "_pane[" in state else "_fence"
        for side, (dx, dz) in steps.items():
            other = volume.palette[volume.states[x + dx, y, z + dz]]
            full = np.array_equal(boxes_of(other), [[0, 0, 0, 1, 1, 1]])
            joins = (full and other != "minecraft:barrier") or f"{kind}[" in other
            assert (f"{side}=true" in state) == joins


def test_unsolid_blocks_let_light_through():
    palette = ("minecraft:air", "minecraft:stone", "minecraft:glass", "minecraft:barrier")
    assert passes_light(palette).tolist() == [True, False, True, True]
    assert passes_light(("minecraft:oak_slab[type=top]",)).all()
