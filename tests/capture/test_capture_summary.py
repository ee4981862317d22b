"""What ``w2m scan`` finds out: each doubt appears where it must, and not where it must not."""

import shlex
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image, ImageFilter

from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.quality import diagnostics
from world2minecraft.capture.quality.picture_quality import (
    _high_pass,
    overlap_share,
    sharpness,
    textureless_share,
)
from world2minecraft.capture.quality.view_directions import (
    SECTORS,
    count_view_directions,
    estimate_up,
)
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.capture.summary import describe_validated, summary_lines, summary_to_json
from world2minecraft.capture.validation import validate
from world2minecraft.core.coordinates import look_at
from world2minecraft.core.types import Camera

CAMERA = Camera(160, 120, 130.0, 130.0, 80.0, 60.0)


def texture(seed=0, size=(120, 480)):
    """A wide wall full of things, uint8 [H, W, 3], of which pictures are cut."""
    rng = np.random.default_rng(seed)
    image = np.full((*size, 3), 120, np.uint8)
    for _ in range(400):
        y, x = rng.integers(0, size[0]), rng.integers(0, size[1])
        image[y : y + rng.integers(3, 16), x : x + rng.integers(3, 24)] = rng.integers(0, 255, 3)
    return image


def save(folder, pictures):
    folder.mkdir(exist_ok=True)
    paths = []
    for index, picture in enumerate(pictures):
        paths.append(folder / f"{index:03d}.png")
        Image.fromarray(picture).save(paths[-1])
    return paths


def photos(tmp_path, pictures, **fields):
    """A capture of photos of which nothing is known."""
    frames = tuple(FrameFiles(path.stem, None, path) for path in save(tmp_path, pictures))
    return describe_validated(
        validate(Capture(tmp_path, "photos", frames, **fields), ScanOptions())
    )


def panned(step=30, count=10, seed=0):
    wall = texture(seed)
    return [wall[:, index * step : index * step + 160] for index in range(count)]


RENDERED = {}


def rendered(room, pose):
    """The box room from a place; the same places are asked for often."""
    key = pose.tobytes()
    if key not in RENDERED:
        RENDERED[key] = room.render(pose)
    return RENDERED[key]


def posed(tmp_path, room, poses, depth=True, change=lambda frame, index: frame, **fields):
    """A capture of the box room from some places, in the room's own frame."""
    frames = []
    source = fields.pop("source", "test")
    (tmp_path / "d").mkdir(exist_ok=True)
    for index, pose in enumerate(poses):
        metres, colour = rendered(room, pose)
        (path,) = save(tmp_path / f"c{index}", [colour])
        frame = FrameFiles(f"{index:03d}", pose, path, CAMERA)
        if depth:
            place = tmp_path / "d" / f"{index:03d}.png"
            Image.fromarray((metres * 1000).astype(np.uint16)).save(place)
            frame = replace(frame, depth_path=place, depth_camera=CAMERA)
        frames.append(change(frame, index))
    fields = {"depth_unit": "mm", **fields}
    return describe_validated(
        validate(Capture(tmp_path, source, tuple(frames), **fields), ScanOptions())
    )


def level_of(summary, about):
    """The level of the doubt about something; None where there is none."""
    return next(
        (diagnostic.level for diagnostic in summary.diagnostics if diagnostic.about == about), None
    )


@pytest.fixture(scope="module")
def whole(box_room, tmp_path_factory):
    return posed(tmp_path_factory.mktemp("whole"), box_room, box_room.poses(24))


def test_a_good_scan_has_no_warning(whole):
    assert whole.route.kind == "rgbd"
    assert [diagnostic.level for diagnostic in whole.diagnostics] == ["ok"] * len(whole.diagnostics)
    np.testing.assert_allclose(sorted(whole.room_size_m), sorted((4.2, 3.1, 2.6)), atol=0.05)


