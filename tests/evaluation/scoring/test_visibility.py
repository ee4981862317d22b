"""The cells that rays reached: the kernel against a walk in small steps, and the rule of two."""

import numpy as np
import pytest
from true_rooms import CAMERA, FINE_M, SHELL, VOXEL_M, cameras, fine_room, slow_reach

from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.evaluation.scoring.observed_cells import CROSSED, reached_cells
from world2minecraft.evaluation.scoring.truth_files import Truth
from world2minecraft.evaluation.scoring.used_frames import UsedFrame


def true_room() -> Truth:
    labels, _ = fine_room()
    origin_m = np.full(3, -SHELL * FINE_M)
    return Truth(None, labels, FINE_M, origin_m, np.eye(4), ())  # type: ignore[arg-type]


def frame(camera, pose) -> UsedFrame:
    return UsedFrame("f", camera, pose, pose, pose)


def as_set(mask, low) -> set[tuple[int, ...]]:
    return {tuple(cell) for cell in (np.argwhere(mask) + low).tolist()}


@pytest.mark.parametrize("yaw_deg", [0.0, 1.5, 120.0])
def test_the_kernel_marks_what_a_slow_walk_marks(yaw_deg):
    truth, camera, pose = true_room(), CAMERA.resized(12, 9), cameras()[0]
    truth_to_room = rotation_about_z(yaw_deg)
    truth_to_room[:3, 3] = [0.013, -0.021, 0.007]
    reached = reached_cells(truth, [frame(camera, pose)], truth_to_room, VOXEL_M)
    crossed, ends = slow_reach(truth.labels, truth.origin_m, pose, truth_to_room, camera)
    fast = as_set(reached.flags & CROSSED > 0, reached.low)
    assert crossed <= fast
    # The walk steps over the corners of cells that a ray only grazes.
    assert len(fast - crossed) <= 0.03 * len(fast)
    met = as_set(reached.met, reached.low)
    # Along a surface the walk is half a millimetre off, which an edge of two cells may tell.
    assert len(met ^ ends) <= 0.02 * len(ends)


def test_wall_that_grazes_a_cell_is_scored_in_the_cell_behind():
    truth = true_room()
    frames = [frame(CAMERA, pose) for pose in cameras()]
    truth_to_room = np.eye(4)
    truth_to_room[0, 3] = 0.003
    reached = reached_cells(truth, frames, truth_to_room, VOXEL_M)
    at = -reached.low
    wall, front = reached.met[at[0] - 1], reached.met[at[0]]
    inner = (slice(at[1] + 2, at[1] + 26), slice(at[2] + 2, at[2] + 18))
    assert wall[inner].mean() > 0.5 and front[inner].mean() > 0.5
    straight = reached_cells(truth, frames, np.eye(4), VOXEL_M)
    at = -straight.low
    assert straight.met[at[0] - 1][inner].mean() > 0.5
    assert not straight.met[at[0]][inner].any()


def test_more_rays_reach_no_fewer_cells():
    truth, frames = true_room(), [frame(CAMERA, cameras()[0])]
    few = reached_cells(truth, frames, np.eye(4), VOXEL_M, rays_wide=40)
    many = reached_cells(truth, frames, np.eye(4), VOXEL_M, rays_wide=160)
    assert many.scored.sum() >= few.scored.sum() > 0
    assert not reached_cells(truth, [], np.eye(4), VOXEL_M).scored.any()


def test_walls_of_the_truth_hide_what_is_behind_them():
    truth = true_room()
    reached = reached_cells(truth, [frame(CAMERA, pose) for pose in cameras()], np.eye(4), VOXEL_M)
    outside = np.ones(reached.flags.shape, bool)
    low, high = -reached.low - 1, -reached.low + np.array([41, 31, 27])
    outside[low[0] : high[0], low[1] : high[1], low[2] : high[2]] = False
    assert not reached.scored[outside].any()
