"""Poses of a survey: the room is that of near poses, and the shift can be undone."""

from dataclasses import replace

import numpy as np
from tests.capture.layouts import write_plain

from world2minecraft.capture.open_scan import open_scan
from world2minecraft.core.coordinates import apply
from world2minecraft.core.files import read_json
from world2minecraft.formats.scan_record import write_scan


def test_a_surveyed_capture_is_the_near_one_and_stores_its_shift(tmp_path, box_room):
    views = box_room.views(12)
    shift = np.eye(4)
    shift[:3, 3] = [450_012.5, 5_399_996.75, 100.5]
    write_plain(tmp_path / "near", views)
    write_plain(
        tmp_path / "far",
        [replace(view, camera_to_scan=shift @ view.camera_to_scan) for view in views],
    )
    near, far = open_scan(tmp_path / "near"), open_scan(tmp_path / "far")
    assert np.allclose(far.room_size_m, near.room_size_m, atol=1e-3)
    write_scan(tmp_path / "scan.json", far)
    stored = read_json(tmp_path / "scan.json")
    source_to_room = np.array(stored["scan_to_room"]) @ np.array(stored["source_to_scan"])
    camera = views[3].camera_to_scan[:3, 3]
    in_room = apply(source_to_room, apply(shift, camera))
    assert np.allclose(in_room, apply(near.scan_to_room, camera), atol=2e-3)
    assert any("georeferenced" in note for note in far.notes)
