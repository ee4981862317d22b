"""Labelled frames: the split, the readers, and what augmentation keeps together."""

import os
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from labelled_rooms import BED, CAMERA, HEIGHT_M, room_arrays, room_frame, write_nyu_frame
from PIL import Image
from scipy.io import savemat

from world2minecraft.core.errors import DamagedFileError, InputError, UsageError
from world2minecraft.networks.segmentation.augmentation import (
    draw_example,
    floor_height,
    warp_colour,
    warp_nearest,
)
from world2minecraft.networks.segmentation.frames import (
    IGNORED,
    class_shares,
    labelled_frame,
    nyu_part,
    read_nyu_folder,
)
from world2minecraft.networks.segmentation.public_sets import (
    find_sun_rgbd,
    frames_of_nyu_arrays,
    read_class_mapping,
    read_nyu_mat,
    read_sun_rgbd,
)
from world2minecraft.reconstruction.recognition.segmentation_channels import (
    IS_KNOWN,
    NORMAL_RIGHT,
)

WHOLE = np.array([[1.0, 0, 0], [0, 1.0, 0]])


def test_validation_is_each_fifth_block_without_its_ends():
    validation = {n for n in range(1, 1450) if nyu_part(n) == "validation"}
    wanted = {n for n in range(1, 1450) if (n // 50) % 5 == 4 and 3 <= n % 50 <= 46}
    assert validation == wanted


def test_ends_of_validation_blocks_are_in_no_part():
    ends = [n for n in range(1, 1450) if (n // 50) % 5 == 4 and not 3 <= n % 50 <= 46]
    assert {nyu_part(n) for n in ends} == {"unused"}


def test_the_rest_is_for_training_and_calibration():
    rest = [n for n in range(1, 1450) if (n // 50) % 5 != 4]
    parts = [nyu_part(n) for n in rest]
    assert "validation" not in parts
    assert parts.count("train") == len(rest) - 50
    assert parts.count("calibration") > 30


def test_no_number_of_training_is_near_one_of_validation():
    train = np.array([n for n in range(1, 1450) if nyu_part(n) == "train"])
    held = np.array([n for n in range(1, 1450) if nyu_part(n) in ("validation", "calibration")])
    assert np.abs(train[:, None] - held).min() > 3


def test_folder_is_read_by_parts(tmp_path):
    for number in (10, 199, 201, 210, 360):
        write_nyu_frame(tmp_path, number)
    assert [f.name for f in read_nyu_folder(tmp_path, ["train"])] == ["0010", "0199"]
    assert [f.name for f in read_nyu_folder(tmp_path, ["validation"])] == ["0210"]
    assert [f.name for f in read_nyu_folder(tmp_path, ["calibration"])] == ["0360"]


def test_frame_of_a_folder_has_its_pixels(tmp_path):
    write_nyu_frame(tmp_path, 10)
    (frame,) = read_nyu_folder(tmp_path, ["train"])
    colour, labels, depth_m = room_arrays(10)
    assert (frame.labels == labels).all()
    assert np.abs(frame.colour.astype(int) - colour).mean() < 15
    assert frame.camera.fx_px == pytest.approx(51.886, abs=1e-3)
    middle = frame.depth_m.shape[0] // 4
    assert frame.depth_m[middle, 0] == pytest.approx(depth_m[middle, 0], abs=0.04)


def test_cached_depth_is_the_same(tmp_path):
    write_nyu_frame(tmp_path / "data", 10)
    first, second = (
        read_nyu_folder(tmp_path / "data", ["train"], tmp_path / "cache")[0] for _ in range(2)
    )
    assert (tmp_path / "cache" / "0010.npy").is_file()
    assert (first.depth_m == second.depth_m).all()
    assert (first.stored_m == second.stored_m).all()


def test_folder_without_frames_is_named(tmp_path):
    with pytest.raises(InputError, match="NNNN.label40.png"):
        read_nyu_folder(tmp_path, ["train"])


def test_labels_of_another_size_are_named(tmp_path):
    write_nyu_frame(tmp_path, 10)
    Image.fromarray(np.zeros((4, 4), np.uint8)).save(tmp_path / "0010.label40.png")
    with pytest.raises(DamagedFileError, match="0010.label40.png.*another size"):
        read_nyu_folder(tmp_path, ["train"])


def nyu_arrays(count):
    """The arrays of the labelled set, with the axes as HDF5 gives them."""
    made = [room_arrays(n) for n in range(count)]
    return {
        "images": np.stack([colour.T for colour, _, _ in made]),
        "labels": np.stack([labels.T.astype(np.uint16) * 5 for _, labels, _ in made]),
        "depths": np.stack([depth_m.T for _, _, depth_m in made]),
    }


def test_arrays_of_the_labelled_set_become_frames():
    classes = np.zeros(895, np.uint8)
    classes[[5, 15]] = 2, 4  # Floor and bed; the wall is 0, which is unlabelled.
    frames = list(frames_of_nyu_arrays(nyu_arrays(3), classes, ["train"]))
    assert [frame.name for frame in frames] == ["0001", "0002", "0003"]
    colour, labels, _ = room_arrays(1)
    assert (frames[1].colour == colour).all()
    assert (frames[1].labels == np.where(labels == 0, IGNORED, labels)).all()
    assert (frames[1].depth_m == room_frame(1).depth_m).all()


def test_reading_the_mat_file_without_h5py_says_what_to_do(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(UsageError, match="pip install h5py"):
        read_nyu_mat(tmp_path / "nyu_depth_v2_labeled.mat", ["train"])


def test_class_mapping_is_read_and_checked(tmp_path):
    path = tmp_path / "classMapping40.mat"
    with pytest.raises(InputError, match="not found"):
        read_class_mapping(path)
    savemat(path, {"mapClass": np.arange(894)[None] % 40 + 1})
    assert read_class_mapping(path)[[0, 1, 40, 41, 894]].tolist() == [0, 1, 40, 1, 14]
    savemat(path, {"mapClass": np.ones((1, 5))})
    with pytest.raises(DamagedFileError, match="mapClass with 894"):
        read_class_mapping(path)


def write_sun_frame(folder, camera=CAMERA):
    colour, labels, depth_m = room_arrays(3, camera)
    for name in ("image", "depth_bfx"):
        (folder / name).mkdir(parents=True)
    Image.fromarray(colour).save(folder / "image" / "a.png")
    mm = np.round(depth_m * 1000).astype(np.uint16)
    Image.fromarray((mm << 3) | (mm >> 13)).save(folder / "depth_bfx" / "a.png")
    lens = f"{camera.fx_px} 0 {camera.cx_px}\n0 {camera.fy_px} {camera.cy_px}\n0 0 1\n"
    (folder / "intrinsics.txt").write_text(lens)
    names = np.array(["wall", "floor", "unheard_of", "bed"], object)
    savemat(folder / "seg.mat", {"seglabel": labels.astype(np.uint16) + 1, "names": names})
    return labels, depth_m


def test_sun_frames_are_found_and_read(tmp_path):
    labels, depth_m = write_sun_frame(tmp_path / "kv2" / "000001")
    (folder,) = find_sun_rgbd(tmp_path)
    frame = read_sun_rgbd(folder)
    assert frame.name == "000001"
    assert (frame.labels == labels).all()
    assert frame.camera.fx_px == CAMERA.fx_px
    seen_m = np.unique(np.round(depth_m, 3))
    assert set(np.unique(np.round(frame.depth_m, 3))) <= set(seen_m)


def test_sun_labels_of_another_size_are_named(tmp_path):
    write_sun_frame(tmp_path / "frame")
    savemat(tmp_path / "frame" / "seg.mat", {"seglabel": np.ones((3, 3)), "names": ["wall"]})
    with pytest.raises(DamagedFileError, match="another size"):
        read_sun_rgbd(tmp_path / "frame")


def test_folder_without_sun_frames_is_named(tmp_path):
    with pytest.raises(InputError, match=r"seg\.mat"):
        find_sun_rgbd(tmp_path)


def test_published_sun_frame_with_labels_is_read(tmp_path):
    shared = Path(os.environ.get("W2M_SHARED_DATA", ""), "real_captures", "sunrgbd_kv2")
    if "W2M_SHARED_DATA" not in os.environ or not shared.is_dir():
        pytest.skip("W2M_SHARED_DATA names no folder with real_captures/sunrgbd_kv2")
    shutil.copytree(shared, tmp_path / "frame")
    with Image.open(next((tmp_path / "frame" / "image").iterdir())) as image:
        size = image.size
    labels = {"seglabel": np.ones(size[::-1]), "names": np.array(["desk"], object)}
    savemat(tmp_path / "frame" / "seg.mat", labels)
    frame = read_sun_rgbd(tmp_path / "frame")
    assert frame.camera.fx_px == 529.5
    assert 0.5 < np.median(frame.depth_m[frame.depth_m > 0]) < 4
    assert (frame.labels == 13).all()


def test_class_shares_leave_out_ignored_pixels():
    frame = room_frame(0)
    frame.labels[:24] = IGNORED
    shares = class_shares([frame])
    assert shares[IGNORED] == 0
    assert shares.sum() == pytest.approx(1)


def test_height_of_the_labelled_floor():
    frame = room_frame(0)
    assert floor_height(frame, np.array([0, -1, 0.0])) == pytest.approx(HEIGHT_M, abs=0.05)
    frame.labels[:] = BED
    assert floor_height(frame, np.array([0, -1, 0.0])) is None


def test_whole_window_is_the_image():
    image = np.random.default_rng(0).integers(0, 255, (6, 8, 3), np.uint8)
    planes = image.transpose(2, 0, 1)
    assert (warp_nearest(planes, WHOLE, (6, 8), np.uint8(0)) == planes).all()
    flat = np.full((6, 8, 3), 77, np.uint8)
    assert np.allclose(warp_colour(flat, WHOLE, (3, 4)), 77)


def test_outside_of_the_image_is_marked():
    twice = np.array([[2.0, 0, 0], [0, 2.0, 0]])
    labels = warp_nearest(np.zeros((1, 6, 8), np.uint8), twice, (6, 8), np.uint8(IGNORED))[0]
    assert (labels[:3, :4] == 0).all()
    assert (labels[3:] == IGNORED).all()
    assert (labels[:, 4:] == IGNORED).all()


def test_mirrored_window_is_the_mirrored_image():
    colour = np.random.default_rng(0).integers(0, 255, (12, 16, 3), np.uint8)
    mirror = np.array([[-1.0, 0, 1], [0, 1.0, 0]])
    plain, turned = (warp_colour(colour, window, (12, 16)) for window in (WHOLE, mirror))
    assert np.allclose(turned, plain[:, :, ::-1], atol=1e-3)


def test_examples_of_a_seed_are_the_same():
    frame = room_frame(0)
    first, second = (draw_example(frame, np.random.default_rng(5), (64, 48)) for _ in range(2))
    assert all((a == b).all() for a, b in zip(first, second, strict=True))


def test_examples_have_missing_channels_but_never_both():
    frame = room_frame(0)
    kinds = set()
    for seed in range(60):
        one = draw_example(frame, np.random.default_rng(seed), (64, 48))
        assert one.colour.shape == (3, 48, 64)
        assert one.geometry.shape == (7, 24, 32)
        assert one.labels.shape == (24, 32)
        kinds.add((bool(one.colour.any()), bool(one.geometry[IS_KNOWN].any())))
    assert kinds == {(True, True), (True, False), (False, True)}


def test_geometry_stays_with_the_labels():
    # The face of the box is the only surface at 2 m; noise is small beside the steps of depth.
    frame = room_frame(0)
    for seed in range(20):
        one = draw_example(frame, np.random.default_rng(seed), (64, 48))
        inverse, bed = one.geometry[0], one.labels == BED
        seen = bed & (one.geometry[IS_KNOWN] > 0)
        if seen.sum() > 20:
            assert np.median(inverse[seen]) == pytest.approx(0.5, abs=0.1)


def test_mirroring_turns_the_normal_to_the_right():
    # A wall on the left faces right; in the mirrored window it lies on the right and faces left.
    across = (np.arange(64) + 0.5 - 32) / 52
    depth_m = np.tile(np.where(across < -0.1, 1 / np.maximum(-across, 0.1), 0), (48, 1))
    colour, labels, _ = room_arrays(0)
    frame = labelled_frame("wall", colour, labels, depth_m, CAMERA)
    sides = []
    for seed in range(40):
        right = draw_example(frame, np.random.default_rng(seed)).geometry[NORMAL_RIGHT]
        strong = np.abs(right) > 0.5
        if strong.sum() > 400:
            is_left = np.nonzero(strong)[1].mean() < right.shape[1] / 2
            sides.append((is_left, np.median(right[strong]) > 0))
    assert {True, False} == {bool(is_left) for is_left, _ in sides}
    assert np.mean([is_left == faces_right for is_left, faces_right in sides]) > 0.9
