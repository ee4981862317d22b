"""How long the stages of a reconstruction usually take, for the time left.

Seconds on two cores, measured on the demo room's 40 frames and on 100 photos of a generated room.
"""

from collections.abc import Mapping
from typing import Any

LATER_S = {"label": 0.5, "find": 0.5, "furnish": 1.0, "build": 2.0, "report": 5.0}
SENSED_FRAME_S = {"scan": 0.04, "register": 0.06, "fuse": 0.04}
PICTURE_S = {"photos": 0.05, "poses": 0.7, "shrink": 0.05, "stereo": 0.65}
DEMO_FRAMES = 40


def reconstruct_s(survey: Mapping[str, Any] | None) -> dict[str, float]:
    """Return the stages of a capture's way to a room, each with its usual seconds.

    Args:
        survey: what ``tasks.survey`` told of it.
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


def demo_s() -> dict[str, float]:
    """Return the stages of the demo room, from nothing."""
    return {"room": 0.3, "capture": 4.0} | reconstruct_s(None)
