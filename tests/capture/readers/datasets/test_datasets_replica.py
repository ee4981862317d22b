"""Replica as NICE-SLAM rendered it, written from that project's description."""

import json

import numpy as np
import pytest
from tests.capture.readers.datasets.writing import save, save_text, zipped

from world2minecraft.capture import open_scan
from world2minecraft.capture.format_detection import find_capture

CAMERA = {"w": 160, "h": 120, "fx": 130.0, "fy": 130.0, "cx": 79.5, "cy": 59.5, "scale": 6553.5}


def write_replica(folder, views, beside=True):
    lines = []
    for index, view in enumerate(views):
        save(folder / "results" / f"frame{index:06d}.png", view.colour)
        stored = np.round(view.depth_m * 6553.5).astype(np.uint16)
        save(folder / "results" / f"depth{index:06d}.png", stored)
        lines.append(" ".join(f"{value:.12e}" for value in view.camera_to_scan.reshape(-1)))
    save_text(folder / "traj.txt", "\n".join(lines) + "\n")
    place = folder if beside else folder.parent
    save_text(place / "cam_params.json", json.dumps({"camera": CAMERA}))


@pytest.mark.parametrize("beside", [True, False])
def test_a_room_gives_the_views_that_were_written(tmp_path, views, same_views, beside):
    write_replica(tmp_path / "room0", views, beside)
    scan = open_scan(tmp_path / "room0")
    assert (scan.source, scan.depth_kind) == ("replica", "exact")
    same_views(scan, views, depth_off=2e-4)


def test_a_zip_of_it_is_the_same(tmp_path, views, same_views):
    write_replica(tmp_path / "room0", views)
    same_views(open_scan(zipped(tmp_path, tmp_path / "a.zip")), views, depth_off=2e-4)


def test_without_parameters_the_published_camera_is_taken(tmp_path, views):
    write_replica(tmp_path, views)
    (tmp_path / "cam_params.json").unlink()
    capture = find_capture(tmp_path)
    assert "the intrinsics published for Replica" in capture.notes[0]
    assert capture.frames[0].depth_camera.width_px == 1200


def test_more_images_than_poses(tmp_path, views):
    write_replica(tmp_path, views)
    lines = (tmp_path / "traj.txt").read_text().splitlines()
    (tmp_path / "traj.txt").write_text("\n".join(lines[:10]))
    skipped = open_scan(tmp_path).frames_skipped
    assert skipped == tuple((f"frame{n:06d}", "has no line in traj.txt") for n in (10, 11))


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("traj.txt", "", "must contain 16 numbers per line"),
        ("traj.txt", "1 2 3\n", "must contain 16 numbers per line"),
        ("traj.txt", " ".join(["x"] * 16), "contains 'x' where a number is expected"),
        ("cam_params.json", "{}", "must contain w, h, fx"),
        ("cam_params.json", json.dumps({"camera": CAMERA | {"scale": 0}}), "each above 0"),
        ("cam_params.json", json.dumps({"camera": CAMERA | {"w": 1e9}}), "width_px must be 1 to"),
        ("cam_params.json", "[1]", "must contain w, h, fx"),
    ],
)
def test_damaged_rooms(tmp_path, views, refused, name, text, words):
    write_replica(tmp_path, views)
    (tmp_path / name).write_text(text)
    refused(tmp_path, words)
