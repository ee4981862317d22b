"""The photo stream: sizes, cameras, order, and photos that turn out damaged."""

import numpy as np
from PIL import Image

from world2minecraft.capture import write_plain
from world2minecraft.capture.images import downscale
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.photo_stream import CapturePhotos, photos_of_capture
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.capture.validation import validate_capture
from world2minecraft.core.types import Camera


def _slow_mean(colour, height, width):
    """Each pixel is the mean over its footprint, by plain loops over the source pixels."""
    result = np.zeros((height, width, 3))
    tall, wide = colour.shape[0] / height, colour.shape[1] / width
    for v in range(height):
        for u in range(width):
            total = 0.0
            for y in range(int(v * tall), int(np.ceil((v + 1) * tall))):
                for x in range(int(u * wide), int(np.ceil((u + 1) * wide))):
                    share = min(y + 1, (v + 1) * tall) - max(y, v * tall)
                    share *= min(x + 1, (u + 1) * wide) - max(x, u * wide)
                    result[v, u] += share * colour[y, x]
                    total += share
            result[v, u] /= total
    return result


def test_a_downscaled_picture_is_the_mean_of_each_footprint():
    colour = np.random.default_rng(0).integers(0, 256, (36, 60, 3)).astype(np.uint8)
    for longest in (30, 20):
        small = downscale(colour, longest)
        assert small.shape == (longest * 36 // 60, longest, 3)
        assert np.abs(small - _slow_mean(colour, *small.shape[:2])).max() <= 1.0
    assert downscale(colour, 60) is colour
    assert downscale(colour[:, :20], 18).shape == (18, 10, 3)


def test_photos_of_a_posed_capture_keep_names_and_poses(tmp_path, box_room):
    views = box_room.views(4)
    write_plain(tmp_path, views)
    photos = photos_of_capture(validate_capture(tmp_path, ScanOptions()), longest_px=80)
    for _ in range(2):  # Read again, they are the same.
        read = list(photos)
        assert [photo.name for photo in read] == [view.name for view in views]
        for photo, view in zip(read, views, strict=True):
            assert photo.colour.shape == (60, 80, 3)
            assert photo.camera is not None and photo.camera_to_scan is not None
            assert (photo.camera.fx_px, photo.camera.cx_px) == (65.0, 40.0)
            assert not photo.camera_guessed
            assert np.allclose(photo.camera_to_scan, view.camera_to_scan)
    full = next(iter(photos_of_capture(validate_capture(tmp_path, ScanOptions()))))
    assert np.array_equal(full.colour, views[0].colour)


def test_damaged_photos_are_left_out_and_listed(tmp_path):
    picture = np.random.default_rng(1).integers(0, 256, (40, 60, 3)).astype(np.uint8)
    for n in range(3):
        Image.fromarray(picture).save(tmp_path / f"{n}.png")
    data = (tmp_path / "1.png").read_bytes()
    (tmp_path / "1.png").write_bytes(data[: len(data) // 2])
    camera = Camera(60, 40, 50.0, 50.0, 30.0, 20.0)
    frames = [FrameFiles(str(n), None, tmp_path / f"{n}.png", camera) for n in range(3)]
    odd = FrameFiles("odd", None, tmp_path / "2.png", Camera(60, 60, 50.0, 50.0, 30.0, 30.0))
    photos = CapturePhotos((*frames, odd), "guess", 30)
    assert len(photos) == 4
    assert [photo.name for photo in photos] == ["0", "2"]
    assert all(photo.camera_guessed and photo.camera_to_scan is None for photo in photos)
    assert list(photos.damaged) == ["1", "odd"]
    assert "copy the file again" in photos.damaged["1"]
    assert "another aspect ratio than 60x60" in photos.damaged["odd"]


def test_photos_of_unknown_lenses_have_no_camera():
    class Grey:
        name = stem = "grey"

        def colour(self):
            return np.full((4, 6, 3), 128, np.uint8)

    (photo,) = CapturePhotos((FrameFiles("grey", None, Grey()),), "guess")
    assert photo.camera is None and not photo.camera_guessed
    photos = CapturePhotos((FrameFiles("a/b", None, Grey()),))
    assert not list(photos) and "without slashes" in photos.damaged["a/b"]
