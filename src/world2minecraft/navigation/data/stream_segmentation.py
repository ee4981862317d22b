"""Splitting of a stream into walks at jumps, time gaps, pauses and places of looking around.

The part between two such places is one segment, a candidate for a trajectory. The limits are those
of reference points in the game at player size, in metres of the room.
"""

from collections.abc import Sequence

import numpy as np

from world2minecraft.navigation.walk_stream import StreamFrame, feet_m, wrap_deg

# Limits at which a walk ends: estimates that were checked on simulated walks.
MAX_GAP_S = 1.0  # Longer times between frames mean missing frames.
MAX_SPEED_M_S = 8.0  # Higher speeds mean flying; a sprint is 5.6 m/s.
MAX_JUMP_M = 1.5  # Longer distances between frames mean teleporting.
PAUSE_S = 2.0  # Minimum duration of a pause that ends a walk.
STILL_M, STILL_DEG = 0.1, 5.0  # Maximum movement and rotation during a pause.
LOOK_DEG, LOOK_M = 300.0, 0.5  # Minimum rotation and maximum movement of looking around.
MAX_PITCH_DEG = 60.0  # Frames that look farther up or down are dropped.


def split_into_walks(
    frames: Sequence[StreamFrame], blocks_per_metre: float
) -> list[list[StreamFrame]]:
    """Split a stream into walks, dropping frames that look steeply up or down.

    Args:
        frames: The frames sorted by time, one tour after another.
        blocks_per_metre: The scale of the world.
    """
    level = [frame for frame in frames if abs(frame.stance.pitch_deg) <= MAX_PITCH_DEG]
    segments = []
    for run in _unbroken(level, blocks_per_metre):
        segments += _between_stops(run, blocks_per_metre)
    return [segment for segment in segments if len(segment) >= 2]


def _unbroken(frames: Sequence[StreamFrame], blocks_per_metre: float) -> list[list[StreamFrame]]:
    """Split where the position, time, tour or scene jumps."""
    if not frames:
        return []
    away_m = np.linalg.norm(np.diff(feet_m(frames, blocks_per_metre)[:, [0, 2]], axis=0), axis=1)
    passed_s = np.diff([frame.t_s for frame in frames])
    runs = [[frames[0]]]
    for n, frame in enumerate(frames[1:]):
        before = frames[n]
        breaks = (
            (frame.scene_id, frame.tour_id) != (before.scene_id, before.tour_id)
            or not 0 < passed_s[n] <= MAX_GAP_S
            or away_m[n] > MAX_JUMP_M
            or away_m[n] > MAX_SPEED_M_S * passed_s[n]
        )
        if breaks:
            runs.append([])
        runs[-1].append(frame)
    return runs


def _between_stops(run: list[StreamFrame], blocks_per_metre: float) -> list[list[StreamFrame]]:
    """Split at pauses and at places of looking around. A walk ends when such a stop begins."""
    places = feet_m(run, blocks_per_metre)[:, [0, 2]]
    times = np.array([frame.t_s for frame in run])
    yaws = np.array([frame.stance.yaw_deg for frame in run])
    turned = np.concatenate([[0], np.cumsum(np.abs(wrap_deg(np.diff(yaws))))])
    segments, begin, n = [], 0, 0
    while n < len(run):
        end = _stop_from(n, places, times, turned)
        if end is None:
            n += 1
            continue
        segments.append(run[begin : n + 1])
        begin = n = end
        n += 1
    segments.append(run[begin:])
    return segments


def _stop_from(first: int, places: np.ndarray, times: np.ndarray, turned: np.ndarray) -> int | None:
    """Return the last frame of a stop that begins at a frame, or None."""
    still = _stay(first, places, STILL_M)
    calm_deg = turned[first] + STILL_DEG
    steady = first + int(np.searchsorted(turned[first : still + 1], calm_deg, "right"))
    if times[steady - 1] - times[first] >= PAUSE_S:
        return steady - 1
    around = _stay(first, places, LOOK_M)
    return around if turned[around] - turned[first] >= LOOK_DEG else None


def _stay(first: int, places: np.ndarray, radius_m: float) -> int:
    """Return the last of the consecutive frames within a radius of the first frame."""
    last = first
    while last + 1 < len(places) and np.linalg.norm(places[last + 1] - places[first]) <= radius_m:
        last += 1
    return last
