"""Up and the unit: furnished rooms turned to all axes, in all units."""

import numpy as np
import pytest
from mesh_rooms import room_quads

from world2minecraft.capture.readers.meshes.mesh_and_cloud import Mesh, PointCloud
from world2minecraft.capture.readers.meshes.orientation_and_unit import (
    AXES,
    find_orientation,
    find_unit,
    rotation_to_up,
)
from world2minecraft.capture.readers.meshes.surface_sampling import sample_surface

ROOMS = {
    "box": room_quads(),
    "no ceiling": room_quads(without=(5,)),
    "hall": room_quads((6.0, 1.6, 2.6), (((0.5, 0.0, 0.0, 1.5, 0.4, 0.9), (90, 60, 30)),)),
}


def mesh_of(quads, turn):
    vertices, faces, _, _ = quads.triangles()
    return Mesh((vertices @ turn.T).astype(np.float32), faces.astype(np.int32))


@pytest.mark.parametrize("axis", AXES)
def test_rotation_to_up_rotates_the_axis_to_z(axis):
    turn = rotation_to_up(np.array(AXES[axis]))
    np.testing.assert_allclose(turn @ AXES[axis], [0, 0, 1], atol=1e-12)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(turn) == pytest.approx(1)


@pytest.mark.parametrize("axis", ["z", "y"])
@pytest.mark.parametrize("name", ROOMS)
def test_up_is_inferred_against_the_format_axis(name, axis):
    turn = rotation_to_up(np.array(AXES[axis])).T  # The upright room, with its z along the axis.
    samples = sample_surface(mesh_of(ROOMS[name], turn))
    # A hall is higher than wide, and what stands in it stands at its walls: the format decides.
    for usual in ("z", "y") if name != "hall" else (axis.strip("-"),):
        orientation = find_orientation(samples, usual, False, None)
        np.testing.assert_allclose(orientation.turn @ AXES[axis], [0, 0, 1], atol=1e-9)
        assert orientation.description == f"up axis {axis} (estimated)"


def test_up_of_a_cloud_is_inferred():
    points, _, _ = room_quads().points(apart_m=0.05, noise_m=0.005)
    turn = rotation_to_up(np.array(AXES["y"])).T
    samples = sample_surface(PointCloud((points @ turn.T).astype(np.float32)))
    assert find_orientation(samples, "z", False, None).description == "up axis y (estimated)"


def test_a_world_whose_y_points_down_is_turned_over():
    turn = rotation_to_up(
        np.array(AXES["-y"])
    ).T  # That of a first camera, as many trackers leave it.
    samples = sample_surface(mesh_of(room_quads(), turn))
    assert find_orientation(samples, "z", False, None).description == "up axis -y (estimated)"


def test_a_room_that_leans_is_set_upright():
    axis = np.array([0.3, 0.2, 0.95])
    axis /= np.linalg.norm(axis)
    samples = sample_surface(mesh_of(room_quads(), rotation_to_up(axis).T))
    orientation = find_orientation(samples, "z", False, None)
    np.testing.assert_allclose(orientation.turn @ axis, [0, 0, 1], atol=1e-3)
    assert "21 degrees from z" in orientation.description


def test_stated_or_chosen_up_wins():
    samples = sample_surface(mesh_of(room_quads(), np.eye(3)))
    assert find_orientation(samples, "y", True, None).description == "up axis y, from the file"
    assert find_orientation(samples, "y", True, "-x").description == "up axis -x, as set"


@pytest.mark.parametrize("unit, metres", [("m", 1), ("cm", 0.01), ("mm", 0.001), ("foot", 0.3048)])
def test_the_unit_is_the_one_that_makes_a_room(unit, metres):
    for size in ([4.2, 3.1, 2.6], [9.0, 6.0, 2.4], [2.0, 1.6, 2.3]):
        assert find_unit(np.array(size) / metres, None, None)[0] == metres


def test_a_stated_unit_is_used_unless_the_size_is_implausible():
    assert find_unit(np.array([14.0, 10.0, 7.0]), 1.0, None)[0] == 1.0
    assert find_unit(np.array([420.0, 310.0, 260.0]), 1.0, None)[0] == 0.01
    assert find_unit(np.array([420.0, 310.0, 260.0]), 1.0, "m")[0] == 1.0
