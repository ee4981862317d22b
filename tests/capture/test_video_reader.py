"""Videos written by PyAV; the rotation flag is set in the track header's bytes (ISO 14496-12)."""

import struct
import zipfile
from itertools import pairwise

import numpy as np
import pytest
from scipy import ndimage

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.photo_stream import photos_of_capture
from world2minecraft.capture.readers.video import analyse_video, select_frames
from world2minecraft.capture.validation import validate_capture
from world2minecraft.core.errors import CaptureError, InputError

av = pytest.importorskip("av")
WIDTH, HEIGHT = 192, 128


def _wall(seed=0):
    """A wall with marks of all sizes, uint8 [H, 900]."""
    rng = np.random.default_rng(seed)
    layers = [
        ndimage.gaussian_filter(rng.standard_normal((HEIGHT + 40, 900)), size) * size
        for size in (1, 2, 6)
    ]
    wall = sum(layers)
    return np.clip(128 + 60 * wall / wall.std(), 0, 255).astype(np.uint8)


def _film(path, places, blurred=(), codec="mpeg4", rate=24):
    wall = _wall()
    with av.open(str(path), "w") as container:
        stream = container.add_stream(codec, rate=rate)
        stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT, "yuv420p"
        stream.bit_rate = 4_000_000
        stream.codec_context.thread_count = 1
        for n, place in enumerate(places):
            seen = wall[20 : 20 + HEIGHT, int(place) : int(place) + WIDTH].astype(np.float32)
            if n in blurred:
                seen = ndimage.uniform_filter1d(seen, 9, axis=1)
            grey = seen.astype(np.uint8)
            frame = av.VideoFrame.from_ndarray(np.stack([grey] * 3, -1), format="rgb24")
            for packet in stream.encode(frame):
                container.mux(packet)
        for packet in stream.encode():
            container.mux(packet)
    return path


def _walk(count=80, way=600):
    return np.linspace(0, way, count)


def _turned(path, degrees):
    """Write the display matrix of a clockwise turn into every track header."""
    cos, sin = {0: (1, 0), 90: (0, 1), 180: (-1, 0), 270: (0, -1)}[degrees]
    matrix = struct.pack(">9i", cos << 16, sin << 16, 0, -sin << 16, cos << 16, 0, 0, 0, 1 << 30)
    data = bytearray(path.read_bytes())
    at = data.index(b"tkhd") + 4  # A version 0 header: the matrix follows 40 bytes.
    data[at + 40 : at + 76] = matrix
    path.write_bytes(bytes(data))
    return path


def test_frames_are_evenly_apart_and_named_by_their_number(tmp_path):
    capture = find_capture(_film(tmp_path / "walk.mp4", _walk()))
    assert (capture.source, capture.lens, capture.scale) == ("video", "guess", "unknown")
    numbers = [int(frame.name.removeprefix("frame-")) for frame in capture.frames]
    gaps = [b - a for a, b in pairwise(numbers)]
    assert 20 <= len(numbers) <= 30  # 600 px of 192 are 3.1 widths, an eighth each.
    assert min(gaps) >= 1 and max(gaps) <= 6
    for frame, number in zip(capture.frames, numbers, strict=True):
        assert frame.time_s == pytest.approx(number / 24, abs=1e-3)
        assert frame.camera_to_world is None and frame.depth_path is None


def test_blurred_pictures_are_avoided(tmp_path):
    blurred = {n for n in range(80) if n % 3 != 1}
    look = analyse_video(_film(tmp_path / "walk.mp4", _walk(), blurred))
    chosen = select_frames(look, 100)
    assert sum(n in blurred for n in chosen) <= 0.2 * len(chosen)


def test_still_passages_and_shaking_give_few_frames(tmp_path):
    shake = np.random.default_rng(1).integers(-2, 3, 60) + 302
    places = np.concatenate([np.linspace(0, 300, 40), shake, np.linspace(302, 600, 40)])
    look = analyse_video(_film(tmp_path / "walk.mp4", places))
    assert look.path[-1] == pytest.approx(600 / WIDTH, rel=0.15)
    chosen = np.array(select_frames(look, 100))
    assert ((chosen > 41) & (chosen < 99)).sum() <= 2
    assert len(select_frames(look, 10)) <= 10


def test_pictures_are_those_of_the_video_and_the_same_again(tmp_path):
    path = _film(tmp_path / "walk.mp4", _walk())
    with av.open(str(path)) as container:
        every = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    photos = photos_of_capture(validate_capture(path, ScanOptions(frames=6)))
    for _ in range(2):
        for photo in photos:
            assert np.array_equal(photo.colour, every[int(photo.name.removeprefix("frame-"))])
    assert [f.name for f in find_capture(path).frames] == [
        f.name for f in find_capture(path).frames
    ]


