"""Houses: storeys over one another, doorways one walks through, light and floors on each."""

from dataclasses import replace

import numpy as np
import pytest
from build_samples import Sketch
from house_samples import DOOR, UPPER, VOXEL_M, house
from scipy import ndimage

from world2minecraft.construction import build_volume
from world2minecraft.construction.block_lattice import lattice_over
from world2minecraft.construction.doorways import find_gaps
from world2minecraft.construction.lighting import MIN_LIGHT
from world2minecraft.construction.spawn import find_spawn
from world2minecraft.construction.storeys import add_storeys, upper_floors_m
from world2minecraft.core.coordinates import apply, invert
from world2minecraft.minecraft.rules.light import block_light

CEILING, FLOOR, WALL = 1, 2, 3
SCALES = [1.0, 2.0, 4.0]


def built(scale, shift=0):
    return build_volume(house(shift), (), (), corner_m=np.array([0.0, 4.0]), blocks_per_metre=scale)


def ground_of(volume, scale, storey):
    return 64 - volume.corner[1] + (round(2.8 * scale) if storey else 0)


def plan_of(volume, scale, storey):
    """Return where a player stands on a storey, bool [X, Z], as far as walls and floors go."""
    ground = ground_of(volume, scale, storey)
    high = max(2, round(1.7 * scale))
    walls = np.isin(volume.semantic[:, ground : ground + high], (WALL, 4)).any(1)
    return (volume.semantic[:, ground - 1] == FLOOR) & ~walls


def column_of(volume, x_m, y_m):
    at = apply(invert(volume.block_to_room), np.array([[x_m, y_m, 0.0]]))[0] - volume.corner
    return int(np.floor(at[0])), int(np.floor(at[2]))


def test_storeys_are_told_from_level_floors():
    assert upper_floors_m(house()) == [pytest.approx(UPPER * VOXEL_M)]
    assert upper_floors_m(Sketch().grid()) == []
    lattice = add_storeys(lattice_over(house(), np.array([0.0, 4.0]), 4.0), house())
    assert lattice.upper == (lattice.ground + 11,)
    assert lattice.ground_under(lattice.ground + 10.5) == lattice.ground + 11
    assert lattice.ground_under(lattice.ground + 5.0) == lattice.ground


def test_a_podium_is_no_storey():
    grid = Sketch((50, 40, 30)).put((0, 20), (0, 20), (3, 4), FLOOR, (90, 90, 90)).grid()
    assert upper_floors_m(grid) == []


@pytest.mark.parametrize("scale", SCALES)
def test_each_storey_has_its_floor_and_the_stairwell_is_open(scale):
    volume = built(scale)
    for storey in (0, 1):
        assert plan_of(volume, scale, storey).sum() >= 0.6 * 6.4 * 4 * scale**2
    x, z = column_of(volume, 5.0, 3.3)
    assert volume.semantic[x, ground_of(volume, scale, 1) - 1, z] != FLOOR
    x, z = column_of(volume, 1.5, 1.5)
    assert volume.semantic[x, ground_of(volume, scale, 1) - 1, z] == FLOOR


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("shift", [0, 3, 5])
def test_one_walks_through_the_doorway_at_every_scale_and_phase(scale, shift):
    volume = built(scale, shift)
    parts, _ = ndimage.label(plan_of(volume, scale, 0))
    left, right = column_of(volume, 1.0, 1.0), column_of(volume, 4.0, 1.0)
    assert parts[left] == parts[right] > 0


def test_a_wall_without_a_doorway_stays_shut():
    grid = house()
    labels = grid.labels.copy()
    labels[40, slice(*DOOR), 1:27] = WALL
    shut = build_volume(replace(grid, labels=labels), (), (), corner_m=np.array([0.0, 4.0]))
    parts, _ = ndimage.label(plan_of(shut, 4.0, 0))
    assert parts[column_of(shut, 1.0, 1.0)] != parts[column_of(shut, 4.0, 1.0)]


