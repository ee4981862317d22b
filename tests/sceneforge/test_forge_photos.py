"""Photos stand where they were taken: their pixels lie on the room's cells."""

import io
import shutil

import numpy as np
import pytest
from forge_runs import FRAMES
from forge_serving import client, served, small_editor
from PIL import Image

from world2minecraft.capture.depth_images import read_depth
from world2minecraft.core.coordinates import apply
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.types import Camera
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.geometry.undistort import undistort_image
from world2minecraft.geometry.unprojection import project
from world2minecraft.reconstruction.recognition.label_images import blend_classes
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.photo_classes import PhotoClasses
from world2minecraft.sceneforge.run_photos import find_capture_of, ideal_camera, read_photos


@pytest.fixture(scope="module")
def photos(small_run):
    scan_to_room = read_room(small_run / "room.npz")[1]
    return read_photos(small_run, small_run / "capture", scan_to_room)


def test_all_frames_of_the_run_are_there(photos):
    told = photos.as_json()
    assert [row["n"] for row in told] == list(range(FRAMES))
    assert len({row["name"] for row in told}) == FRAMES
    assert all(20 < row["vertical_fov_deg"] < 120 and not row["is_depth"] for row in told)


def test_what_a_photo_shows_stands_where_the_room_has_cells(photos, small_run):
    """Depth seen through the ideal camera, at the told pose, falls on occupied cells."""
    grid = read_room(small_run / "room.npz")[0]
    near = np.zeros(grid.shape, bool)
    for shift in np.ndindex(3, 3, 3):
        near |= np.roll(grid.occupied, np.array(shift) - 1, (0, 1, 2))
    shares = []
    for photo, told in zip(photos.photos, photos.as_json(), strict=True):
        depth = read_depth(photo.frame.depth_path, photos.encoding)
        height, width = depth.shape
        focal = height / 2 / np.tan(np.radians(told["vertical_fov_deg"]) / 2)
        v, u = np.nonzero(depth > 0)
        z = depth[v, u]
        x, y = (u + 0.5 - width / 2) / focal * z, (v + 0.5 - height / 2) / focal * z
        points_m = apply(np.array(told["camera_to_room"]), np.column_stack([x, y, z]))
        cells = np.floor((points_m - grid.origin_m) / grid.voxel_m).astype(int)
        inside = ((cells >= 0) & (cells < grid.shape)).all(axis=1)
        shares.append((near[tuple(cells[inside].T)]).sum() / len(cells))
    assert np.median(shares) > 0.9, shares


def test_the_scene_says_what_is_beside_it(small_run):
    with served(Editor.open(small_run)) as server, client(server) as script:
        told = script.get("/api/scene").json()["has"]
    assert told == {"photos": FRAMES, "truth": True}
    with served(small_editor()) as server, client(server) as script:
        assert script.get("/api/scene").json()["has"] == {"photos": 0, "truth": False}


def test_corrections_move_the_photos(photos, small_run, tmp_path):
    bare = tmp_path / "bare"
    shutil.copytree(small_run, bare, ignore=shutil.ignore_patterns("build"))
    (bare / "poses.npz").unlink()
    scan_to_room = read_room(small_run / "room.npz")[1]
    without = read_photos(bare, bare / "capture", scan_to_room)
    moved = [
        np.abs(a.camera_to_room - b.camera_to_room).max()
        for a, b in zip(photos.photos, without.photos, strict=True)
    ]
    assert 1e-6 < max(moved) < 0.1


def test_an_ideal_camera_sees_each_ray_where_it_says():
    """A picture whose pixels hold the tangents of their rays, through a lens that bends them."""
    camera = Camera(320, 240, 250.0, 260.0, 150.0, 131.0, (0.08, -0.05, 0.001, -0.002, 0.0))
    ideal = ideal_camera(camera, 256)
    assert (ideal.fx_px, ideal.cx_px) == (ideal.fy_px, ideal.width_px / 2)
    assert ideal.cy_px == ideal.height_px / 2 and max(ideal.width_px, ideal.height_px) <= 256
    tangents = np.linspace(-0.3, 0.3, 40)
    rays = np.stack(np.broadcast_arrays(*np.meshgrid(tangents, tangents), 1.0), axis=-1)
    at_px = project(rays, camera)
    drawn = np.zeros((240, 320, 3), np.uint8)
    drawn[..., 0] = 100
    for u, v in at_px.reshape(-1, 2).astype(int):
        drawn[v - 1 : v + 2, u - 1 : u + 2] = 255
    seen = undistort_image(drawn, camera, ideal)
    wanted = project(rays, ideal).reshape(-1, 2).astype(int)
    inside = ((wanted >= 1) & (wanted < (ideal.width_px - 1, ideal.height_px - 1))).all(axis=1)
    lit = seen[..., 1].astype(int)
    assert inside.sum() > 1000
    assert (lit[wanted[inside, 1], wanted[inside, 0]] > 128).mean() > 0.97


