"""Recorded walks: tour files, recordings from the game, and walks of agents and people.

Positions are snapped to the floor of the scene, because a camera height alone does not define where
the feet were. Tours receive generated names, because names from files could contain paths.
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
EVERY_S = 0.2  # Between lines without a time.
DECISION_S = 0.5  # Between the decisions of an agent, which are at most one metre apart.
ASIDE_M, HIGH_M = 0.4, 0.75  # Maximum horizontal and vertical distance of the feet to the floor.


def parse_at(text: str) -> At:
    """Validate the option ``--at``.

    Raises:
        UsageError: If the text is neither "feet" nor "eye".
    """
    if text not in ("feet", "eye"):
        raise UsageError(f"at must be 'feet' or 'eye', got {text!r}")
    return "feet" if text == "feet" else "eye"


def scene_ids_of(path: str | Path) -> set[str]:
    """Return the scene IDs that a stream refers to, with "" for an unnamed scene.

    Raises:
        InputError: If the file cannot be read.
        DamagedFileError: If a line is not a valid pose.
    """
    if traces := _traces(path):
        return {str(read_trace(place)[0].get("scene", "")) for place in traces}
    return {one.scene_id for one in read_tour(path)}


def recorded_tours(
    scene: VlnScene, paths: Sequence[str | Path], at: At = "eye"
) -> list[list[StreamFrame]]:
    """Return the recorded tours in a scene, each sorted by time and snapped to the floor.

    Args:
        scene: The scene of the recordings. Lines that refer to other scenes are ignored.
        paths: Tour files (JSONL or CSV) and folders of ``w2m vln run``.
        at: Whether x, y, z are the feet or the eye position in lines that do not state it.

    Raises:
        InputError: If a file cannot be read.
        DamagedFileError: If a line is not a valid pose.
        LimitError: If a file is too large.
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
    """Move frames to the nearest standing position, and drop those that are too far from the floor.

    Frames of players who fly, swim or stand on furniture are dropped.
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
    """Group stream files by the scene that they refer to.

    Raises:
        UsageError: If a stream belongs to an unknown scene, or does not state which of several.
    """
    found: dict[str, list[str]] = {}
    for path in paths:
        for name in sorted(scene_ids_of(path)):
            if not name and len(scene_ids) > 1:
                raise UsageError(
                    f"{path} does not state its scene; give a single scene, or add the "
                    "field scene_id"
                )
            known = name or scene_ids[0]
            if known not in scene_ids:
                some = ", ".join(scene_ids[:6])
                raise UsageError(
                    f"{path} belongs to scene {known[:80]!r}, which is not one of {some}"
                )
            found.setdefault(known, []).append(path)
    return {name: tuple(dict.fromkeys(own)) for name, own in found.items()}


def _streams(path: str | Path, scene: VlnScene, at: At) -> list[list[StreamFrame]]:
    """Return the frames of a tour file, or of each walk of a run."""
    if traces := _traces(path):
        return [_frames_of_trace(place) for place in traces]
    eye = eye_height_blocks(scene.blocks_per_metre)
    return [[frame_of_pose(one, eye) for one in read_tour(path, at)]]


def _in_time(frames: list[StreamFrame]) -> list[StreamFrame]:
    """Sort frames by time, or assign regular times if they have none."""
    if len({one.t_s for one in frames}) == 1:
        return assign_even_times(frames, EVERY_S)
    return sorted(frames, key=lambda one: one.t_s)


def _traces(path: str | Path) -> list[Path]:
    """Return the trace files of a run, or an empty list for a tour file."""
    place = Path(path)
    if place.is_dir():
        return traces_in(place)
    return [place] if place.name == TRACE_FILE else []


def _frames_of_trace(path: Path) -> list[StreamFrame]:
    lines = read_trace(path)
    scene = str(lines[0].get("scene", ""))
    stances = stances_of(lines, path)
    return [StreamFrame(n * DECISION_S, stance, scene) for n, stance in enumerate(stances)]
