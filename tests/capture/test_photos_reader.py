"""Folders of photos. HEIC is written by pillow-heif, the rest by Pillow; EXIF by Pillow too."""

import zipfile

import numpy as np
import pytest
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.images import check_whole, read_colour, read_header
from world2minecraft.capture.options import ScanOptions, parse_options
from world2minecraft.capture.photo_stream import photos_of_capture
from world2minecraft.capture.poster_detection import SOFTWARE_TAG
from world2minecraft.capture.readers.photo_exif import UprightPhoto, read_photo_metadata
from world2minecraft.capture.readers.photo_folder import evenly_thinned, natural_key
from world2minecraft.capture.validation import validate_capture
from world2minecraft.core.errors import CaptureError, InputError, UsageError

# How a picture is stored so that each EXIF flag turns it upright, by the EXIF standard's table.
STORED = {
    1: lambda a: a, 2: lambda a: a[:, ::-1], 3: lambda a: a[::-1, ::-1], 4: lambda a: a[::-1],
    5: lambda a: a.transpose(1, 0, 2), 6: lambda a: np.rot90(a, 1),
    7: lambda a: a[::-1, ::-1].transpose(1, 0, 2), 8: lambda a: np.rot90(a, -1),
}  # fmt: skip


def _picture(seed=0, height=300, width=400):
    small = np.random.default_rng(seed).integers(0, 256, (height // 20, width // 20, 3))
    return small.astype(np.uint8).repeat(20, axis=0).repeat(20, axis=1)


def _exif(orientation=1, film_mm=None, own=None, make="Phone"):
    exif = Image.Exif()
    exif[0x0112] = orientation
    exif[0x010F] = make
    tags = exif.get_ifd(0x8769)
    tags[0x9003] = "2026:05:04 10:20:30"
    if film_mm:
        tags[0xA405] = film_mm
    tags.update(own or {})
    return exif


def _photos(folder, count=4, suffix=".jpg", **exif):
    folder.mkdir(parents=True, exist_ok=True)
    for n in range(count):
        tags = _exif(**exif)
        Image.fromarray(_picture(n)).save(folder / f"IMG_{n + 1}{suffix}", exif=tags)


def _refused(place, *words, kind=InputError):
    with pytest.raises(kind) as caught:
        judged = validate_capture(place, ScanOptions())
        assert not list(photos_of_capture(judged))
        raise CaptureError(place, f"no photo: {judged}")
    line = str(caught.value)
    assert "\n" not in line
    for word in words:
        assert word in line, line


@pytest.mark.parametrize("flag", range(1, 9))
def test_all_eight_orientations_read_to_the_same_picture(tmp_path, flag):
    upright = _picture()
    stored = Image.fromarray(np.ascontiguousarray(STORED[flag](upright)))
    path = tmp_path / "a.png"
    stored.save(path, exif=_exif(flag))
    photo = UprightPhoto(path)
    assert np.array_equal(photo.colour(), upright)
    assert photo.header().size == (400, 300)
    assert (read_photo_metadata(path).width_px, read_photo_metadata(path).height_px) == (400, 300)
    # A plain path stays as it is stored: the intrinsics of posed captures speak of that.
    assert read_header(path).size == stored.size
    assert np.array_equal(read_colour(path), np.array(stored))


def test_heic_photos_are_read_and_found_when_cut_short(tmp_path):
    heif = pytest.importorskip("pillow_heif")
    heif.register_heif_opener()
    _photos(tmp_path, 3, ".heic", film_mm=26)
    judged = validate_capture(tmp_path, ScanOptions())
    photos = list(photos_of_capture(judged))
    assert len(photos) == 3 and photos[0].camera is not None and photos[0].camera_guessed
    assert np.abs(photos[0].colour.astype(int) - _picture(0)).mean() < 12
    path = tmp_path / "IMG_1.heic"
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(InputError, match="copy the file again"):
        check_whole(path)


def test_the_lens_is_guessed_from_exif(tmp_path):
    film = {"film_mm": 26}
    pitch = {"own": {0x920A: 5.0, 0xA20E: 800.0, 0xA210: 3, 0xA002: 400}}
    for tags, focal in ((film, 26 / 43.2666 * 500), (pitch, 5.0 * 80), ({}, None)):
        _photos(tmp_path, 3, orientation=6, **tags)
        frame = find_capture(tmp_path).frames[0]
        camera = frame.colour_camera
        if focal is None:
            assert camera is None
        else:
            assert camera.fx_px == pytest.approx(focal, rel=1e-4)
            assert (camera.width_px, camera.height_px) == (300, 400)
            assert (camera.cx_px, camera.cy_px) == (150, 200)
    assert frame.time_s == pytest.approx(1777890030.0)


def test_photos_come_in_the_order_of_their_numbers(tmp_path):
    _photos(tmp_path, 11)
    capture = find_capture(tmp_path)
    assert [frame.name for frame in capture.frames] == [f"IMG_{n}" for n in range(1, 12)]
    assert (capture.source, capture.lens, capture.scale) == ("photos", "guess", "unknown")
    assert sorted(["b10", "B2", "a"], key=natural_key) == ["a", "B2", "b10"]


def test_zips_and_wrapped_folders_are_read_alike(tmp_path):
    _photos(tmp_path / "room" / "photos")
    with zipfile.ZipFile(tmp_path / "room.zip", "w") as archive:
        for path in sorted((tmp_path / "room" / "photos").iterdir()):
            archive.write(path, f"photos/{path.name}")
    both = [
        list(photos_of_capture(validate_capture(tmp_path / name, ScanOptions())))
        for name in ("room", "room.zip")
    ]
    assert [photo.name for photo in both[0]] == [photo.name for photo in both[1]]
    assert np.array_equal(both[0][0].colour, both[1][0].colour)


def test_what_is_no_photo_of_the_room_is_left_out_with_reasons(tmp_path):
    _photos(tmp_path, 5, film_mm=26)
    (tmp_path / "IMG_1.MOV").write_bytes(b"live")
    (tmp_path / "IMG_1.AAE").write_text("edits")
    (tmp_path / ".DS_Store").write_bytes(b"")
    (tmp_path / "Thumbs.db").write_bytes(b"")
    (tmp_path / "._IMG_1.jpg").write_bytes(b"\0")
    (tmp_path / "copy of 2.jpg").write_bytes((tmp_path / "IMG_2.jpg").read_bytes())
    Image.fromarray(_picture(9)).save(tmp_path / "IMG_E3.jpg", exif=_exif())
    Image.fromarray(_picture(9, 200, 100)).save(tmp_path / "small.jpg", exif=_exif())
    Image.fromarray(_picture(9, 200, 900)).save(tmp_path / "wide.jpg", exif=_exif())
    Image.fromarray(_picture(9)).save(tmp_path / "Screenshot_20.png")
    Image.fromarray(_picture(9)).save(tmp_path / "paint.png")
    (tmp_path / "broken.jpg").write_bytes(b"no picture at all")
    capture = find_capture(tmp_path)
    assert [f.name for f in capture.frames] == ["copy_of_2", "IMG_1", "IMG_3", "IMG_4", "IMG_5"]
    reasons = dict(capture.skipped)
    assert reasons["IMG_2.jpg"] == "is a duplicate of copy of 2.jpg"
    assert reasons["IMG_E3.jpg"] == "is an edited copy of IMG_3, which is used instead"
    assert "thumbnail" in reasons["small.jpg"] and "panorama" in reasons["wide.jpg"]
    assert reasons["Screenshot_20.png"] == reasons["paint.png"] == "is a screenshot"
    assert "copy the file again" in reasons["broken.jpg"]
    assert any("1 live-photo videos" in note for note in capture.notes)
    assert (
        validate_capture(tmp_path, ScanOptions()).skipped[: len(capture.skipped)] == capture.skipped
    )


def test_photos_are_subsampled_evenly(tmp_path):
    _photos(tmp_path, 9)
    capture = find_capture(tmp_path, parse_options({"frames": "3"}))
    assert [frame.name for frame in capture.frames] == ["IMG_1", "IMG_5", "IMG_9"]
    assert evenly_thinned([1, 2], 5) == [1, 2]
    for value in ("2", "-1", "x", "1e5"):
        with pytest.raises(UsageError, match="frames must be"):
            parse_options({"frames": value})


def test_colour_and_depth_without_poses_are_listed_together(tmp_path):
    for n in (0, 20, 100):
        for kind, pixels in (("rgb", _picture(n)), ("depth", np.full((300, 400), 1500, "u2"))):
            (tmp_path / kind).mkdir(exist_ok=True)
            Image.fromarray(pixels).save(tmp_path / kind / f"{n}.png")
    judged = validate_capture(tmp_path, ScanOptions())
    assert [frame.name for frame in judged.frames] == ["0", "20", "100"]
    assert judged.has_depth and not judged.posed
    assert judged.typical_depth_m == pytest.approx(1.5)
    assert all(frame.depth_camera is None for frame in judged.frames)


def test_the_unposed_samples_are_read(shared_data):
    judged = validate_capture(shared_data / "aims_realsense_unposed", ScanOptions())
    assert judged.capture.source == "photos" and len(judged.frames) == 10 and judged.has_depth


def _cut(path):
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def _huge(path):
    """A JPEG whose header promises 60,000 pixels a side."""
    data = bytearray(path.read_bytes())
    at = data.index(b"\xff\xc0")
    data[at + 5 : at + 9] = (60000).to_bytes(2, "big") * 2
    path.write_bytes(bytes(data))


DAMAGES = {
    "truncated": _cut,
    "empty": lambda path: path.write_bytes(b""),
    "wrong magic": lambda path: path.write_bytes(b"RIFFxxxx" + path.read_bytes()),
    "noise": lambda path: path.write_bytes(bytes(range(256)) * 4),
    "huge": _huge,
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_five_ways_of_damage_are_refused_in_one_line(tmp_path, damage):
    _photos(tmp_path)
    for path in tmp_path.iterdir():
        DAMAGES[damage](path)
    _refused(tmp_path)


def test_too_few_photos_are_refused(tmp_path):
    _photos(tmp_path, 2)
    _refused(tmp_path, "contains 2 photos that can be used", "take at least 30", kind=CaptureError)


def test_heic_photos_that_are_called_jpg(tmp_path):
    pytest.importorskip("pillow_heif").register_heif_opener(thumbnails=False)
    for number in range(3):
        Image.fromarray(_picture(number)).save(tmp_path / f"{number}.heic")
        (tmp_path / f"{number}.heic").rename(tmp_path / f"{number}.jpg")
    assert len(validate_capture(tmp_path, ScanOptions()).frames) == 3
    cut = tmp_path / "1.jpg"
    cut.write_bytes(cut.read_bytes()[:-50])
    with pytest.raises(InputError, match="is truncated"):
        check_whole(cut)


def test_what_phones_append_to_a_jpeg_is_no_damage(tmp_path):
    path = tmp_path / "motion.jpg"
    Image.fromarray(_picture()).save(path)
    whole = path.read_bytes()
    path.write_bytes(whole + b"\0" * 9000)
    check_whole(path)
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(InputError, match="is truncated .* copy the file again"):
        check_whole(path)


def test_the_page_of_a_scan_is_no_photo(tmp_path):
    _photos(tmp_path)
    told = PngInfo()
    told.add_text("Software", SOFTWARE_TAG)
    page = Image.fromarray(_picture(9))
    page.save(tmp_path / "capture-scan.png", pnginfo=told)
    page.save(tmp_path / "my-scan.png")
    judged = validate_capture(tmp_path, ScanOptions())
    assert [f.name for f in judged.frames] == [f"IMG_{n}" for n in range(1, 5)]
    assert judged.skipped == (("my-scan.png", "is a screenshot"),)