def test_the_text_of_a_good_scan(whole):
    lines = "\n".join(summary_lines(whole)).replace(str(whole.folder), "SCAN")
    assert lines == (
        "SCAN: posed RGB-D frames (test), 24 of 24 frames usable\n"
        "  route     depth and poses are used as stated: about 10 s\n"
        "  colour    160x120, focal length 130 px\n"
        "  depth     160x120, focal length 130 px, millimetres, median 2.1 m\n"
        "  poses     24 valid, 0 lost, camera positions span 1.0 m\n"
        f"  room      about {' x '.join(f'{side:.1f}' for side in whole.room_size_m)} m\n"
        "  ok        floor, ceiling and all four walls were detected\n"
        "  ok        all 24 sampled images are sharp\n"
        "  ok        depth from 0.9 to 2.8 m, 0% missing\n"
        "  ok        all horizontal directions are covered\n"
        "next: w2m reconstruct SCAN --out OUT"
    )


def test_the_text_of_photos(tmp_path):
    lines = "\n".join(summary_lines(photos(tmp_path, panned()))).replace(str(tmp_path), "PHOTOS")
    assert lines == (
        "PHOTOS: photos without poses (photos), 10 of 10 frames usable\n"
        "  route     poses and depth are computed from the images: about 20 s\n"
        "  colour    160x120, focal length estimated with the poses\n"
        "  depth     none; computed from the images\n"
        "  poses     none; computed from the images\n"
        "  warning   only 10 images; use 40 to 100 from all directions: take more images, each "
        "sharing two thirds with the previous image\n"
        "  warning   the capture has no scale; the size is estimated from typical "
        'heights: measure one length and set it, for example --known "table height" 0.72\n'
        "  ok        all 10 sampled images are sharp\n"
        "  ok        neighbouring images overlap by about 81%\n"
        "next: w2m reconstruct PHOTOS --out OUT"
    )


def test_the_text_of_posed_pictures(tmp_path, box_room):
    summary = posed(tmp_path, box_room, box_room.poses(24), depth=False)
    lines = "\n".join(summary_lines(summary)).replace(str(tmp_path), "POSED").splitlines()
    assert lines[:5] == [
        "POSED: images with poses, without depth (test), 24 of 24 frames usable",
        "  route     poses are checked and depth is computed from the images: about 30 s",
        "  colour    160x120, focal length 130 px",
        "  depth     none; computed from the images",
        "  poses     24 valid, 0 lost, camera positions span 1.0 m",
    ]


def test_the_routes(tmp_path, box_room):
    poses = box_room.poses(24)
    exact = {"depth_kind": "exact"}
    solid = posed(tmp_path / "a", box_room, poses, source="solid (PLY)", **exact)
    assert solid.route.kind == "solid"
    assert posed(tmp_path / "a", box_room, poses, source="replica", **exact).route.kind == "rgbd"
    unposed = posed(
        tmp_path / "b", box_room, poses, change=lambda f, i: replace(f, camera_to_world=None)
    )
    assert unposed.route.kind == "unposed rgbd"
    assert "scale from the depth" in unposed.route.words
    paths = save(tmp_path / "v", panned())
    frames = tuple(FrameFiles(p.stem, None, p, time_s=i / 2) for i, p in enumerate(paths))
    video = describe_validated(validate(Capture(tmp_path, "video", frames), ScanOptions()))
    assert video.route.kind == "video"
    dated = describe_validated(validate(Capture(tmp_path, "photos", frames), ScanOptions()))
    assert dated.route.kind == "photos", "photos whose EXIF says when they were taken are no video"


def test_the_next_command_can_be_typed_as_it_is(tmp_path):
    place = tmp_path / "my room"
    place.mkdir()
    frames = tuple(FrameFiles(p.stem, None, p) for p in save(place, panned()))
    options = {"frames": "60", "unit": "cm"}
    command = describe_validated(
        validate(Capture(place, "photos", frames), ScanOptions()), options
    ).next_command
    settings = ["--set", "capture.frames=60", "--set", "capture.unit=cm"]
    assert shlex.split(command) == ["w2m", "reconstruct", str(place), "--out", "OUT", *settings]


@pytest.fixture(autouse=True)
def _folders(tmp_path):
    for name in "ab":
        (tmp_path / name).mkdir(exist_ok=True)


