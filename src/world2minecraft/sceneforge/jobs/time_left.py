"""Estimates of the progress and the remaining time of a job with several stages.

Each stage has a typical duration in seconds. The actual durations on this machine are measured:
early in a job the estimate relies on the typical durations, later on the measured speed. The
typical durations of reconstruction stages were measured on two cores, with the 40 frames of the
demo room and with 100 photos of a generated room.
"""

from collections.abc import Mapping
from typing import Any

LATER_S = {"label": 0.5, "find": 0.5, "furnish": 1.0, "repair": 3.0, "build": 2.0, "report": 5.0}
SENSED_FRAME_S = {"scan": 0.04, "register": 0.06, "fuse": 0.04}
PICTURE_S = {"photos": 0.05, "poses": 0.7, "shrink": 0.05, "stereo": 0.65}
DEMO_FRAMES = 40
PRIOR_S = 4.0  # The weight of the typical durations, in seconds of measurement.


def reconstruct_stage_seconds(survey: Mapping[str, Any] | None) -> dict[str, float]:
    """Return the stages of a reconstruction with their typical durations in seconds.

    Args:
        survey: The result of ``survey`` for the capture.
    """
    if survey and survey.get("route") == "plan":
        return {"plan": 2.0, "build": 2.0, "report": 3.0}
    frames = max(int((survey or {}).get("frames") or DEMO_FRAMES), 1)
    route = (survey or {}).get("route", "rgbd")
    first: dict[str, float] = {}
    if route in ("photos", "video", "posed photos"):
        first = {stage: frames * each for stage, each in PICTURE_S.items()}
    elif route == "unposed rgbd":
        first = {stage: frames * PICTURE_S[stage] for stage in ("photos", "poses")}
    sensed = {stage: 0.5 + frames * each for stage, each in SENSED_FRAME_S.items()}
    return first | sensed | LATER_S


def demo_stage_seconds() -> dict[str, float]:
    """Return the stages of creating the demo room, with their typical durations in seconds."""
    return {"room": 0.3, "capture": 4.0} | reconstruct_stage_seconds(None)


class TimeLeft:
    """An estimator of the progress and the remaining time of one job.

    Args:
        usual_s: The stages in order, each with its typical duration in seconds.

    Example:
        >>> left = TimeLeft({"scan": 10.0, "fuse": 10.0})
        >>> left.report("fuse", 0, 4, elapsed_s=20.0)
        (0.5, 17.1)
    """

    def __init__(self, usual_s: Mapping[str, float]):
        self._usual_s = dict(usual_s)
        self._before_s: dict[str, float] = {}
        total = 0.0
        for stage, seconds in self._usual_s.items():
            self._before_s[stage] = total
            total += seconds
        self._total_s, self._done_s = total, 0.0

    def report(
        self, stage: str, done: int, total: int, elapsed_s: float
    ) -> tuple[float | None, float | None]:
        """Return the completed share of the whole job, 0 to 1, and the remaining seconds.

        Both values are None if the job has no known stages. A stage without a typical duration does
        not lower the share.
        """
        if not self._total_s:
            return None, None
        if stage in self._usual_s:
            part = min(done / total, 1.0) if total > 0 else 0.0
            reached = self._before_s[stage] + self._usual_s[stage] * part
            self._done_s = max(self._done_s, reached)
        pace = (elapsed_s + PRIOR_S) / (self._done_s + PRIOR_S)
        left_s = (self._total_s - self._done_s) * pace
        return round(self._done_s / self._total_s, 4), round(left_s, 1)
