"""Splitting of a stream into walks at jumps, time gaps, pauses and places of looking around.

The part between two such places is one segment, a candidate for a trajectory. The limits are those
of reference points in the game at player size, in metres of the room.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.navigation.walk_stream import StreamFrame, feet_m, wrap_deg


@dataclass(frozen=True)
class SegmentationRule:
    """The limits at which a walk ends.

    The values are estimates that were checked on simulated walks: a sprint is 5.6 m/s.

    Attributes:
        gap_s: The maximum time between frames. A longer gap means missing frames.
        fastest_m_s: The maximum speed. A higher one means flying.
        jump_m: The maximum distance between frames. A longer one means teleporting.
        pause_s: The minimum duration of a pause that ends a walk.
        still_m: The maximum movement during a pause, in metres.
        still_deg: The maximum rotation during a pause, in degrees.
        look_deg: The minimum rotation of looking around, which ends a walk.
        look_m: The maximum movement while looking around, in metres.
        pitch_deg: The maximum pitch up or down. Frames beyond it are dropped.
    """

    gap_s: float = 1.0
    fastest_m_s: float = 8.0
    jump_m: float = 1.5
    pause_s: float = 2.0
    still_m: float = 0.1
    still_deg: float = 5.0
    look_deg: float = 300.0
    look_m: float = 0.5
    pitch_deg: float = 60.0


def split_into_walks(
    frames: Sequence[StreamFrame], blocks_per_metre: float, rule: SegmentationRule | None = None
) -> list[list[StreamFrame]]:
    """Split a stream into walks, dropping frames that look steeply up or down.

    Args:
        frames: The frames sorted by time, one tour after another.
        blocks_per_metre: The scale of the world.
        rule: The limits. None uses the defaults.
    """
    how = rule or SegmentationRule()
    level = [frame for frame in frames if abs(frame.stance.pitch_deg) <= how.pitch_deg]
    segments = []
    for run in _unbroken(level, blocks_per_metre, how):
        segments += _between_stops(run, blocks_per_metre, how)
    return [segment for segment in segments if len(segment) >= 2]


def _unbroken(
    frames: Sequence[StreamFrame], blocks_per_metre: float, rule: SegmentationRule
) -> list[list[StreamFrame]]:
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
            or not 0 < passed_s[n] <= rule.gap_s
            or away_m[n] > rule.jump_m
            or away_m[n] > rule.fastest_m_s * passed_s[n]
        )
        if breaks:
            runs.append([])
        runs[-1].append(frame)
    return runs


def _between_stops(
    run: list[StreamFrame], blocks_per_metre: float, rule: SegmentationRule
) -> list[list[StreamFrame]]:
    """Split at pauses and at places of looking around. A walk ends when such a stop begins."""
    places = feet_m(run, blocks_per_metre)[:, [0, 2]]
    times = np.array([frame.t_s for frame in run])
    yaws = np.array([frame.stance.yaw_deg for frame in run])
    turned = np.concatenate([[0], np.cumsum(np.abs(wrap_deg(np.diff(yaws))))])
    segments, begin, n = [], 0, 0
    while n < len(run):
        end = _stop_from(n, places, times, turned, rule)
        if end is None:
            n += 1
            continue
        segments.append(run[begin : n + 1])
        begin = n = end
        n += 1
    segments.append(run[begin:])
    return segments


def _stop_from(
    first: int, places: np.ndarray, times: np.ndarray, turned: np.ndarray, rule: SegmentationRule
) -> int | None:
    """Return the last frame of a stop that begins at a frame, or None."""
    still = _stay(first, places, rule.still_m)
    calm_deg = turned[first] + rule.still_deg
    steady = first + int(np.searchsorted(turned[first : still + 1], calm_deg, "right"))
    if times[steady - 1] - times[first] >= rule.pause_s:
        return steady - 1
    around = _stay(first, places, rule.look_m)
    return around if turned[around] - turned[first] >= rule.look_deg else None


def _stay(first: int, places: np.ndarray, radius_m: float) -> int:
    """Return the last of the consecutive frames within a radius of the first frame."""
    last = first
    while last + 1 < len(places) and np.linalg.norm(places[last + 1] - places[first]) <= radius_m:
        last += 1
    return last