def test_too_few(tmp_path, box_room):
    assert level_of(photos(tmp_path / "p", panned(count=2)), "few") == "stop"
    assert level_of(photos(tmp_path / "q", panned(count=5)), "few") == "warn"
    assert level_of(photos(tmp_path / "r", panned(12, count=25)), "few") is None
    assert level_of(posed(tmp_path / "a", box_room, box_room.poses(6)), "few") == "warn"


def test_blur_is_detected_relative_to_the_others(tmp_path):
    pictures = panned(10, count=24)
    for index in range(0, 24, 5):
        soft = Image.fromarray(pictures[index]).filter(ImageFilter.GaussianBlur(3))
        pictures[index] = np.asarray(soft)
    summary = photos(tmp_path / "p", pictures)
    assert level_of(summary, "blur") == "warn"
    assert "5 of 24 sampled images are blurred: image 000, image 005, image 010" in " ".join(
        summary.warnings
    )
    pictures[5:] = panned(10, count=24)[5:]
    assert level_of(photos(tmp_path / "q", pictures), "blur") == "ok"


def test_sharpness_falls_with_blur_along_one_direction_too():
    grey = texture()[..., 0].astype(np.float32)
    shaken = np.mean([np.roll(grey, shift, 1) for shift in range(7)], axis=0)
    assert sharpness(shaken) < 0.3 * sharpness(grey)
    assert sharpness(np.full((40, 40), 9.0, np.float32)) == 0
    assert sharpness(grey * 0.5) == pytest.approx(sharpness(grey), rel=0.01)


