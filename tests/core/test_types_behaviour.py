"""What the values can do beside holding their fields."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from test_types_checks import GOOD

from world2minecraft.core import coordinates as co
from world2minecraft.core import types


def make(kind, **change):
    return kind(**{**GOOD[kind], **change})


@given(st.integers(1, 400), st.integers(1, 400), st.integers(1, 4))
def test_a_resized_camera_sees_the_same_rays(width, height, times):
    camera = types.Camera(width, height, 300.0, 310.0, width / 2 - 1, height / 2 + 2)
    larger = camera.resized(width * times, height * times)
    for u, v in [(0, 0), (width, height), (width / 3, height / 2)]:
        ray = ((u - camera.cx_px) / camera.fx_px, (v - camera.cy_px) / camera.fy_px)
        again = (
            (u * times - larger.cx_px) / larger.fx_px,
            (v * times - larger.cy_px) / larger.fy_px,
        )
        assert again == pytest.approx(ray)
    assert larger.resized(width, height) == camera


def test_a_camera_is_not_stretched():
    camera = types.Camera(640, 480, 585.0, 585.0, 320.0, 240.0)
    assert camera.resized(1280, 965).height_px == 965  # Half a percent apart: rounding.
    with pytest.raises(ValueError, match=r"^640x360 has another aspect ratio than 640x480$"):
        camera.resized(640, 360)


def test_the_matrix_projects_to_the_principal_point():
    camera = types.Camera(640, 480, 500.0, 510.0, 320.5, 239.5)
    assert (camera.matrix @ [0, 0, 2] / 2).tolist() == [320.5, 239.5, 1]


def test_the_depth_cameras_pose_is_a_chain():
    shift = np.eye(4)
    shift[0, 3] = 0.025
    turn = co.rotation_about_z(90)
    view = make(types.View, camera_to_scan=turn, depth_to_colour=shift)
    assert np.array_equal(view.depth_camera_to_scan, turn @ shift)
    assert view.depth_camera_to_scan[:3, 3].tolist() == [0, 0.025, 0]


def test_occupied_is_neither_empty_nor_unknown():
    labels = np.array([[[0, 1, 5, 11, 255]]], np.uint8)
    source = np.where(labels == 255, 0, 1).astype(np.uint8)
    grid = types.OccupancyGrid(
        labels,
        np.zeros(labels.shape, np.float16),
        np.zeros((*labels.shape, 3), np.uint8),
        source,
        np.zeros(labels.shape, np.uint16),
        0.08,
        np.zeros(3),
    )
    assert grid.shape == (1, 1, 5)
    assert grid.occupied.tolist() == [[[False, True, True, True, False]]]


@given(st.integers(-500, 500), st.sampled_from([0.02, 0.04, 0.05, 0.08, 0.1]))
def test_any_whole_multiple_is_an_origin(cells, voxel_m):
    evidence = make(types.FusedEvidence, voxel_m=voxel_m, origin_m=np.full(3, cells * voxel_m))
    assert evidence.origin_m[0] == cells * voxel_m


def test_an_operation_undone_twice_is_itself():
    done = make(types.Operation)
    undone = done.inverse()
    assert (undone.before, undone.after) == (done.after, done.before)
    again = undone.inverse()
    assert (again.before, again.after) == (done.before, done.after)
    assert np.array_equal(again.cells, done.cells)


def test_an_edit_of_blocks_undone_twice_is_itself():
    done = make(types.BlockEdit, reason="floats", class_id=5, instance=3)
    undone = done.inverse()
    assert (undone.before, undone.after) == (done.after, done.before)
    again = undone.inverse()
    assert np.array_equal(again.cells, done.cells)
    assert (again.before, again.reason, again.class_id, again.instance) == (
        done.before,
        "floats",
        5,
        3,
    )


@pytest.mark.parametrize("scale", [0.5, 1.0, 2.0, 4.0, 12.5])
def test_a_volume_knows_its_scale(scale):
    transform = co.block_to_room(np.array([0.3, 4.1]), scale)
    assert make(types.BlockVolume, block_to_room=transform).blocks_per_metre == pytest.approx(scale)


def test_a_placements_parameters_are_sorted_and_fixed():
    placement = make(types.Placement, parameters={"legs": 4.0, "arms": 2.0})
    assert list(placement.parameters) == ["arms", "legs"]
    with pytest.raises(TypeError):
        placement.parameters["arms"] = 1.0  # type: ignore[index]


def test_poses_may_be_a_little_off_orthonormal():
    """Captures round their poses: 4e-5 passes, a shear of a percent does not."""
    pose = np.eye(4)
    pose[0, 1] = 4e-5
    assert make(types.View, camera_to_scan=pose).camera_to_scan[0, 1] == 4e-5
