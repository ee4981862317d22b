"""A pixel's feature lands in the cell that its depth says, by the exporters' frustum arithmetic."""

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st
from room_frames import SHAPE, VOXEL_M, room_batch

from world2minecraft.core.coordinates import look_at
from world2minecraft.minecraftocc.labels.label_kernels import mark_in_frustum
from world2minecraft.networks.batch import OccInput
from world2minecraft.networks.layers.projection import lift_features, project_cells


def seen(seed, shape=(7, 9, 5), voxel_m=0.3, size=(13, 18)):
    """A camera anywhere about a small grid, with any lens."""
    rng = np.random.default_rng(seed)
    eye = rng.uniform(-0.5, 2.5, 3)
    pose = look_at(eye, rng.uniform(0, 2, 3))
    lens = np.array([[rng.uniform(6, 20), 0, 9.3], [0, rng.uniform(6, 20), 6.1], [0, 0, 1]])
    return OccInput(
        torch.rand(1, 3, *size),
        torch.from_numpy(lens)[None],
        torch.from_numpy(pose)[None],
        shape,
        voxel_m,
    )


@pytest.mark.parametrize("seed", range(6))
def test_lifting_is_that_of_a_loop(seed):
    inputs = seen(seed)
    rng = np.random.default_rng(seed)
    sides = {1: (13, 18), 2: (7, 9), 4: (4, 5), 8: (2, 3)}
    maps = {scale: rng.normal(size=(1, 3, *side)) for scale, side in sides.items()}
    found = lift_features(
        {scale: torch.tensor(one) for scale, one in maps.items()}, project_cells(inputs), (7, 9, 5)
    )
    to_camera = np.linalg.inv(inputs.camera_to_grid[0].numpy())
    lens = inputs.intrinsics[0].numpy()
    lit = 0
    for cell in np.ndindex(7, 9, 5):
        x, y, z = (to_camera @ [*((np.array(cell) + 0.5) * 0.3), 1])[:3]
        expected = np.zeros(3)
        if z > 1e-3:
            u, v = lens[0, 0] * x / z + lens[0, 2], lens[1, 1] * y / z + lens[1, 2]
            if 0 <= u < 18 and 0 <= v < 13:
                column, row = int(u), int(v)
                lit += 1
                expected = sum(
                    one[0, :, row // scale, column // scale] for scale, one in maps.items()
                )
        np.testing.assert_allclose(found[0, :, *cell].numpy(), expected, atol=1e-9)
    assert lit > 0 or seed == 0


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10_000))
def test_what_is_lifted_is_what_the_data_set_calls_in_view(seed):
    inputs = seen(seed)
    cells_to_camera = np.linalg.inv(inputs.camera_to_grid[0].numpy())
    cells_to_camera[:, :3] *= inputs.voxel_m
    lens = inputs.intrinsics[0].numpy()
    marked = np.empty(inputs.grid_shape, bool)
    flat = np.array([lens[0, 0], lens[1, 1], lens[0, 2], lens[1, 2]])
    mark_in_frustum(np.ascontiguousarray(cells_to_camera[:3]), flat, 18, 13, marked)
    assert np.array_equal(project_cells(inputs).inside[0].numpy().reshape(marked.shape), marked)


def test_a_pixels_feature_lands_where_its_depth_says():
    """Each pixel's number, lifted: found again in the cell that holds the pixel's point."""
    inputs, target = room_batch()
    height, width = inputs.image.shape[-2:]
    numbers = torch.arange(height * width).reshape(1, 1, height, width).double() + 1
    lifted = lift_features({1: numbers.expand(2, -1, -1, -1)}, project_cells(inputs), SHAPE)[
        :, 0
    ].numpy()
    rng = np.random.default_rng(0)
    near = hits = 0
    for _ in range(600):
        b, row, column = rng.integers(2), rng.integers(height), rng.integers(width)
        z = float(inputs.depth_m[b, row, column])
        lens, pose = inputs.intrinsics[b].numpy(), inputs.camera_to_grid[b].numpy()
        ray = [(column + 0.5 - lens[0, 2]) / lens[0, 0], (row + 0.5 - lens[1, 2]) / lens[1, 1], 1]
        place = (pose @ [*(np.array(ray) * z), 1])[:3]
        # A millimetre on, so that it is inside of what it hit.
        place += 1e-3 * (place - pose[:3, 3]) / np.linalg.norm(place - pose[:3, 3])
        cell = tuple(np.floor(place / VOXEL_M).astype(int))
        if not all(0 <= c < s for c, s in zip(cell, SHAPE, strict=True)):
            continue
        hits += int(target.labels[(b, *cell)]) > 0
        there = int(lifted[(b, *cell)]) - 1
        # The cell's own middle may lie beside the ray by half a cell's diagonal.
        reach = 0.5 * 3**0.5 * VOXEL_M / z * lens[0, 0] + 1.5
        across, down = there % width - column, there // width - row
        assert there < 0 or across**2 + down**2 < 2 * reach**2
        near += there >= 0
    assert near > 500
    assert hits > 0.8 * near


def test_mixed_precision_moves_no_cell():
    inputs, _ = room_batch()
    with torch.autocast("cpu", torch.bfloat16):
        mixed = project_cells(inputs)
    assert torch.equal(mixed.pixels, project_cells(inputs).pixels)
    assert mixed.pixels.dtype == torch.float32


def test_cells_behind_the_camera_get_nothing():
    inputs = seen(3)
    behind = torch.eye(4, dtype=torch.float64)[None]
    behind[0, 2, 3] = 99.0  # Looks along z, away from a grid that is all below.
    inputs = OccInput(inputs.image, inputs.intrinsics, behind, inputs.grid_shape, inputs.voxel_m)
    sight = project_cells(inputs)
    assert not sight.inside.any()
    assert (lift_features({1: torch.ones(1, 2, 13, 18)}, sight, (7, 9, 5)) == 0).all()