@pytest.mark.parametrize("degrees", [0, 90, 180, 270])
def test_rotation_flags_rotate_frames_upright(tmp_path, degrees):
    path = _film(tmp_path / "walk.mp4", _walk(24))
    plain = next(iter(photos_of_capture(validate_capture(path, ScanOptions())))).colour
    turned = _turned(_film(tmp_path / "turned.mp4", _walk(24)), degrees)
    judged = validate_capture(turned, ScanOptions())
    photo = next(iter(photos_of_capture(judged)))
    assert np.array_equal(photo.colour, np.rot90(plain, -degrees // 90))
    header = judged.frames[0].colour_path.header()
    assert header.size == (photo.colour.shape[1], photo.colour.shape[0])


def test_a_folder_or_a_zip_with_one_video_is_that_video(tmp_path):
    folder = tmp_path / "room"
    folder.mkdir()
    _film(folder / "walk.mp4", _walk(24))
    (folder / ".DS_Store").write_bytes(b"")
    (folder / "notes.txt").write_text("the kitchen")
    with zipfile.ZipFile(tmp_path / "room.zip", "w") as archive:
        archive.write(folder / "walk.mp4", "walk.mp4")
    names = [
        [frame.name for frame in find_capture(place).frames]
        for place in (folder, folder / "walk.mp4", tmp_path / "room.zip")
    ]
    assert names[0] == names[1] == names[2]
    _film(folder / "other.mp4", _walk(24))
    with pytest.raises(CaptureError, match="unknown format"):
        find_capture(folder)


def test_a_lens_that_the_phone_wrote_down_is_a_first_guess(tmp_path):
    path = tmp_path / "walk.mov"
    _film(path, _walk(24))
    key = "com.apple.quicktime.camera.focal_length.35mm_equivalent"
    with (
        av.open(str(path)) as source,
        av.open(
            str(tmp_path / "told.mov"), "w", options={"movflags": "use_metadata_tags"}
        ) as target,
    ):
        target.metadata[key] = "26"
        stream = target.add_stream_from_template(source.streams.video[0])
        for packet in source.demux(source.streams.video[0]):
            if packet.dts is not None:
                packet.stream = stream
                target.mux(packet)
    camera = find_capture(tmp_path / "told.mov").frames[0].colour_camera
    assert camera.fx_px == pytest.approx(26 / 43.2666 * np.hypot(WIDTH, HEIGHT), rel=1e-4)
    assert find_capture(path).frames[0].colour_camera is None


def _truncated(path):
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def _audio_only(path):
    path.unlink()
    with av.open(str(path), "w") as container:
        stream = container.add_stream("aac", rate=8000, layout="mono")
        frame = av.AudioFrame.from_ndarray(np.zeros((1, 1024), "f4"), "fltp", "mono")
        frame.sample_rate = 8000
        for packet in [*stream.encode(frame), *stream.encode()]:
            container.mux(packet)


def _no_pictures(path):
    """The index of the film lists no samples: their sizes' count is 0 in stsz."""
    data = bytearray(path.read_bytes())
    for name, at in ((b"stsz", 12), (b"stts", 8), (b"stsc", 8), (b"stco", 8), (b"stss", 8)):
        place = data.find(name)
        if place >= 0:
            data[place + at : place + at + 4] = bytes(4)
    path.write_bytes(bytes(data))


def _huge(path):
    """The sample entry and the picture header promise 60,000 pixels a side."""
    data = bytearray(path.read_bytes())
    at = data.index(b"mp4v") + 4 + 24
    data[at : at + 4] = struct.pack(">HH", 60000, 60000)
    path.write_bytes(bytes(data))


DAMAGES = {
    "truncated": _truncated,
    "empty": lambda path: path.write_bytes(b""),
    "wrong magic": lambda path: path.write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(500)),
    "audio only": _audio_only,
    "no pictures": _no_pictures,
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_five_ways_of_damage_are_refused_in_one_line(tmp_path, damage):
    path = _film(tmp_path / "walk.mp4", _walk(24))
    DAMAGES[damage](path)
    with pytest.raises(InputError) as caught:
        validate_capture(path, ScanOptions())
    assert "\n" not in str(caught.value) and str(path) in str(caught.value)


def test_a_promise_of_huge_pictures_takes_no_memory(tmp_path):
    path = _film(tmp_path / "walk.mp4", _walk(24))
    _huge(path)
    try:
        judged = validate_capture(path, ScanOptions())
    except InputError as error:
        assert "\n" not in str(error)
    else:  # The codec's own header tells the truth.
        assert judged.frames[0].colour_path.header().size == (WIDTH, HEIGHT)


def test_a_copy_that_broke_off_is_refused(tmp_path):
    """Matroska plays up to where it ends; its stated length gives the break away."""
    path = _film(tmp_path / "walk.mkv", _walk(240))
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 3])
    with pytest.raises(InputError) as caught:
        find_capture(path)
    assert "\n" not in str(caught.value)


def test_a_camera_that_stands_still_is_refused(tmp_path):
    path = _film(tmp_path / "still.mp4", np.full(40, 100))
    with pytest.raises(CaptureError, match="walk sideways"):
        find_capture(path)
