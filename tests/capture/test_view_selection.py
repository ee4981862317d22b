"""Views of long recordings: those that show what others show are left out."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.capture import open_scan, write_plain
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.capture.view_selection import ENOUGH, LONG, NEAR_DEG, NEAR_M, select_views


def frame(number: int, place, yaw_deg: float) -> FrameFiles:
    angle = np.radians(yaw_deg)
    pose = np.eye(4)
    pose[:3, :3] = [
        [np.cos(angle), 0, np.sin(angle)],
        [0, 1, 0],
        [-np.sin(angle), 0, np.cos(angle)],
    ]
    pose[:3, 3] = place
    return FrameFiles(f"{number:04d}", pose)


def selected_slowly(frames):
    """Return the names that the rule selects, pair by pair."""
    chosen = []
    for one in frames:
        like = 0
        for other in chosen:
            apart = np.linalg.norm(one.camera_to_world[:3, 3] - other.camera_to_world[:3, 3])
            turn = one.camera_to_world[:3, :3] @ other.camera_to_world[:3, :3].T
            angle = np.degrees(np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1)))
            like += bool(apart < NEAR_M and angle < NEAR_DEG)
        if like < ENOUGH:
            chosen.append(one)
    return [one.name for one in chosen]


@given(st.integers(0, 10**6), st.floats(0.01, 0.3), st.floats(0.1, 15))
def test_walks_are_selected_as_the_slow_rule_selects(seed, step_m, step_deg):
    rng = np.random.default_rng(seed)
    places = np.cumsum(rng.normal(0, step_m, (LONG + 20, 3)), axis=0)
    yaws = np.cumsum(rng.normal(0, step_deg, LONG + 20))
    frames = [frame(n, *at) for n, at in enumerate(zip(places, yaws, strict=True))]
    assert [one.name for one in select_views(frames)] == selected_slowly(frames)


def test_short_captures_are_whole():
    frames = [frame(n, (0, 0, 0), 0) for n in range(LONG)]
    assert select_views(frames) == tuple(frames)


def test_a_camera_at_rest_is_used_a_few_times():
    frames = [frame(n, (1, 2, 3), 30) for n in range(LONG + 1)]
    assert select_views(frames) == tuple(frames[:ENOUGH])


def test_frames_with_labels_are_not_left_out_for_others():
    frames = [frame(n, (0, 0, 0), 0) for n in range(LONG + 1)]
    frames[-1] = replace(frames[-1], labels_path=Path("labels/0100.png"))
    assert select_views(frames) == (*frames[:ENOUGH], frames[-1])


def test_places_and_turns_apart_are_all_used():
    apart = [frame(n, (n * NEAR_M * 1.01, 0, 0), 0) for n in range(LONG + 1)]
    turned = [frame(n, (0, 0, 0), n * 360 / 30) for n in range(30)] * 4
    assert select_views(apart) == tuple(apart)
    assert len(select_views(turned)) == 30 * ENOUGH


def test_a_long_recording_is_opened_with_the_selected_views(tmp_path, box_room):
    views = [replace(view, name=f"{n:04d}") for n, view in enumerate(list(box_room.views(12)) * 9)]
    write_plain(tmp_path, views)
    selected, every = open_scan(tmp_path), open_scan(tmp_path, options={"every": "1"})
    thirds = open_scan(tmp_path, options={"every": "3"})
    assert len(every.views) == 108
    assert selected.frames_used == every.frames_used[: 12 * ENOUGH]
    assert thirds.frames_used == every.frames_used[::3]
    assert [note for note in selected.notes if note not in every.notes] == [
        "36 of 108 frames are used; the others show the same from the same places "
        "(--set capture.every=1 uses all)"
    ]
    np.testing.assert_allclose(selected.scan_to_room, every.scan_to_room, atol=0.01)