def test_pictures_have_the_proportions_that_were_told(photos):
    for number in (0, FRAMES - 1):
        whole = Image.open(io.BytesIO(photos.jpeg(number, False)))
        assert whole.width / whole.height == pytest.approx(photos.as_json()[number]["aspect"])
        assert max(Image.open(io.BytesIO(photos.jpeg(number, True))).size) <= 200
    with pytest.raises(UnknownNameError, match="no photo is named '99'"):
        photos.jpeg(99, True)


def test_classes_of_photos_are_drawn_on_demand(photos):
    """The network sees the undistorted photo, its depth, gravity and the height of the camera."""
    shown = []

    class Doors:
        def predict(self, colour, depth_m, camera, up=None, camera_height_m=None):
            shown.append((colour, depth_m, camera, up, camera_height_m))
            return np.eye(40, dtype=np.float32)[[[7] * 4] * 3]

    drawn = PhotoClasses(photos, Doors())
    first = drawn.jpeg(2)
    assert drawn.jpeg(2) is first and len(shown) == 1
    colour, depth_m, camera, up, height_m = shown[0]
    assert camera == photos.photos[2].ideal and (depth_m > 0).any()
    assert up[1] < -0.7 and 0.8 < height_m < 2.2
    image = np.asarray(Image.open(io.BytesIO(first)), float)
    assert image.shape == colour.shape
    wanted = blend_classes(colour, np.full(colour.shape[:2], 8, np.uint8))
    assert np.median(np.abs(image - wanted)) < 4
    with pytest.raises(UnknownNameError, match="no photo is named '99'"):
        drawn.jpeg(99)


def test_a_run_that_does_not_say_where_its_photos_lie_says_so(tmp_path):
    with pytest.raises(UsageError, match="--capture PATH_OF_THE_CAPTURE"):
        find_capture_of(tmp_path / "OUT", None)


def test_the_page_gets_photos_and_their_poses(small_run, tmp_path):
    with served(Editor.open(small_run), home=tmp_path) as server, client(server) as script:
        told = script.get("/api/photos").json()
        assert len(told["frames"]) == FRAMES and told["why"] == ""
        small = script.get("/api/photos/3/small.jpg")
        assert small.headers["content-type"] == "image/jpeg" and small.content[:2] == b"\xff\xd8"
        assert script.get("/api/photos/3/picture.jpg").status_code == 200
        assert script.get("/api/photos/99/picture.jpg").status_code == 400
        classes = script.get("/api/photos/3/classes.jpg")
        assert classes.headers["content-type"] == "image/jpeg" and len(classes.content) > 1000
        assert script.get("/api/photos/99/classes.jpg").status_code == 400


def test_a_room_without_photos_says_why(tmp_path):
    editor = small_editor(folder=tmp_path / "OUT")
    with served(editor, home=tmp_path) as server, client(server) as script:
        told = script.get("/api/photos").json()
    assert told["frames"] == [] and "--capture" in told["why"]


def test_a_capture_that_was_given_once_is_remembered(small_run, tmp_path):
    bare = tmp_path / "bare"
    shutil.copytree(small_run, bare, ignore=shutil.ignore_patterns("build", "capture"))
    home, capture = tmp_path / "home", small_run / "capture"
    with served(Editor.open(bare), home=home, capture=capture) as server, client(server) as script:
        assert len(script.get("/api/photos").json()["frames"]) == FRAMES
    with served(Editor.open(bare), home=home) as server, client(server) as script:
        assert len(script.get("/api/photos").json()["frames"]) == FRAMES
