"""The scale of a scan in an unknown unit: laws, generated rooms, known lengths, hostile words."""

from dataclasses import replace

import numpy as np
import pytest

from world2minecraft.capture.alignment.room_frame import ImplausibleRoomError
from world2minecraft.capture.scale import (
    KnownDistance,
    KnownLength,
    collect_unscaled,
    estimate_scale,
    length_between,
    parse_known_length,
    scale_points,
)
from world2minecraft.capture.scale.estimate import Posterior, main_mode
from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.types import View
from world2minecraft.procgen import room_views
from world2minecraft.procgen.benchmark_trials import find_trial


def shrunk(views, factor):
    """The views as photogrammetry would give them: all lengths in a unit of 1 / factor metres."""
    found = []
    for view in views:
        pose = view.camera_to_scan.copy()
        pose[:3, 3] *= factor
        depth = (view.depth_m * np.float32(factor)).astype(np.float32)
        found.append(View(view.name, pose, depth_m=depth, depth_camera=view.depth_camera))
    return found


@pytest.fixture(scope="module")
def box_surface(box_room):
    return collect_unscaled(box_room.views(24, noise_seed=3))


@pytest.mark.parametrize("factor", [0.05, 0.6, 17.0])
def test_a_box_room_is_measured_in_any_unit(box_room, factor):
    surface = collect_unscaled(shrunk(box_room.views(24, noise_seed=3), factor))
    found = estimate_scale(surface)
    assert found.scale * factor == pytest.approx(1, rel=0.08)
    assert 0.02 < found.sigma < 0.15
    assert found.sources[0] == "the camera height"
    assert "scale estimated from the camera height (1." in found.notes[0]


@pytest.mark.parametrize(("trial", "factor"), [("noise-501", 0.31), ("coverage-512", 4.7)])
def test_generated_rooms_within_15_percent(trial, factor):
    how = find_trial(trial)
    views = room_views(
        how.room(),
        frames=24,
        seed=how.seed,
        coverage=how.coverage,
        width=320,
        height=240,
    )
    found = estimate_scale(collect_unscaled(shrunk(views, factor), 1500))
    assert found.scale * factor == pytest.approx(1, rel=0.15)


def test_the_real_kitchen_within_15_percent(shared_data):
    from world2minecraft.capture import open_scan

    folder = shared_data / "redkitchen_rgbd"
    if not folder.is_dir():
        pytest.skip(f"the shared kitchen is not at {folder}")
    views = shrunk(list(open_scan(folder).views)[::3], 0.4)
    surface = collect_unscaled(views, 1500)
    assert estimate_scale(surface).scale * 0.4 == pytest.approx(1, rel=0.15)
    known = [parse_known_length("table height", 0.72), parse_known_length("counter-height", 0.90)]
    assert estimate_scale(surface, known[:1]).scale * 0.4 == pytest.approx(1, rel=0.03)
    assert estimate_scale(surface, known).scale * 0.4 == pytest.approx(1, rel=0.04)


def test_twice_the_unit_is_half_the_scale(box_surface):
    once, twice = estimate_scale(box_surface), estimate_scale(scale_points(box_surface, 2.0))
    assert twice.scale * 2 == pytest.approx(once.scale, rel=1e-6)
    assert twice.sigma == pytest.approx(once.sigma, rel=1e-4)
    assert scale_points(scale_points(box_surface, 3.0), 1 / 3).points_m == pytest.approx(
        box_surface.points_m
    )


def test_a_tilted_frame_changes_little(box_surface):
    tilt = np.eye(4)
    tilt[1:3, 1:3] = [[0.8, -0.6], [0.6, 0.8]]
    tilt[:3, 3] = [3.0, -2.0, 5.0]
    turned = box_surface.transformed(tilt @ rotation_about_z(70.0))
    assert estimate_scale(turned).scale == pytest.approx(
        estimate_scale(box_surface).scale, rel=0.02
    )


@pytest.mark.parametrize(
    ("name", "length_m", "within"),
    [
        ("table height", 0.72, 0.02),
        ("counter height", 0.9, 0.02),
        ("ceiling height", 2.6, 0.02),
        ("Room_Height", 2.6, 0.02),
        ("room length", 4.2, 0.02),
        ("room-width", 3.1, 0.02),
        ("camera height", 1.5, 0.04),
    ],
)
def test_a_known_length_gives_the_scale(box_surface, name, length_m, within):
    surface = scale_points(box_surface, 0.37)
    found = estimate_scale(surface, [parse_known_length(name, length_m)])
    assert found.scale * 0.37 == pytest.approx(1, rel=within)
    assert found.sigma <= 0.03
    assert f" ({length_m:g} m)" in found.notes[0]


def test_the_face_of_a_known_length_is_reported(box_surface):
    notes = estimate_scale(box_surface, [parse_known_length("table height", 0.72)]).notes
    assert "the given table height (0.72 m), a level face of" in notes[0]


def test_a_known_length_overrules_priors(box_surface):
    """A doll's house, or a hall: the user's word counts, and the cameras' height is told."""
    found = estimate_scale(box_surface, [parse_known_length("room height", 5.2)])
    assert found.scale == pytest.approx(2, rel=0.02)
    assert any("the cameras were" in text for text in found.notes)