def test_gaps_are_found_where_they_are_and_a_corridor_is_none():
    grid = house()
    free = grid.labels == 0
    (gap,) = find_gaps(grid, free, 0.0)
    assert gap.axis == 1 and gap.along == DOOR and gap.across == (40, 41)
    assert find_gaps(grid, free, 2.8) == []
    corridor = Sketch((60, 14, 30)).grid()
    assert find_gaps(corridor, corridor.labels == 0, 0.0) == []


def dead_end() -> Sketch:
    """A corridor 1.2 m wide, at whose shut end doorways lead into the rooms at its sides."""
    sketch = Sketch((70, 60, 30))
    for y in (20, 36):
        sketch.put((0, 70), (y, y + 1), (0, 30), WALL, (230, 228, 224))
        sketch.put((3, 14), (y, y + 1), (0, 26), 0, 0)
    return sketch


@pytest.mark.parametrize("scale", SCALES)
def test_the_end_of_a_corridor_beside_doorways_stays_shut(scale):
    sketch = dead_end()
    grid = sketch.grid()
    gaps = find_gaps(grid, grid.labels == 0, 0.0)
    assert sorted(gap.axis for gap in gaps) == [0, 0]
    volume = build_volume(grid, (), (), corner_m=sketch.corner_m, blocks_per_metre=scale)
    x, _ = column_of(volume, -0.01, 2.3)
    _, z = column_of(volume, 1.0, 2.3)
    ground = 64 - volume.corner[1]
    assert (volume.semantic[x, ground : ground + round(2 * scale), z] == WALL).all()


@pytest.mark.parametrize("scale", [2.0, 4.0])
@pytest.mark.parametrize("shift", range(6))
def test_a_pillar_near_a_wall_is_no_doorway_s_jamb(scale, shift):
    sketch = Sketch((50, 40, 30))
    sketch.put((12 + shift, 17 + shift), (10, 15), (0, 30), WALL, (230, 228, 224))
    volume = build_volume(sketch.grid(), (), (), corner_m=sketch.corner_m, blocks_per_metre=scale)
    middle = np.array(column_of(volume, (14.5 + shift) * 0.08, 12.5 * 0.08))
    near = np.ix_(*(np.arange(at - 1, at + 2) for at in middle))
    ground = 64 - volume.corner[1]
    assert (volume.semantic[:, ground + 2][near] == WALL).any()


def test_walls_of_both_storeys_stand_over_one_another():
    volume = built(4.0)
    for storey in (0, 1):
        ground = ground_of(volume, 4.0, storey)
        ring = (volume.semantic[:, ground + 2 : ground + 8] == WALL).all(1)
        assert ring.sum() >= 0.9 * 2 * (26 + 16)
    low, high = ((volume.semantic[:, ground_of(volume, 4.0, s) + 4] == WALL).any(1) for s in (0, 1))
    assert np.array_equal(np.flatnonzero(low)[[0, -1]], np.flatnonzero(high)[[0, -1]])


@pytest.mark.parametrize("scale", SCALES)
def test_every_place_on_every_storey_is_lit(scale):
    volume = built(scale)
    light = block_light(volume)
    free = (volume.semantic == 0) & (light >= 0)
    for storey in (0, 1):
        ground = ground_of(volume, scale, storey)
        stands = plan_of(volume, scale, storey) & free[:, ground] & free[:, ground + 1]
        inner = ndimage.binary_erosion(stands)
        assert inner.any() and light[:, ground][inner].min() >= MIN_LIGHT


@pytest.mark.parametrize("scale", SCALES)
def test_the_player_comes_to_stand_inside_on_the_ground(scale):
    volume = built(scale)
    x, y, z = find_spawn(volume).position
    room = apply(volume.block_to_room, np.array([[x, y, z]]))[0]
    assert 0 < room[0] < 6.4 and 0 < room[1] < 4.0 and room[2] == pytest.approx(0.0)


def test_stairs_rise_by_a_block_at_most():
    volume = built(4.0)
    x0, z = column_of(volume, 3.7, 3.3)
    tops = []
    for x in range(x0, x0 + 9):
        filled = np.flatnonzero(volume.instance[x, :, z] == 1)
        tops.append(int(filled.max()) if len(filled) else 0)
    rises = np.diff([top for top in tops if top])
    assert len(rises) >= 6 and rises.min() >= 0 and rises.max() <= 2
