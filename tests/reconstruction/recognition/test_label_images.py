"""Label images: what a network's probabilities become, and the pictures that show them."""

import numpy as np
import pytest
from PIL import Image

from world2minecraft.core.types import Camera, View
from world2minecraft.reconstruction.recognition.label_images import (
    blend_classes,
    class_name,
    class_shares,
    depth_of_colour_camera,
    draw_overlay,
    most_likely_ids,
    nyu40_colours,
    segment_view,
    write_class_names,
)

CAMERA = Camera(64, 48, 50.0, 50.0, 32.0, 24.0)
WALL, FLOOR, BED = 1, 2, 4


class Fixed:
    """A network that gives the same probabilities for all images, and keeps what it was shown."""

    def __init__(self, probability):
        self.probability, self.shown = probability, []

    def predict(self, *shown):
        self.shown.append(shown)
        return self.probability


def likely(*ids, size=(6, 8), share=0.8):
    """Probabilities of upright stripes of classes, the rest shared by all others."""
    height, width = size
    found = np.full((height, width, 40), (1 - share) / 39, np.float32)
    for number, columns in zip(ids, np.array_split(np.arange(width), len(ids)), strict=True):
        found[:, columns, number - 1] = share
    return found


def coloured(**facts):
    return View("a", np.eye(4), np.full((48, 64, 3), 120, np.uint8), CAMERA, **facts)


def test_ids_have_the_size_of_the_photo():
    ids = segment_view(Fixed(likely(WALL, FLOOR)), coloured())
    assert ids.shape == (48, 64) and ids.dtype == np.uint8
    assert (ids[:, :32] == WALL).all() and (ids[:, 32:] == FLOOR).all()


def test_all_ids_from_1_to_40_are_given():
    found = np.eye(40, dtype=np.float32)[None]
    assert most_likely_ids(found, 40, 1).tolist() == [list(range(1, 41))]


def test_probabilities_are_interpolated_before_choosing():
    """Between two sure neighbours, a third class that is second in both is the most likely."""
    found = np.zeros((1, 2, 40), np.float32)
    found[0, 0, [WALL - 1, BED - 1]] = 0.55, 0.45
    found[0, 1, [FLOOR - 1, BED - 1]] = 0.55, 0.45
    ids = most_likely_ids(found, 20, 1)[0]
    assert ids[0] == WALL and ids[-1] == FLOOR
    assert (ids[9:11] == BED).all()


def test_pruned_classes_change_nothing():
    found = np.random.default_rng(0).dirichlet(np.full(40, 0.2), (9, 12)).astype(np.float32)
    planes = [
        np.asarray(Image.fromarray(plane).resize((50, 37), Image.Resampling.BILINEAR))
        for plane in np.ascontiguousarray(np.moveaxis(found, 2, 0))
    ]
    wanted = np.argmax(planes, axis=0) + 1
    assert (most_likely_ids(found, 50, 37) == wanted).all()


@pytest.mark.parametrize(("least", "known"), [(0.0, True), (0.79, True), (0.81, False), (1, False)])
def test_unlikely_pixels_are_unknown(least, known):
    ids = segment_view(Fixed(likely(BED)), coloured(), min_probability=least)
    assert (ids == (BED if known else 0)).all()


def test_the_network_is_shown_gravity_and_height():
    network, up = Fixed(likely(WALL)), np.array([0, -1.0, 0])
    segment_view(network, coloured(), up=up, camera_height_m=1.4)
    colour, depth_m, camera, shown_up, height_m = network.shown[0]
    assert colour.shape == (48, 64, 3) and depth_m is None and camera == CAMERA
    assert shown_up is up and height_m == 1.4


def test_a_view_without_colour_is_refused():
    depth = np.ones((48, 64), np.float32)
    view = View("a", np.eye(4), depth_m=depth, depth_camera=CAMERA)
    with pytest.raises(ValueError, match="has no colour"):
        segment_view(Fixed(likely(WALL)), view)


def test_depth_of_one_lens_is_passed_on():
    small = np.full((24, 32), 2, np.float32)
    view = coloured(depth_m=small, depth_camera=CAMERA.scaled_to(32, 24))
    assert depth_of_colour_camera(view) is view.depth_m
    assert depth_of_colour_camera(coloured()) is None


def test_depth_of_another_camera_is_projected():
    """A wall at 2 m, seen by a wider depth camera 10 cm behind the colour camera."""
    wide, back = Camera(320, 240, 160.0, 160.0, 160.0, 120.0), np.eye(4)
    back[2, 3] = -0.1
    depth = np.full((240, 320), 2.1, np.float32)
    view = coloured(depth_m=depth, depth_camera=wide, depth_to_colour=back)
    found = depth_of_colour_camera(view)
    assert found.dtype == np.float32 and found.shape == (120, 160)
    assert found[found > 0] == pytest.approx(2.0)
    assert (found > 0).mean() > 0.5


def test_colours_of_classes_are_far_apart():
    colours = nyu40_colours().astype(int)
    assert colours.shape == (41, 3) and not colours[0].any()
    apart = np.abs(colours[:, None] - colours[None]).sum(axis=2) + 1000 * np.eye(41, dtype=int)
    assert apart.min() >= 48


def test_an_overlay_has_a_legend_beside_the_photo():
    photo = np.full((1200, 1600, 3), 200, np.uint8)
    ids = np.full((1200, 1600), WALL, np.uint8)
    ids[:600] = 0
    drawn = np.asarray(draw_overlay(photo, ids))
    assert drawn.shape[0] == 960 and drawn.shape[1] > 1280
    assert (drawn[900, 20] == blend_classes(photo[:1, :1], ids[-1:, :1])[0, 0]).all()
    assert (drawn[100, 20] < 120).all()  # Unknown pixels are darkened.
    assert not (drawn[:60, 1280:] == 255).all() and (drawn[200:, 1280:] == 255).all()


def test_names_are_written_on_their_class():
    ids = np.full((300, 400), FLOOR, np.uint8)
    ids[:2, :2] = BED  # Too small for its name.
    image = Image.new("RGB", (400, 300), (90, 90, 90))
    write_class_names(image, ids)
    changed = np.argwhere((np.asarray(image) != 90).any(axis=2))
    assert len(changed) and np.abs(changed.mean(axis=0) - [150, 200]).max() < 15


def test_names_at_an_edge_stay_inside():
    ids = np.full((120, 160), FLOOR, np.uint8)
    ids[:, 150:] = 32
    image = Image.new("RGB", (160, 120), (90, 90, 90))
    write_class_names(image, ids)
    changed = np.argwhere((np.asarray(image) != 90).any(axis=2))
    assert changed[:, 1].max() < 159


def test_shares_name_the_largest_class_first():
    ids = np.array([[BED, BED, BED, 0]], np.uint8)
    assert class_shares(ids) == [(BED, 0.75), (0, 0.25)]
    assert [class_name(number) for number in (BED, 0, 40)] == ["bed", "unknown", "other prop"]