def test_agreeing_lengths_lower_sigma_others_are_reported(box_surface):
    ceiling, side = (
        parse_known_length("ceiling height", 2.6),
        parse_known_length("room length", 4.2),
    )
    both = estimate_scale(box_surface, [ceiling, side])
    assert both.sources == ("ceiling height", "room length")
    odd = estimate_scale(box_surface, [ceiling, side, parse_known_length("room width", 3.6)])
    assert odd.scale == pytest.approx(1, rel=0.02)
    assert any("room width (3.6 m) contradicts the other lengths by 16 %" in t for t in odd.notes)


def test_two_clicked_points(box_room):
    views = box_room.views(6)
    known = KnownDistance("000000", (80, 60), "000003", (70.5, 40.2), 1.0).known(views)
    places = [lifted(views[0], 80, 60), lifted(views[3], 70.5, 40.2)]
    assert known.measured == pytest.approx(np.linalg.norm(places[0] - places[1]), rel=0.02)


def lifted(view, x, y):
    """The point under a pixel, by the definition of the pinhole camera."""
    camera, z = view.depth_camera, view.depth_m[int(y), int(x)]
    ray = np.linalg.inv(camera.matrix) @ [x, y, 1.0]
    return (view.camera_to_scan @ [*(ray * z), 1.0])[:3]


def test_points_far_apart_in_one_image_give_the_scale(box_room, box_surface):
    views = box_room.views(2)
    true = length_between(views, ("000000", (20, 60)), ("000000", (140, 60)))
    small = scale_points(box_surface, 0.25)
    points = KnownDistance("000000", (20, 60), "000000", (140, 60), true)
    found = estimate_scale(small, [points.known(shrunk(views, 0.25))])
    assert found.scale == pytest.approx(4, rel=1e-6)
    assert "given distance" in found.notes[0]


def test_points_without_depth_are_refused_in_words(box_room):
    views = box_room.views(2)
    depth = views[0].depth_m.copy()
    depth[50:70, 70:90] = 0
    views[0] = replace(views[0], depth_m=depth)
    ok = ("000001", (10.0, 10.0))
    for point, text in (
        (("000000", (80, 60)), "there is no depth at 80,60 in 000000"),
        (("000000", (800, 60)), "is outside image 000000"),
        (("other", (80, 60)), "no image is named 'other'"),
        (ok, "are identical"),
    ):
        with pytest.raises(UsageError, match=text):
            length_between(views, ok, point)


def test_a_hole_of_a_pixel_does_not_matter(box_room):
    views = box_room.views(2)
    whole = length_between(views, ("000000", (80, 60)), ("000001", (10, 10)))
    depth = views[0].depth_m.copy()
    depth[60, 80] = 0
    views[0] = replace(views[0], depth_m=depth)
    holed = length_between(views, ("000000", (80, 60)), ("000001", (10, 10)))
    assert holed == pytest.approx(whole, rel=0.01)


@pytest.mark.parametrize(
    ("name", "length", "error", "text"),
    [
        ("table hight", 0.7, UnknownNameError, "did you mean 'table height'"),
        (
            "table height",
            72,
            UsageError,
            "must be from 0.3 to 1.3 m, got 72; lengths are in metres",
        ),
        ("table height", float("nan"), UsageError, "must be from 0.3 to 1.3 m"),
        ("distance", 1.0, UsageError, "requires two points"),
        (
            "door-height",
            2.0,
            UsageError,
            "door height cannot be measured automatically; give two points",
        ),
        ("", 1.0, UnknownNameError, "known: "),
    ],
)
def test_bad_words_are_refused_with_what_to_type(name, length, error, text):
    with pytest.raises(error, match=text):
        parse_known_length(name, length)


def test_what_was_not_seen_cannot_be_known(box_room, box_surface):
    floor_only = box_surface.subset(box_surface.normals[:, 2] > 0.9)
    for name, length_m in (("ceiling height", 2.5), ("room length", 4.2)):
        with pytest.raises(UsageError, match="was seen|were seen"):
            estimate_scale(floor_only, [KnownLength(name, length_m)])


def test_too_little_surface_is_refused(box_surface):
    with pytest.raises(ImplausibleRoomError, match="at least 500 are required"):
        estimate_scale(box_surface.subset(np.arange(20)))
    assert len(collect_unscaled([]).points_m) == 0


def test_the_heavier_of_two_modes_is_taken_and_both_reported():
    """Two normal densities, three to two: the first's middle, and a sigma that spans both."""
    at = np.linspace(-1, 1, 801)
    one, other = np.exp(-0.5 * ((at - 0.3) / 0.05) ** 2), np.exp(-0.5 * ((at + 0.2) / 0.05) ** 2)
    found = main_mode(Posterior(at, np.log(0.6 * one + 0.4 * other + 1e-30)))
    assert np.log(found.scale) == pytest.approx(0.3, abs=0.01)
    assert found.rival is not None
    assert np.log(found.rival[0]) == pytest.approx(-0.2, abs=0.01)
    assert found.rival[1] == pytest.approx(0.4, abs=0.01)
    assert found.sigma == pytest.approx(np.sqrt(0.4 * 0.5**2 + 0.05**2), rel=0.02)


def test_one_mode_is_its_mean_and_deviation():
    at = np.linspace(-1, 1, 801)
    found = main_mode(Posterior(at, -0.5 * ((at - 0.1) / 0.08) ** 2))
    assert found.rival is None
    assert np.log(found.scale) == pytest.approx(0.1, abs=1e-3)
    assert found.sigma == pytest.approx(0.08, rel=1e-3)
