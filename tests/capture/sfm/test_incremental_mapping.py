"""Places found from pixels alone, in a box room whose truth is known."""

import numpy as np
import pytest
from tests.capture.sfm.box_room import CAMERA, photos, poses

from world2minecraft.capture.sfm import SfmParameters, align_similarity, find_poses, matching
from world2minecraft.core.errors import CaptureError, LimitError
from world2minecraft.core.types import SparseScene
from world2minecraft.core.types.photos import Photo

SMALL = SfmParameters(working_px=76_800, most_features=800)


def bytes_of(scene: SparseScene) -> bytes:
    arrays = (
        scene.camera_to_scan,
        scene.points_m,
        scene.colour,
        scene.track_frame,
        scene.track_point,
        scene.track_px,
    )
    said = repr((scene.names, scene.cameras, scene.left_out, scene.notes, scene.facts))
    return b"".join(array.tobytes() for array in arrays) + said.encode()


@pytest.fixture(scope="module")
def found():
    return find_poses(photos(poses()), SMALL)


def test_poses_are_found_up_to_a_similarity(found):
    assert found.names == tuple(f"{i:03d}" for i in range(10)) and found.left_out == ()
    off = align_similarity(found.camera_to_scan, poses())
    assert off.off_m.max() < 0.004 and off.off_deg.max() < 0.1
    assert found.error_px < 0.2


def test_the_lens_is_found(found):
    assert found.cameras[0].fx_px == pytest.approx(CAMERA.fx_px, rel=0.01)
    assert found.facts["focal_given"] == "unknown"


def test_the_median_depth_is_that_of_a_room(found):
    inverse = np.linalg.inv(found.camera_to_scan)[found.track_frame]
    seen = found.points_m[found.track_point].astype(float)
    depth = (inverse[:, 2, :3] * seen).sum(axis=1) + inverse[:, 2, 3]
    assert np.median(depth) == pytest.approx(2.5, rel=1e-3)


def test_points_lie_on_the_walls(found):
    change = align_similarity(found.camera_to_scan, poses())
    points = change.points(found.points_m.astype(float))
    to_wall = np.minimum(np.abs(points), np.abs(points - [4.0, 3.2, 2.4])).min(axis=1)
    assert np.median(to_wall) < 0.01


def test_observations_are_where_points_are_seen(found):
    camera = found.cameras[0]
    inverse = np.linalg.inv(found.camera_to_scan)[found.track_frame]
    seen = found.points_m[found.track_point].astype(float)
    local = np.einsum("tab,tb->ta", inverse[:, :3, :3], seen) + inverse[:, :3, 3]
    pixels = camera.fx_px * local[:, :2] / local[:, 2:] + [camera.cx_px, camera.cy_px]
    assert np.median(np.linalg.norm(pixels - found.track_px, axis=1)) < 0.3


def test_the_same_bytes_again_whatever_the_threads(found, monkeypatch, capfd):
    monkeypatch.setattr(matching, "thread_count", lambda: 1)
    told = []
    again = find_poses(photos(poses()), SMALL, lambda *step: told.append(step))
    assert bytes_of(again) == bytes_of(found)
    assert capfd.readouterr() == ("", "")
    assert {stage for stage, *_ in told} == {"poses"} and told[-1][1] == told[-1][2]


def test_a_photo_of_elsewhere_is_left_out_with_a_reason(found):
    # The first seven, and one of another room among them.
    some = photos(poses())[:7]
    other = photos(poses()[3:4], seed=7)[0]
    scene = find_poses([*some[:4], Photo("elsewhere", other.colour), *some[4:]], SMALL)
    assert len(scene.names) == 7
    assert dict(scene.left_out) == {
        "elsewhere": (
            "has no details in common with the other photos; take more photos between elsewhere "
            "and 003"
        )
    }


def blank(count: int) -> list[Photo]:
    return [Photo(f"{i}", np.full((240, 320, 3), 128, np.uint8)) for i in range(count)]


def of_different_places() -> list[Photo]:
    return [
        Photo(f"{seed}", photos(poses()[seed : seed + 1], seed=20 + seed)[0].colour)
        for seed in range(3)
    ]


HABIT = "move sideways around the room so that each photo overlaps the next by more than half"


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: [], f"photos: there are no photos; take 20 to 60 photos of the room: {HABIT}"),
        (
            lambda: photos(poses()[:2]),
            f"photos: there are only 2 photos; take 20 to 60 photos of the room: {HABIT}",
        ),
        (
            lambda: blank(5),
            "photos: 5 of 5 photos show too few details (blank, blurred or dark); switch on "
            "the lights, and step back to show furniture and corners",
        ),
        (of_different_places, f"photos: no three of the 3 photos show the same objects; {HABIT}"),
        (
            lambda: [*photos(poses()[:2]), photos(poses()[:1])[0]],
            "photos: two photos have the name '000'; give each photo a unique name",
        ),
    ],
)
def test_refusals(make, message):
    with pytest.raises(CaptureError) as caught:
        find_poses(make(), SMALL)
    assert str(caught.value) == message


def test_a_camera_that_only_rotated_is_reported():
    places = poses()[:4].copy()
    places[:, :3, 3] = places[0, :3, 3]
    with pytest.raises(CaptureError) as caught:
        find_poses(photos(places), SMALL)
    assert str(caught.value) == (
        "photos: the camera only rotated, which gives no depth; move 20 to 40 cm sideways "
        "between photos"
    )


def test_too_many_photos_are_refused_before_any_is_read():
    class Many:
        def __len__(self):
            return 100_000

        def __iter__(self):
            raise AssertionError("must not be read")

    with pytest.raises(LimitError, match="got 100000 photos, the limit is 3000"):
        find_poses(Many(), SMALL)
