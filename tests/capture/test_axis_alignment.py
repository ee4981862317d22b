"""One small turn lays all faces along the axes; a face's place is that of its most surface."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from world2minecraft.capture.alignment.axis_profiles import face_position_m, points_per_cell
from world2minecraft.capture.alignment.room_frame import (
    align_surface,
    axis_aligning_rotation,
    find_faces,
)
from world2minecraft.geometry.oriented_points import OrientedPoints, collect_oriented_points


def sheet(x: float, low: float, high: float, noise_m: float = 0.002) -> OrientedPoints:
    """Return a surface at ``x`` that looks along +x, as wide in y as in z."""
    y, z = np.meshgrid(np.arange(low, high, 0.05), np.arange(low, high, 0.05))
    rng = np.random.default_rng(2)
    points = np.column_stack([np.full(y.size, x), y.ravel(), z.ravel()])
    points[:, 0] += noise_m * rng.standard_normal(y.size)
    return OrientedPoints(
        points,
        np.tile([1.0, 0.0, 0.0], (y.size, 1)),
        np.eye(4)[None],
        np.full(y.size, noise_m),
        np.zeros(y.size, np.int32),
    )


def both(one: OrientedPoints, other: OrientedPoints) -> OrientedPoints:
    return OrientedPoints(
        np.concatenate([one.points_m, other.points_m]),
        np.concatenate([one.normals, other.normals]),
        one.cameras,
        np.concatenate([one.sigma_m, other.sigma_m]),
        np.concatenate([one.owner, other.owner]),
    )


@pytest.mark.parametrize("degrees", [(0.8, 0, 0), (0, -0.8, 0), (0, 0, 0.8), (0.5, -0.4, 0.6)])
def test_a_small_tilt_is_found(box_room, degrees):
    surface = collect_oriented_points(box_room.views(14, noise_seed=1))
    lean = np.eye(4)
    lean[:3, :3] = Rotation.from_euler("xyz", degrees, degrees=True).as_matrix()
    left = axis_aligning_rotation(surface.transformed(lean)) @ lean[:3, :3]
    assert np.degrees(Rotation.from_matrix(left).magnitude()) < 0.05


def test_without_faces_nothing_is_rotated():
    nothing = sheet(0.0, 0.0, 0.0)
    np.testing.assert_array_equal(axis_aligning_rotation(nothing), np.eye(3))
    assert find_faces(nothing).count == 0


def test_faces_near_each_other_are_not_counted_twice():
    assert find_faces(both(sheet(0.0, 0, 2), sheet(0.05, 0, 1))).count == 1
    assert find_faces(both(sheet(0.0, 0, 2), sheet(0.5, 0, 1.5))).count == 2


@pytest.mark.parametrize("leaf", [-0.05, -0.02, 0.02, 0.04])
def test_a_wall_is_where_most_of_it_is(leaf):
    """A door's leaf behind it, or a picture before it, does not move it by a millimetre."""
    scene = both(sheet(1.0, 0, 2), sheet(1.0 + leaf, 0, 0.9))
    assert face_position_m(scene, 0, 1.0 + leaf) == pytest.approx(1.0, abs=0.001)


def test_a_place_without_surface_is_returned():
    assert face_position_m(sheet(1.0, 0, 2), 0, 3.0) == 3.0


def test_points_per_cell_count_the_points_of_a_patch():
    points = np.array([[0, 0.01, 0.01], [5, 0.02, 0.03], [0, 0.15, 0.01]])
    np.testing.assert_array_equal(points_per_cell(points, 0), [2, 2, 1])


def test_the_room_of_exact_depth_is_found_to_a_millimetre(box_room):
    """To 0.02 degrees and 1 mm, where each frame is right."""
    surface = collect_oriented_points(box_room.views(14))
    found = align_surface(surface)
    tilt = np.degrees(np.arccos(min(1.0, found.scan_to_room[2, 2])))
    assert tilt < 0.02
    assert sorted(found.room_size_m[:2]) == pytest.approx(sorted(box_room.size_m[:2]), abs=0.001)