def test_dark_and_bare_pictures(tmp_path):
    wall = panned(10, count=24)
    summary = photos(tmp_path / "p", [picture // 8 for picture in wall[:4]] + wall[4:])
    assert level_of(summary, "dark") == "warn"
    bare = [np.full((120, 160, 3), 180, np.uint8)] * 10
    assert level_of(photos(tmp_path / "q", wall[:14] + bare), "bare") == "warn"
    assert level_of(photos(tmp_path / "r", wall), "dark") is None
    assert level_of(photos(tmp_path / "r", wall), "bare") is None
    assert textureless_share(np.full((64, 64), 9.0, np.float32)) == 1


def test_low_overlap(tmp_path):
    apart = [texture(seed, (120, 160)) for seed in range(12)]
    assert level_of(photos(tmp_path / "p", apart), "overlap") == "warn"
    assert level_of(photos(tmp_path / "q", panned()), "overlap") == "ok"


@pytest.mark.parametrize("step", [0, 16, 48, 80])
def test_the_shared_part_of_two_pictures_is_measured(step):
    wall = texture(3)
    one, other = wall[:, :160], wall[:, step : step + 160]
    assert overlap_share(_high_pass(one), _high_pass(other)) == pytest.approx(
        1 - step / 160, abs=0.08
    )


def test_pictures_of_other_shapes_are_not_compared():
    upright = np.ascontiguousarray(np.swapaxes(texture()[:, :160], 0, 1))
    assert np.isnan(overlap_share(_high_pass(texture()[:, :160]), _high_pass(upright)))


def test_turning_on_the_spot(tmp_path, box_room):
    eye = np.array([2.0, 0.9, 1.5])
    angles = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    turned = [look_at(eye, eye + np.array([np.cos(a), np.sin(a), -0.2])) for a in angles]
    assert level_of(posed(tmp_path / "a", box_room, turned), "turning") == "warn"
    assert level_of(posed(tmp_path / "b", box_room, turned, depth=False), "turning") == "stop"


def test_gaps_floor_and_ceiling(tmp_path, box_room):
    eyes = [np.array([1.0 + 0.1 * index, 0.6, 1.5]) for index in range(12)]
    north = [look_at(eye, eye + np.array([0, 1, 0.0])) for eye in eyes]
    one_way = posed(tmp_path / "a", box_room, north, depth=False)
    assert level_of(one_way, "gap") == level_of(one_way, "no floor") == "warn"
    assert level_of(one_way, "no ceiling") == "warn"
    text = next(diagnostic.text for diagnostic in one_way.diagnostics if diagnostic.about == "gap")
    assert "south" in text
    assert "north," not in text
    assert level_of(posed(tmp_path / "b", box_room, box_room.poses(24), depth=False), "gap") == "ok"


def test_what_the_alignment_did_not_meet_has_its_compass_name(tmp_path, box_room):
    eyes = [np.array([1.2 + 0.1 * index, 0.6, 1.5]) for index in range(12)]
    down = [look_at(eye, eye + np.array([0.2 - 0.03 * i, 1, -0.5])) for i, eye in enumerate(eyes)]
    summary = posed(tmp_path / "a", box_room, down)
    texts = " ".join(summary.warnings)
    assert "no wall was seen at" in texts
    assert "x+" not in texts
    assert level_of(summary, "no ceiling") == "warn"


def test_scale_lens_and_extras(tmp_path, box_room, monkeypatch):
    poses = box_room.poses(24)
    unknown = posed(tmp_path / "a", box_room, poses, depth=False, scale="unknown")
    assert level_of(unknown, "scale") == "warn"
    assert '--known "table height" 0.72' in summary_lines(unknown)[-2] + " ".join(
        summary_lines(unknown)
    )
    metric = posed(tmp_path / "a", box_room, poses, depth=False)
    assert level_of(metric, "scale") is None
    assert level_of(metric, "extra") is None
    monkeypatch.setattr(diagnostics, "is_installed", lambda module: False)
    lacking = posed(tmp_path / "a", box_room, poses, depth=False)
    assert level_of(lacking, "extra") == "stop"
    assert "pip install 'world2minecraft[capture]'" in " ".join(summary_lines(lacking))


def test_holes_and_low_trust(tmp_path, box_room, whole):
    def holed(frame, index):
        raw = np.asarray(Image.open(frame.depth_path)).copy()
        raw[:80] = 0
        Image.fromarray(raw).save(frame.depth_path)
        trust = tmp_path / f"t{index}.png"
        Image.fromarray(np.full(raw.shape, 60, np.uint8)).save(trust)
        return replace(frame, trust_path=trust)

    summary = posed(tmp_path / "a", box_room, box_room.poses(24), change=holed)
    assert level_of(summary, "holes") == level_of(summary, "trust") == "warn"
    assert level_of(whole, "holes") is level_of(whole, "trust") is None


def test_lost_poses_and_no_colour(tmp_path, box_room, whole):
    def worse(frame, index):
        pose = np.full((4, 4), np.nan) if index % 3 == 0 else frame.camera_to_world
        return replace(frame, camera_to_world=pose, colour_path=None, colour_camera=None)

    summary = posed(tmp_path / "a", box_room, box_room.poses(24), change=worse)
    assert (summary.usable, summary.lost_poses) == (16, 8)
    assert level_of(summary, "left out") == "warn"
    assert level_of(summary, "colour") == "warn"
    assert level_of(whole, "left out") is level_of(whole, "colour") is None


def test_one_matrix_is_reported_and_no_room_stops(tmp_path, box_room):
    assert (
        level_of(posed(tmp_path / "a", box_room, box_room.poses(24), one_matrix=True), "one matrix")
        == "ok"
    )
    huge = posed(tmp_path / "b", box_room, box_room.poses(24), depth_unit="0.0002")
    assert level_of(huge, "room") == "stop"
    assert huge.room_size_m is None


def test_view_directions_of_one_picture():
    seen = count_view_directions([CAMERA], look_at(np.zeros(3), np.array([0, 1.0, 0]))[None])
    assert seen.seen[8:10, [0, -1]].all()
    assert "south" in seen.gaps()
    assert "north" not in seen.gaps()
    assert seen.share_below() == 0
    assert len(seen.sectors()) == len(SECTORS)


def test_up_of_cameras_is_found_in_any_frame(box_room):
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    poses = np.array(box_room.poses(24))
    poses[:, :3, :] = turn @ poses[:, :3, :]
    assert estimate_up(poses) @ turn[:, 2] > 0.999
    assert estimate_up(poses[:1]) @ turn[:, 2] > 0.5


def test_the_json_is_plain(whole):
    import json

    data = json.loads(json.dumps(summary_to_json(whole)))
    assert data["route"]["kind"] == "rgbd"
    assert data["doubts"][0].keys() == {"level", "about", "text", "advice"}
    assert "survey" not in data
