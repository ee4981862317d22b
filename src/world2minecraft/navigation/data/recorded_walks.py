"""Walks that were recorded: tour files, ours or of the game, and what agents and people walked.

What came from outside is put on the scene's own floor, since an eye's height says little where
feet stood, and is called by names of ours: those of a file could lead anywhere.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
from scipy.spatial import KDTree

from world2minecraft.core.coordinates import eye_height_blocks
from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.running.trace import TRACE_FILE, read_trace, stances_of, traces_in
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.walk_stream import StreamFrame, assign_even_times, frame_of_pose
from world2minecraft.rendering.views.pose_file import read_tour

At = Literal["feet", "eye"]
EVERY_S = 0.2  # Between lines that say no time,
DECISION_S = 0.5  # and between an agent's decisions: a metre at most.
ASIDE_M, HIGH_M = 0.4, 0.75  # A place of the floor is so near to where feet were said to be.


def parse_at(text: str) -> At:
    """Return ``feet`` or ``eye``. Raises UsageError: it is neither."""
    if text not in ("feet", "eye"):
        raise UsageError(f"--at is feet or eye, not {text!r}")
    return "feet" if text == "feet" else "eye"


def scene_ids_of(path: str | Path) -> set[str]:
    """Return the scenes that a stream tells of; "" is one that it does not name.

    Raises: as ``recorded_tours``.
    """
    if traces := _traces(path):
        return {str(read_trace(place)[0].get("scene", "")) for place in traces}
    return {one.scene_id for one in read_tour(path)}


def recorded_tours(
    scene: VlnScene, paths: Sequence[str | Path], at: At = "eye"
) -> list[list[StreamFrame]]:
    """Return the tours of streams in a scene, each in time's order, on the scene's floor.

    Args:
        scene: where they were recorded; lines of other scenes are left out.
        paths: tour files, JSONL or CSV, and folders of ``w2m vln run``, of one walk or of many.
        at: what x, y, z is in lines that do not say it.

    Raises:
        InputError: a file cannot be read. DamagedFileError: a line is no pose. LimitError: it is
            too large.
    """
    tours = []
    for frames in (some for path in paths for some in _streams(path, scene, at)):
        own = [one for one in frames if one.scene_id in ("", scene.scene_id)]
        for name in dict.fromkeys(one.tour_id for one in own):
            tours.append(_in_time([one for one in own if one.tour_id == name]))
    named = [
        [replace(one, tour_id=f"{scene.scene_id}_r{number:03d}", image="") for one in tour]
        for number, tour in enumerate(tours)
    ]
    return [snap_to_floor(scene, tour) for tour in named]


def snap_to_floor(scene: VlnScene, frames: Sequence[StreamFrame]) -> list[StreamFrame]:
    """Return the frames whose feet are at a place where one can stand, set upon it.

    Who flies, swims or stands on a table is left out.
    """
    if not frames:
        return []
    stretch = np.array([1.0, ASIDE_M / HIGH_M, 1.0]) * scene.metres_per_block
    tree = KDTree(scene.graph.feet * stretch)
    away, places = tree.query(np.array([one.stance.feet for one in frames]) * stretch)
    return [
        replace(one, stance=replace(one.stance, y=float(scene.graph.feet[place, 1])))
        for one, place, gap in zip(frames, np.asarray(places), np.asarray(away), strict=True)
        if gap <= ASIDE_M
    ]


def assign_streams(paths: Sequence[str], scene_ids: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Return the streams of each scene that has some.

    Raises:
        UsageError: a stream is of no scene of these, or does not say of which of several.
    """
    found: dict[str, list[str]] = {}
    for path in paths:
        for name in sorted(scene_ids_of(path)):
            if not name and len(scene_ids) > 1:
                raise UsageError(
                    f"{path} does not say of which scene it is; name one scene, or add scene_id"
                )
            known = name or scene_ids[0]
            if known not in scene_ids:
                some = ", ".join(scene_ids[:6])
                raise UsageError(f"{path} is of scene {known[:80]!r}, which is not among {some}")
            found.setdefault(known, []).append(path)
    return {name: tuple(dict.fromkeys(own)) for name, own in found.items()}


def _streams(path: str | Path, scene: VlnScene, at: At) -> list[list[StreamFrame]]:
    """Return the frames of a tour file, or of each walk of a run."""
    if traces := _traces(path):
        return [_frames_of_trace(place) for place in traces]
    eye = eye_height_blocks(scene.blocks_per_metre)
    return [[frame_of_pose(one, eye) for one in read_tour(path, at)]]


def _in_time(frames: list[StreamFrame]) -> list[StreamFrame]:
    """Put frames in order; those that say no time keep theirs."""
    if len({one.t_s for one in frames}) == 1:
        return assign_even_times(frames, EVERY_S)
    return sorted(frames, key=lambda one: one.t_s)


def _traces(path: str | Path) -> list[Path]:
    """Return the traces of a run, one a walk; none where the path is a tour file."""
    place = Path(path)
    if place.is_dir():
        return traces_in(place)
    return [place] if place.name == TRACE_FILE else []


def _frames_of_trace(path: Path) -> list[StreamFrame]:
    lines = read_trace(path)
    scene = str(lines[0].get("scene", ""))
    stances = stances_of(lines, path)
    return [StreamFrame(n * DECISION_S, stance, scene) for n, stance in enumerate(stances)]
