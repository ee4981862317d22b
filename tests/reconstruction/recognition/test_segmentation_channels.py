"""The geometry channels of the segmentation network: normals, up, heights, and what is unknown."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from world2minecraft.core.errors import DamagedFileError, InputError, UsageError
from world2minecraft.core.types import Camera
from world2minecraft.geometry.unprojection import pixel_rays
from world2minecraft.reconstruction.recognition.segmentation import (
    SegmentationModel,
    colour_channels,
)
from world2minecraft.reconstruction.recognition.segmentation_channels import (
    HAS_FLOOR,
    HEIGHT,
    INVERSE_DEPTH,
    IS_KNOWN,
    NORMAL_FORWARD,
    NORMAL_RIGHT,
    NORMAL_UP,
    estimate_up,
    geometry_channels,
    geometry_size,
    level_axes,
    network_size,
    sample_nearest,
    surface_normals,
)

CAMERA = Camera(160, 120, 130.0, 130.0, 80.0, 60.0)
HEIGHT_M, HALF_WIDTH_M, WALL_M = 1.4, 1.2, 4.0
LEVEL = np.array([0, -1.0, 0])


def corridor(tilt_deg=0.0, roll_deg=0.0):
    """Depth of a corridor with floor, two sides and an end wall, and up in the camera frame."""
    turn = Rotation.from_euler("xz", [tilt_deg, roll_deg], degrees=True)
    rays = pixel_rays(CAMERA).astype(float)
    level = np.concatenate([rays, np.ones((*rays.shape[:2], 1))], axis=2) @ turn.as_matrix().T
    with np.errstate(divide="ignore"):
        hits = [
            np.where(level[..., 1] > 0, HEIGHT_M / level[..., 1], np.inf),
            HALF_WIDTH_M / np.abs(level[..., 0]),
            np.where(level[..., 2] > 0, WALL_M / level[..., 2], np.inf),
        ]
    return np.min(hits, axis=0).astype(np.float32), turn.inv().apply(LEVEL)


@pytest.mark.parametrize(("tilt", "roll"), [(0, 0), (-25, 0), (-20, 12), (10, -8)])
def test_up_is_estimated_from_the_normals(tilt, roll):
    depth_m, up = corridor(tilt, roll)
    found = estimate_up(surface_normals(depth_m, pixel_rays(CAMERA)))
    assert np.degrees(np.arccos(np.clip(found @ up, -1, 1))) < 1.0


def test_normals_face_the_camera_and_are_those_of_the_planes():
    depth_m, _ = corridor()
    rays = pixel_rays(CAMERA)
    normals = surface_normals(depth_m, rays)
    toward = normals[..., 0] * rays[..., 0] + normals[..., 1] * rays[..., 1] + normals[..., 2]
    assert (toward[np.linalg.norm(normals, axis=2) > 0] < 0).all()
    assert normals[115, 80] == pytest.approx(LEVEL, abs=1e-3)
    assert normals[40, 80] == pytest.approx([0, 0, -1], abs=1e-3)
    assert normals[40, 3] == pytest.approx([1, 0, 0], abs=1e-3)


def test_channels_of_a_corridor():
    depth_m, up = corridor(-20)
    channels = geometry_channels(depth_m, CAMERA, up, HEIGHT_M)
    floor = channels[NORMAL_UP] > 0.99
    assert floor.sum() > 1000
    assert channels[HEIGHT][floor] == pytest.approx(0, abs=1e-3)
    assert channels[INVERSE_DEPTH] == pytest.approx(1 / depth_m, rel=1e-5)
    assert (channels[IS_KNOWN] == 1).all()
    assert (channels[HAS_FLOOR] == 1).all()
    left = slice(20, 40), slice(0, 10)
    assert channels[NORMAL_RIGHT][left] == pytest.approx(1, abs=1e-3)
    end = slice(20, 40), slice(70, 90)
    assert channels[NORMAL_FORWARD][end] == pytest.approx(-1, abs=1e-3)


def test_unknown_height_counts_from_the_lowest_points():
    depth_m, up = corridor(-20)
    known, unknown = (geometry_channels(depth_m, CAMERA, up, height) for height in (HEIGHT_M, None))
    assert (unknown[HAS_FLOOR] == 0).all()
    assert unknown[HEIGHT] == pytest.approx(known[HEIGHT], abs=0.03)


def test_unknown_up_gives_nearly_the_same_channels():
    depth_m, up = corridor(-20, 6)
    given, found = (geometry_channels(depth_m, CAMERA, one, HEIGHT_M) for one in (up, None))
    assert np.abs(given - found).mean() < 0.01


def test_pixels_without_depth_are_zero():
    depth_m, _ = corridor()
    depth_m[:60] = 0
    channels = geometry_channels(depth_m, CAMERA)
    assert (channels[: IS_KNOWN + 1, :60] == 0).all()
    assert (channels[IS_KNOWN, 60:] == 1).all()


@pytest.mark.parametrize("depth_m", [None, np.zeros((48, 64), np.float32)])
def test_without_depth_all_is_zero(depth_m):
    assert not geometry_channels(depth_m, CAMERA, LEVEL, 1.2).any()


def test_depth_of_another_size_gives_the_size_of_the_camera():
    depth_m, up = corridor()
    depth_m *= 1 + 1e-4 * np.random.default_rng(0).random(depth_m.shape, np.float32)
    double = depth_m.repeat(2, axis=0).repeat(2, axis=1)
    channels = geometry_channels(double, CAMERA, up, HEIGHT_M)
    assert channels == pytest.approx(geometry_channels(depth_m, CAMERA, up, HEIGHT_M))


def test_stepped_depth_has_nearly_the_normals_of_fine_depth():
    depth_m, up = corridor(-20)
    stepped = np.round(depth_m * 25.5) / 25.5
    fine, coarse = (geometry_channels(one, CAMERA, up, HEIGHT_M) for one in (depth_m, stepped))
    angle = (fine[NORMAL_UP : NORMAL_RIGHT + 1] * coarse[NORMAL_UP : NORMAL_RIGHT + 1]).sum(axis=0)
    assert np.median(angle) > 0.99


@pytest.mark.parametrize("up", [LEVEL, [0.2, -0.9, 0.4], [0, 0, -1], [0, 0, 1]])
def test_level_axes_are_a_right_handed_frame(up):
    axes = level_axes(np.array(up, float))
    assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-6)
    assert np.linalg.det(axes[[2, 1, 0]]) == pytest.approx(1)  # Right x forward = up.


def test_too_few_normals_leave_up_as_the_image_has_it():
    assert estimate_up(np.zeros((20, 20, 3), np.float32)).tolist() == LEVEL.tolist()


@pytest.mark.parametrize("size", [(640, 480), (1920, 1080), (480, 640), (33, 1000)])
def test_network_sizes_keep_the_aspect(size):
    width, height = network_size(*size)
    assert max(width, height) == 320
    assert abs(width / height / (size[0] / size[1]) - 1) < 0.06
    assert geometry_size(width, height) == (-(-width // 2), -(-height // 2))


def test_nearest_samples_are_values_of_the_image():
    image = np.arange(48).reshape(6, 8)
    assert (sample_nearest(image, 8, 6) == image).all()
    assert (sample_nearest(image, 4, 3) == image[1::2, 1::2]).all()


def test_colours_are_normalised():
    white = np.full((48, 64, 3), 255, np.uint8)
    channels = colour_channels(white, 32, 24)
    assert channels.shape == (3, 24, 32)
    assert channels[:, 0, 0] == pytest.approx([2.2489, 2.4286, 2.64], abs=1e-3)
    assert not colour_channels(None, 32, 24).any()


def test_image_without_colour_and_depth_is_refused():
    with pytest.raises(UsageError, match="neither"):
        SegmentationModel().predict(None, None, CAMERA)


def test_missing_and_damaged_weights_are_named(tmp_path):
    colour = np.zeros((120, 160, 3), np.uint8)
    with pytest.raises(InputError, match="none.onnx"):
        SegmentationModel(tmp_path / "none.onnx").predict(colour, None, CAMERA)
    (tmp_path / "bad.onnx").write_bytes(b"no network")
    with pytest.raises(DamagedFileError, match="not a valid ONNX file"):
        SegmentationModel(tmp_path / "bad.onnx").predict(colour, None, CAMERA)


def test_network_of_another_kind_is_refused():
    weights = SegmentationModel().weights.with_name("completion.onnx")
    with pytest.raises(DamagedFileError, match="no segmentation network"):
        SegmentationModel(weights).predict(np.zeros((12, 16, 3), np.uint8), None, CAMERA)
