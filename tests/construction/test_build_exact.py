import numpy as np
import pytest
from build_samples import VOXEL_M, furnished, l_room
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.construction import build_volume
from world2minecraft.core.coordinates import apply, cell_centers_m, invert
from world2minecraft.core.types import OccupancyGrid


def blocks_of_cells(grid, volume):
    """The slow reading: each occupied cell's centre, in metres, to the block that holds it."""
    room_to_block = invert(volume.block_to_room)
    found = {}
    for cell in np.argwhere(grid.occupied):
        at = apply(room_to_block, cell_centers_m(cell, grid.origin_m, grid.voxel_m))
        found[tuple(np.floor(at).astype(int) - volume.corner)] = int(grid.labels[tuple(cell)])
    return found


def iou(grid, volume):
    expected = blocks_of_cells(grid, volume)
    built = {tuple(cell.tolist()) for cell in np.argwhere(volume.semantic > 0)}
    return len(built & set(expected)) / len(built | set(expected))


@pytest.mark.parametrize("sketch", [l_room(), furnished()])
def test_one_voxel_one_block_is_exact(sketch):
    grid = sketch.grid()
    volume = build_volume(grid, (), (), corner_m=sketch.corner_m, blocks_per_metre=12.5)
    assert iou(grid, volume) == 1.0
    for at, label in blocks_of_cells(grid, volume).items():
        assert volume.semantic[at] == label
        assert volume.states[at] > 0


grids = st.integers(0, 2**31).flatmap(
    lambda seed: st.tuples(
        st.just(seed),
        st.tuples(*[st.integers(1, 9)] * 3),
        st.tuples(st.integers(-30, 30), st.integers(-30, 30), st.integers(-3, 3)),
        st.tuples(st.integers(-30, 30), st.integers(-30, 30)),
    )
)


@given(grids)
def test_any_grid_at_any_whole_phase_is_exact(case):
    seed, shape, origin, corner = case
    rng = np.random.default_rng(seed)
    labels = rng.choice(np.array([0, 0, 2, 3, 4, 8, 11, 255], np.uint8), shape)
    source = np.where(labels == 255, 0, 1).astype(np.uint8)
    colour = rng.integers(0, 256, (*shape, 3), np.uint8)
    zeros = np.zeros(shape, np.uint16)
    grid = OccupancyGrid(
        labels,
        source.astype(np.float16),
        colour,
        source,
        zeros,
        VOXEL_M,
        np.array(origin) * VOXEL_M,
    )
    corner_m = np.array(corner) * VOXEL_M
    volume = build_volume(grid, (), (), corner_m=corner_m, blocks_per_metre=1 / VOXEL_M)
    built = int((volume.semantic > 0).sum())
    expected = blocks_of_cells(grid, volume)
    assert built == len(expected)
    assert all(volume.semantic[at] == label for at, label in expected.items())


def test_the_room_s_corner_stands_at_block_0_64_0():
    sketch = l_room()
    volume = build_volume(sketch.grid(), (), (), corner_m=sketch.corner_m, blocks_per_metre=12.5)
    corner = apply(volume.block_to_room, np.array([0.0, 64.0, 0.0]))
    assert corner == pytest.approx([0.0, sketch.size[1] * VOXEL_M, 0.0], abs=1e-9)


def test_a_corner_off_the_voxels_is_snapped():
    sketch = l_room()
    corner_m = sketch.corner_m + np.array([0.0, 0.03])
    volume = build_volume(sketch.grid(), (), (), corner_m=corner_m, blocks_per_metre=12.5)
    assert iou(sketch.grid(), volume) == 1.0
