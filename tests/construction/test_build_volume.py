import hashlib
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from build_samples import (
    CHAIR,
    FLOOR,
    FURN,
    OBJS,
    RED,
    VOXEL_M,
    WALL,
    WHITE,
    WINDOW,
    Sketch,
    furnished,
    l_room,
    placement,
)
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.construction import BuildParameters, build_volume
from world2minecraft.construction.shell_geometry import without_ragged_edges
from world2minecraft.core.coordinates import apply, invert, turn_grid
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.minecraft.block_states import check_state, complete, parse_state
from world2minecraft.minecraft.turn_and_mirror import turn_volume

BARE = BuildParameters(lights=False, edge="none")
SCALES = (1.0, 2.0, 3.3, 4.0, 6.25, 12.5, 20.0)


def build(sketch, scale=4.0, placements=(), parameters=None):
    return build_volume(
        sketch.grid(),
        placements,
        (),
        corner_m=sketch.corner_m,
        blocks_per_metre=scale,
        parameters=parameters,
    )


def centre_m(volume, mask):
    cells = np.argwhere(mask) + 0.5 + volume.corner
    return apply(volume.block_to_room, cells).mean(0)


def state_names(volume):
    return {volume.palette[i].partition("[")[0] for i in np.unique(volume.states)}


@pytest.mark.parametrize("scale", SCALES)
def test_the_room_is_not_mirrored(scale):
    """The chair stands at low x, low y of the room, the notch is at high x, high y."""
    volume = build(l_room(), scale)
    chair = centre_m(volume, volume.semantic == CHAIR)
    assert np.abs(chair[:2] - [0.32, 0.4]).max() <= 0.55 / scale + 0.1
    ground = 63 - volume.corner[1]
    room_to_block = invert(volume.block_to_room)
    inside = {"low x, low y": (0.6, 1.6), "high x, low y": (3.4, 0.5), "low x, high y": (0.6, 1.8)}
    for point in inside.values():
        x, _, z = np.floor(apply(room_to_block, np.array([*point, -0.01]))).astype(int)
        assert volume.states[x - volume.corner[0], ground, z - volume.corner[2]] > 0
    if scale >= 3:
        x, _, z = np.floor(apply(room_to_block, np.array([3.5, 1.7, -0.01]))).astype(int)
        assert volume.states[x - volume.corner[0], ground, z - volume.corner[2]] == 0


@pytest.mark.parametrize("scale", [3.125, 6.25, 12.5])
def test_turning_the_room_turns_its_world(scale):
    sketch = furnished((52, 24, 32))  # Whole blocks at each of these scales.
    grid = sketch.grid()
    turned = replace(
        grid,
        **{
            name: np.ascontiguousarray(turn_grid(getattr(grid, name), 1))
            for name in ("labels", "confidence", "colour", "source", "instance")
        },
    )
    first = build(sketch, scale, parameters=BARE)
    second = build_volume(
        turned,
        (),
        (),
        corner_m=np.array([0.0, sketch.size[0] * VOXEL_M]),
        blocks_per_metre=scale,
        parameters=BARE,
    )
    assert block_set(turn_volume(first, 1)) == block_set(second)


def block_set(volume):
    cells = np.argwhere(volume.states > 0)
    names = [volume.palette[i] for i in volume.states[tuple(cells.T)]]
    first = cells.min(0)
    return {(*cell, name) for cell, name in zip((cells - first).tolist(), names, strict=True)}


@pytest.mark.parametrize("scale", [1.0, 2.0, 4.0, 6.25])
def test_the_floor_is_one_flat_layer_without_holes(scale):
    sketch = Sketch()
    rng = np.random.default_rng(4)
    holes = rng.random(sketch.plan.shape) < 0.3
    sketch.labels[sketch.plan & holes, 0] = 255
    bumps = rng.random(sketch.plan.shape) < 0.05
    sketch.labels[sketch.plan & bumps, 1] = FLOOR
    volume = build(sketch, scale, parameters=BARE)
    floor = np.argwhere(volume.semantic == FLOOR)
    assert set((floor[:, 1] + volume.corner[1]).tolist()) == {63}
    covered = volume.states[:, 63 - volume.corner[1]] > 0
    x, z = int(4.0 * scale), int(2.0 * scale)
    assert covered[-volume.corner[0] :, -volume.corner[2] :][:x, :z].all()


@pytest.mark.parametrize("scale", [2.0, 4.0, 6.25])
def test_walls_are_straight_and_one_block_thick(scale):
    sketch = Sketch(ceiling=False)
    rng = np.random.default_rng(1)
    wall = sketch.at((-1, 0), (0, 25), (0, 30))
    moved = rng.random((25, 30)) < 0.4
    sketch.labels[wall][0][moved] = 255
    sketch.labels[PAD_X][moved] = WALL
    sketch.colour[PAD_X][moved] = WHITE
    volume = build(sketch, scale, parameters=BARE)
    inner = slice(-volume.corner[2], -volume.corner[2] + int(2.0 * scale))
    west = volume.semantic[: int(1 * scale) - volume.corner[0], :, inner] == WALL
    columns = np.unique(np.argwhere(west[:, 64 - volume.corner[1] :])[:, 0] + volume.corner[0])
    assert columns.tolist() == [-1]


