"""Stated poses are kept where they are good and put right where they are not."""

import numpy as np
import pytest
from PIL import Image
from tests.capture.sfm.box_room import CAMERA, jittered, photos, poses

from world2minecraft.capture.sfm import SfmParameters, align_similarity, check_poses
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import Camera
from world2minecraft.core.types.photos import Photo

SMALL = SfmParameters(working_px=76_800, most_features=800)
LOOK_ASIDE = np.array([[0, 0, 1, 0.5], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1.0]])


def turned_deg(found: np.ndarray, true: np.ndarray) -> np.ndarray:
    cosine = (np.einsum("iab,iab->i", found[:, :3, :3], true[:, :3, :3]) - 1) / 2
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def test_good_poses_and_lenses_stay_bit_by_bit():
    scene = check_poses(photos(poses(), CAMERA, poses()), SMALL)
    assert scene.camera_to_scan.tobytes() == poses().tobytes()
    assert set(scene.cameras) == {CAMERA} and scene.left_out == () and scene.notes == ()
    assert scene.facts["error_before_px"] == scene.facts["error_after_px"] < 0.2
    assert len(scene.points_m) > 300


def test_jittered_poses_are_refined_in_their_frame():
    stated = jittered(poses(), 1.5, 0.02)
    scene = check_poses(photos(poses(), CAMERA, stated), SMALL)
    facts = scene.facts
    assert facts["error_before_px"] > 1 and facts["error_after_px"] < 0.3
    shape = align_similarity(scene.camera_to_scan, poses())
    assert shape.off_m.max() < 0.005 and shape.off_deg.max() < 0.1
    # The frame is that of the stated poses: as near the truth as ten of them together tell.
    assert turned_deg(scene.camera_to_scan, poses()).max() < 0.8
    assert np.linalg.norm(scene.camera_to_scan[:, :3, 3] - poses()[:, :3, 3], axis=1).max() < 0.02
    assert scene.notes[0].startswith(
        "the median error of the stated poses was 2.8 px; after refinement it is 0.06 px"
    )


def test_another_cameras_focal_length_is_found():
    other = Camera(320, 240, 262.0, 262.0, 160.0, 120.0)
    scene = check_poses(photos(poses(), other, poses()), SMALL)
    assert scene.facts["focal_stated_px"] == 262.0
    assert scene.cameras[0].fx_px == pytest.approx(CAMERA.fx_px, rel=0.01)


@pytest.mark.parametrize("jitter", [0.0, 1.0])
def test_a_wrong_pose_among_good_ones_is_registered_again(jitter):
    stated = jittered(poses(), 1.5 * jitter, 0.02 * jitter)
    stated[4] = poses()[4] @ LOOK_ASIDE
    scene = check_poses(photos(poses(), CAMERA, stated), SMALL)
    assert scene.names == tuple(f"{i:03d}" for i in range(10))
    assert "the stated pose of 004 contradicts the images and was estimated again" in scene.notes
    off = np.linalg.norm(scene.camera_to_scan[4, :3, 3] - poses()[4, :3, 3])
    assert off < 0.002 + 0.02 * jitter
    if not jitter:
        assert scene.camera_to_scan[3].tobytes() == stated[3].tobytes()


def test_useless_poses_are_mapped_from_scratch():
    stated = jittered(poses(), 40.0, 0.1, seed=2)
    scene = check_poses(photos(poses(), CAMERA, stated), SMALL)
    assert scene.notes[0] == (
        "the stated poses are too inaccurate to refine; new poses were estimated"
    )
    assert align_similarity(scene.camera_to_scan, poses()).off_m.max() < 0.005


def test_photos_that_cannot_be_measured():
    grey = [Photo(f"{i}", np.full((240, 320, 3), 128, np.uint8), CAMERA, False, pose)
            for i, pose in enumerate(poses()[:4])]  # fmt: skip
    with pytest.raises(CaptureError) as caught:
        check_poses(grey, SMALL)
    assert str(caught.value) == (
        "photos: 4 of 4 photos show too few details (blank, blurred or dark); switch on the "
        "lights, and step back to show furniture and corners"
    )
    apart = [
        Photo(f"{i}", photos(poses()[i : i + 1], seed=20 + i)[0].colour, CAMERA, False, pose)
        for i, pose in enumerate(poses()[:3])
    ]
    with pytest.raises(CaptureError) as caught:
        check_poses(apart, SMALL)
    assert str(caught.value) == (
        "photos: the photos have too few common details to check their poses (0 points); "
        "take overlapping photos in good light"
    )


def test_the_real_kitchen_states_the_depth_cameras_poses(shared_data):
    folder = shared_data / "redkitchen_rgbd" / "frames"
    if not folder.is_dir():
        pytest.skip(f"the shared kitchen is not at {folder}")
    given = []
    for path in sorted(folder.glob("*.color.jpg"))[::4]:
        pose = np.loadtxt(path.with_name(path.name.replace("color.jpg", "pose.txt")))
        left, _, right = np.linalg.svd(pose[:3, :3])
        pose[:3, :3] = left @ right
        colour = np.asarray(Image.open(path).convert("RGB"))
        stated = Camera(640, 480, 585.0, 585.0, 320.0, 240.0)
        given.append(Photo(path.stem, colour, stated, False, pose))
    scene = check_poses(given, SfmParameters(working_px=480_000))
    assert len(scene.names) == 10
    assert scene.facts["error_before_px"] > 1.2 and scene.facts["error_after_px"] < 0.6
    assert scene.cameras[0].fx_px == pytest.approx(525, abs=12)
