"""One small rotation lays all faces along the axes; a face lies where most of its surface is."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from world2minecraft.capture.alignment.axis_profiles import face_position_m, points_per_cell
from world2minecraft.capture.alignment.plane_alignment import align_planes, find_faces
from world2minecraft.capture.alignment.room_frame import align_surface
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
    left = align_planes(surface.transformed(lean)).rotation @ lean[:3, :3]
    assert np.degrees(Rotation.from_matrix(left).magnitude()) < 0.05


def test_without_faces_nothing_is_rotated():
    nothing = sheet(0.0, 0.0, 0.0)
    found = align_planes(nothing)
    np.testing.assert_array_equal(found.rotation, np.eye(3))
    assert (found.sigma_deg > 180).all(), "nothing is known"
    assert find_faces(nothing) == []


def test_faces_near_each_other_are_not_counted_twice():
    assert len(find_faces(both(sheet(0.0, 0, 2), sheet(0.05, 0, 1)))) == 1
    assert len(find_faces(both(sheet(0.0, 0, 2), sheet(0.5, 0, 1.5)))) == 2


def level_face(
    height_m: float, side_m: float, *, lean_deg: float = 0.0, bend_per_m2: float = 0.0
) -> OrientedPoints:
    """Return a square face that looks up, seen from 2 m above its middle."""
    x, y = np.meshgrid(*[np.arange(-side_m / 2, side_m / 2, 0.03)] * 2)
    lean = np.radians(lean_deg)
    eye = np.eye(4)
    eye[2, 3] = height_m + 2.0
    squared_distance = x**2 + y**2 + 4.0
    bend = bend_per_m2 * squared_distance * np.sign(x)  # One half high, one low: it seems to lean.
    z = height_m + x * np.tan(lean) + bend
    normal = np.array([-np.sin(lean), 0.0, np.cos(lean)])
    return OrientedPoints(
        np.column_stack([x.ravel(), y.ravel(), z.ravel()]),
        np.tile(normal, (x.size, 1)),
        eye[None],
        np.full(x.size, 0.002),
        np.zeros(x.size, np.int32),
    )


def tilt_deg(rotation: np.ndarray) -> float:
    return float(np.degrees(np.arccos(min(1.0, rotation[2, 2]))))


def test_a_leaning_table_does_not_tip_a_level_floor():
    scene = both(level_face(0.0, 3.0), level_face(0.72, 1.2, lean_deg=2.0))
    assert tilt_deg(align_planes(scene).rotation) < 0.1


def test_a_scrap_of_floor_does_not_tip_a_room_with_a_large_table():
    """The bend of the depth makes a small face lean; only its extent tells how much to trust it."""
    scrap = level_face(0.0, 0.55, bend_per_m2=0.0008)
    scene = both(scrap, level_face(0.72, 1.8))
    alone, together = (tilt_deg(align_planes(surface).rotation) for surface in (scrap, scene))
    assert alone > 0.15
    assert together < 0.7 * alone


def test_more_points_on_a_bent_face_do_not_make_it_surer():
    bent = level_face(0.0, 2.0, bend_per_m2=0.002)
    seen_often = both(bent, both(bent, bent))
    once, often = align_planes(bent).sigma_deg, align_planes(seen_often).sigma_deg
    np.testing.assert_allclose(once[:2], often[:2], rtol=0.05)
    assert (once[:2] > align_planes(level_face(0.0, 2.0)).sigma_deg[:2]).all()


def test_gravity_of_the_device_decides_where_no_face_does():
    wall = sheet(0.0, 0, 2)
    up = np.array([0.0, np.sin(np.radians(2)), np.cos(np.radians(2))])
    level = align_planes(wall, up).rotation @ up
    assert np.degrees(np.arccos(level[2])) < 0.3


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