PAD_X = (2, slice(2, 27), slice(1, 31))  # The first inner layer of cells beside the low-x wall.


def test_openings_stay_open_and_windows_are_glass():
    volume = build(furnished(), parameters=BARE)
    room_to_block = invert(volume.block_to_room)

    def at(point):
        index = np.floor(apply(room_to_block, np.array(point))).astype(int) - volume.corner
        return tuple(index)

    doorway = [at((4.03, 1.04, height)) for height in (0.1, 0.6, 1.2, 1.7)]
    assert all(volume.states[where] == 0 for where in doorway)
    assert volume.semantic[at((4.03, 0.3, 1.2))] == WALL
    window = at((2.1, -0.04, 1.4))
    assert volume.semantic[window] == WINDOW
    assert volume.palette[volume.states[window]] == (
        "minecraft:glass_pane[east=true,north=false,south=false,waterlogged=false,west=true]"
    )


@st.composite
def windows(draw):
    """A part of a wall of the sketch, which is not narrower than 3 cells."""
    axis, far = draw(st.sampled_from([0, 1])), draw(st.booleans())
    size = Sketch().size
    spans = []
    for length in (size[1 - axis], size[2]):
        start = draw(st.integers(0, length - 3))
        spans.append((start, draw(st.integers(start + 3, length))))
    depth = (size[axis], size[axis] + 1) if far else (-1, 0)
    return [depth, *spans] if axis == 0 else [spans[0], depth, spans[1]]


@given(windows(), st.sampled_from([1.0, 2.0, 4.0, 12.5]))
def test_rectangular_windows_are_rectangles_of_glass(window, scale):
    x, y, z = window
    sketch = Sketch().put(x, y, z, WINDOW, (180, 200, 210))
    volume = build(sketch, scale, parameters=BARE)
    glass = volume.semantic == WINDOW
    names = {volume.palette[state].partition("[")[0] for state in np.unique(volume.states[glass])}
    assert names <= {"minecraft:glass", "minecraft:glass_pane"}
    width = sorted(end - start for start, end in window)[1] * VOXEL_M * scale
    places = np.argwhere(glass)
    assert len(places) or width <= 1
    if len(places):
        assert len(places) == np.prod(np.ptp(places, axis=0) + 1)


def test_ragged_rows_at_the_edges_of_windows_are_wall():
    window = np.zeros((8, 1, 6), bool)
    window[1:7, 0, 1:5] = True
    ragged = window.copy()
    ragged[[1, 2, 6], 0, 5] = True  # Three of six blocks.
    ragged[0, 0, 3] = True
    assert np.array_equal(without_ragged_edges(ragged), window)
    assert np.array_equal(without_ragged_edges(window), window)
    two = np.zeros((8, 1, 6), bool)
    two[1:4, 0, 2], two[1, 0, 3] = True, True
    assert np.array_equal(without_ragged_edges(two), two), "too small to have edges"


def test_walls_have_no_specks_of_furniture_standing_elsewhere():
    cabinet = Sketch().put((20, 30), (8, 16), (0, 8), FURN, RED, instance=1)
    centre, size = np.array([25, 12, 4]) * VOXEL_M, np.array([10, 8, 8]) * VOXEL_M
    placed = [placement("cabinet", FURN, centre, size)]
    alone = build(cabinet, placements=placed, parameters=BARE)
    cabinet.put((-1, 0), (11, 17), (11, 14), FURN, RED, instance=1)
    volume = build(cabinet, placements=placed, parameters=BARE)
    assert (alone.instance == 1).any()
    assert np.array_equal(volume.instance == 1, alone.instance == 1)


@pytest.mark.parametrize("scale", [1.0, 2.0, 4.0, 12.5])
def test_every_state_is_complete_and_stands_by_itself(scale):
    volume = build(furnished(), scale)
    loose = ("sand", "gravel", "powder", "leaves", "torch", "carpet", "sapling", "ice", "coral")
    for state in volume.palette:
        parsed = check_state(parse_state(state))
        assert str(complete(parsed)) == state
        assert not any(word in parsed.name for word in loose)


def test_red_stays_red_under_its_dark_top_and_wood_is_wood():
    volume = build(furnished(), parameters=BARE)
    names = {}
    for number, height in ((2, 0.3), (2, 0.87), (1, 0.7)):
        layer = 64 - volume.corner[1] + int(height * 4)
        held = volume.states[:, layer][volume.instance[:, layer] == number]
        names[number, height] = {volume.palette[i].partition("[")[0] for i in held}
    assert all("red" in name for name in names[2, 0.3])
    assert any("black" in name or "deepslate" in name or "gray" in name for name in names[2, 0.87])
    shapes = ("planks", "slab", "wood", "trapdoor", "stairs")
    assert all(name.split("_")[-1] in shapes for name in names[1, 0.7])


