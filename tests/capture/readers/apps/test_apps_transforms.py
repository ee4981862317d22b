"""``transforms.json`` as phone apps and ``ns-process-data`` write it: what differs from plain ones.

The keys are those of nerfstudio's data conventions, of NeRFCapture's manifest and of instant-ngp's
``nerfcapture2nerf.py``; the files are written here by hand.
"""

import json
import zipfile

import numpy as np
import pytest
from app_writers import DEEP, FLIPPED, ROOM_TO_ARKIT, WIDE, millimetres, shots_of
from PIL import Image

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.validation import validate_capture
from world2minecraft.capture.view_stream import read_view
from world2minecraft.core.errors import CaptureError


@pytest.fixture(scope="module")
def shots(box_room):
    return shots_of(box_room, 4, ROOM_TO_ARKIT)


def _lens():
    lens = {"fl_x": WIDE.fx_px, "fl_y": WIDE.fy_px, "cx": WIDE.cx_px, "cy": WIDE.cy_px}
    return lens | {"w": WIDE.width_px, "h": WIDE.height_px}


def _write(folder, shots, per_frame, depth_key="depth_file_path", depths=True, **stated):
    """Pictures ``images/N.png``, named without suffix as NeRFCapture does."""
    (folder / "images").mkdir(parents=True)
    frames = []
    for index, shot in enumerate(shots):
        Image.fromarray(shot.colour).save(folder / "images" / f"{index}.png")
        frame = {"file_path": f"images/{index}", **_lens(), **per_frame}
        frame["transform_matrix"] = (shot.pose @ FLIPPED).tolist()
        if depth_key:
            frame[depth_key] = f"images/{index}.depth.png"
        if depth_key and depths:
            Image.fromarray(millimetres(shot)).save(folder / "images" / f"{index}.depth.png")
        frames.append(frame)
    (folder / "transforms.json").write_text(json.dumps({"frames": frames, **stated}))


def test_nerfcaptures_depth_has_its_own_key_and_unit(tmp_path, shots):
    _write(tmp_path, shots, {}, "depth_path", integer_depth_scale=0.001)
    judged = validate_capture(tmp_path, ScanOptions())
    assert judged.complete
    assert not judged.encoding.guessed
    for frame, shot in zip(judged.frames, shots, strict=True):
        view = read_view(frame, judged.encoding)
        np.testing.assert_allclose(view.depth_m, shot.depth_m, atol=6e-4)
        np.testing.assert_allclose(view.camera_to_scan, shot.pose, atol=1e-9)
        assert (view.colour_camera, view.depth_camera) == (WIDE, DEEP)


def test_missing_depth_files_are_reported(tmp_path, shots):
    """NeRFCapture's own export names depth images and does not write them."""
    _write(tmp_path, shots, {}, "depth_path", depths=False, depth_integer_scale=1.0)
    judged = validate_capture(tmp_path, ScanOptions())
    assert judged.posed
    assert not judged.has_depth
    assert judged.notes == ("4 depth images named in the file are missing",)
    assert judged.capture.scale == "metric"


def test_a_mask_selects_pixels(tmp_path, shots):
    _write(tmp_path, shots, {"mask_path": "mask.png"})
    mask = np.zeros((120, 160), np.uint8)
    mask[:, 80:] = 255
    Image.fromarray(mask).save(tmp_path / "mask.png")
    judged = validate_capture(tmp_path, ScanOptions())
    view = read_view(judged.frames[0], judged.encoding, judged.capture.full_trust)
    assert not view.depth_m[:, :40].any()
    assert (view.trust[:, 40:] == 255).all()


def test_poses_that_colmap_found_have_no_unit(tmp_path, shots):
    turn = {"applied_transform": np.eye(4)[:3].tolist()}
    _write(tmp_path / "new", shots, {"colmap_im_id": 3}, "", ply_file_path="sparse_pc.ply", **turn)
    _write(tmp_path / "old", shots, {}, "", **turn)
    _write(tmp_path / "sensor", shots, {}, **turn)
    _write(tmp_path / "phone", shots, {}, "", ply_file_path="points.ply")
    scales = {
        name: find_capture(tmp_path / name).scale for name in ("new", "old", "sensor", "phone")
    }
    assert scales == {"new": "unknown", "old": "unknown", "sensor": "metric", "phone": "metric"}


def test_it_may_lie_in_a_zip_with_other_things(tmp_path, shots):
    _write(tmp_path / "room", shots, {}, ply_file_path="points.ply")
    (tmp_path / "room" / "points.ply").write_text("ply")
    with zipfile.ZipFile(tmp_path / "room.zip", "w") as archive:
        for path in sorted((tmp_path / "room").rglob("*.*")):
            archive.write(path, path.relative_to(tmp_path).as_posix())
    assert validate_capture(tmp_path / "room.zip", ScanOptions()).complete


@pytest.mark.parametrize(
    ("stated", "words"),
    [
        ({"integer_depth_scale": "small"}, "integer_depth_scale"),
        ({"integer_depth_scale": -1}, "depth unit"),
        ({"camera_model": "OPENCV_FISHEYE"}, "undistort"),
        ({"frames": []}, "frames"),
        ({"frames": [{"file_path": "../x.png", "transform_matrix": []}]}, "relative"),
        ({"frames": [{"file_path": "a.png", "depth_path": "/etc/passwd"}]}, "no camera poses"),
    ],
)
def test_nonsense_is_refused(tmp_path, shots, stated, words):
    _write(tmp_path, shots, {}, "depth_path", **stated)
    with pytest.raises(CaptureError, match=words) as caught:
        validate_capture(tmp_path, ScanOptions())
    assert "\n" not in str(caught.value)


def test_depth_outside_the_folder_is_refused(tmp_path, shots):
    _write(tmp_path, shots, {"depth_path": "../../secret.png"}, "")
    with pytest.raises(CaptureError, match="inside the folder"):
        find_capture(tmp_path)