def test_a_noisy_wall_is_calm():
    sketch = Sketch()
    rng = np.random.default_rng(3)
    walls = sketch.labels == WALL
    noise = rng.normal(0, 14, (int(walls.sum()), 3))
    sketch.colour[walls] = np.clip(np.array([200, 196, 190]) + noise, 1, 255).astype(np.uint8)
    volume = build(sketch, parameters=BARE)
    upper = slice(64 - volume.corner[1], None)
    walls = volume.states[:, upper][volume.semantic[:, upper] == WALL]
    counts = np.bincount(walls)
    assert counts.max() > 0.95 * counts.sum()


def test_a_picture_flush_on_the_wall_is_seen_there():
    sketch = Sketch().put((20, 30), (25, 26), (12, 20), OBJS, RED, 3)
    volume = build(sketch, parameters=BARE)
    cells = np.argwhere(volume.instance == 3)
    assert set((cells[:, 2] + volume.corner[2]).tolist()) == {-1}
    assert all("red" in volume.palette[i] for i in volume.states[volume.instance == 3])


def test_the_edge_of_an_unseen_wall_is_safe():
    volume = build(Sketch(walls=False, ceiling=False))
    assert "minecraft:barrier" in state_names(volume)
    barrier = volume.palette.index("minecraft:barrier")
    assert set(volume.semantic[volume.states == barrier].tolist()) == {0}
    bare = build(Sketch(walls=False, ceiling=False), parameters=BARE)
    assert state_names(bare) <= {"minecraft:air", *state_names(volume)} - {"minecraft:barrier"}


def test_without_a_ceiling_one_looks_in_from_above():
    volume = build(furnished(), parameters=BuildParameters(ceiling=False))
    assert not (volume.semantic == 1).any()
    assert (build(furnished()).semantic == 1).any()


@pytest.mark.parametrize("scale", [2.0, 4.0])
def test_a_placement_is_built_once_and_in_its_place(scale):
    sketch = Sketch()
    table = placement("dining_table", 8, (2.0, 1.0, 0.375), (0.75, 1.5, 0.75))
    volume = build(sketch, scale, [table], replace(BARE, most_contradicted=1.0))
    middle = centre_m(volume, volume.instance == 1)
    assert np.abs(middle[:2] - [2.0, 1.0]).max() <= 0.51 / scale
    assert set(volume.semantic[volume.instance == 1].tolist()) == {8}


def test_an_object_seen_elsewhere_is_not_replaced_by_a_poor_box():
    """A guessed template whose blocks stand in free space gives way to the object's own cells."""
    sketch = Sketch().put((10, 12), (4, 20), (0, 20), FURN, RED, 1)
    wrong = placement("wardrobe", 10, (1.6, 0.96, 0.8), (1.6, 1.3, 1.6))
    wrong = replace(wrong, iou=0.2)
    volume = build(sketch, 4.0, [wrong], BARE)
    blocks = int((volume.instance == 1).sum())
    assert blocks <= 2 * 6 * 7


def test_blocks_do_not_depend_on_the_hash_seed():
    code = (
        "import sys, hashlib; sys.path.insert(0, sys.argv[1]);"
        "from build_samples import furnished;"
        "from world2minecraft.construction import build_volume;"
        "s = furnished(); v = build_volume(s.grid(), (), (), corner_m=s.corner_m);"
        "d = hashlib.sha256(v.states.tobytes() + repr(v.palette).encode());"
        "print(d.hexdigest())"
    )
    run = subprocess.run(
        [sys.executable, "-c", code, str(Path(__file__).parent)],
        env={**os.environ, "PYTHONHASHSEED": "77", "NUMBA_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    sketch = furnished()
    volume = build_volume(sketch.grid(), (), (), corner_m=sketch.corner_m)
    digest = hashlib.sha256(volume.states.tobytes() + repr(volume.palette).encode())
    assert run.stdout.strip() == digest.hexdigest()


def test_a_room_of_unknown_corner_takes_its_own():
    sketch = Sketch()
    known = build(sketch, parameters=BARE)
    guessed = build_volume(sketch.grid(), (), (), parameters=BARE)
    assert guessed.corner == known.corner
    assert np.array_equal(guessed.states, known.states)


def test_what_cannot_be_built_is_refused():
    grid = Sketch().grid()
    with pytest.raises(UsageError, match="blocks_per_metre must be above 0, got -1; try 4"):
        build_volume(grid, (), (), blocks_per_metre=-1)
    with pytest.raises(UsageError, match="use fewer, such as 2 .--blocks-per-metre 2."):
        build_volume(grid, (), (), blocks_per_metre=900)
    with pytest.raises(UnknownNameError, match="no palette is named 'vanila'; did you mean"):
        build_volume(grid, (), (), parameters=BuildParameters(palette="vanila"))
    with pytest.raises(UsageError, match="build.edge must be barrier or none, got 'wall'"):
        BuildParameters(edge="wall")
    with pytest.raises(UsageError, match="build.object_share must be above 0 and at most 1, got 0"):
        BuildParameters(object_share=0)
