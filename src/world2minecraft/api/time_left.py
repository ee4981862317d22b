"""Estimate the remaining time of a run with several stages.

Each stage has an expected cost: a fixed number of seconds plus seconds per frame. The expected
costs of the remaining stages are scaled by the ratio of measured to expected time of the finished
stages. The costs were measured on the 40-frame kitchen and on ``w2m demo`` with 40 and 160 frames,
on two cores, with compiled kernels. Only their proportions matter after the first stage.
"""

from collections.abc import Sequence
from dataclasses import dataclass

USUAL_FRAMES = 40
# Weight of the expected costs in seconds. A first stage of half a second, half of which is
# imports, says little about the speed of the machine.
PRIOR_S = 2.0


@dataclass(frozen=True)
class StageCost:
    """The expected cost of a stage.

    Attributes:
        fixed_s: Seconds regardless of the number of frames.
        frame_s: Seconds per frame.
        has_frames: Whether the total that the stage reports is a number of frames.
    """

    fixed_s: float
    frame_s: float = 0.0
    has_frames: bool = False

    def seconds(self, frames: int) -> float:
        """Return the expected duration in seconds for a number of frames."""
        return self.fixed_s + self.frame_s * frames


COSTS = {
    "room": StageCost(0.6),
    "capture": StageCost(0.1, 0.095, has_frames=True),
    "photos": StageCost(0.5, 0.005, has_frames=True),
    "poses": StageCost(2.0, 0.6),
    "stereo": StageCost(2.0, 0.9),
    "scan": StageCost(0.4, 0.011),
    "register": StageCost(0.2, 0.022, has_frames=True),
    "fuse": StageCost(0.8, 0.1, has_frames=True),
    "label": StageCost(0.25, 0.003),
    "find": StageCost(0.1),
    "furnish": StageCost(0.4),
    "repair": StageCost(2.5),
    "build": StageCost(0.3),
    "report": StageCost(1.2, 0.045),
}

RECONSTRUCTION = (
    *("scan", "register", "fuse", "label", "find", "furnish", "repair", "build", "report"),
)
FROM_PHOTOS = ("photos", "poses", "stereo", *RECONSTRUCTION)
DEMO = ("room", "capture", *RECONSTRUCTION)


class TimeLeft:
    """An estimate of the remaining time, updated by progress reports.

    The stages of a run occur in the order of ``stages``. A resumed run skips some of them.

    Example:
        >>> estimate = TimeLeft(("scan", "fuse"))
        >>> estimate.report("scan", 0, 1, now_s=0.0)
        >>> estimate.report("fuse", 0, 40, now_s=0.84)
        >>> round(estimate.left_s(0.84), 1)
        4.8
    """

    def __init__(self, stages: Sequence[str]):
        self._stages = tuple(stages)
        self._frames = USUAL_FRAMES
        self._stage, self._began_s, self._fraction = "", 0.0, 0.0
        self._finished: dict[str, float] = {}  # Stages and their durations in seconds.

    def report(self, stage: str, done: int, total: int, now_s: float) -> None:
        """Update the estimate with a progress report. Unknown stages are ignored."""
        if stage not in self._stages:
            return
        if stage != self._stage:
            self._finish(now_s)
            self._stage, self._began_s, self._fraction = stage, now_s, 0.0
        if COSTS[stage].has_frames and total:
            self._frames = total
        self._fraction = done / total if total else 0.0

    def left_s(self, now_s: float) -> float | None:
        """Return the remaining seconds, or None before the first stage is finished.

        The rest of the current stage is estimated from its expected cost at first, and from its
        measured speed as it proceeds.
        """
        if not self._finished:
            return None
        scale = self._scale()
        here = now_s - self._began_s
        expected = scale * COSTS[self._stage].seconds(self._frames)
        total = max((1 - self._fraction) * expected + here, here)
        after = self._stages[self._stages.index(self._stage) + 1 :]
        later = scale * sum(COSTS[stage].seconds(self._frames) for stage in after)
        return (1 - self._fraction) * total + later

    def _finish(self, now_s: float) -> None:
        if self._stage:
            spent_s = now_s - self._began_s
            self._finished[self._stage] = self._finished.get(self._stage, 0.0) + spent_s

    def _scale(self) -> float:
        """Return the ratio of measured to expected time of the finished stages."""
        measured = sum(self._finished.values())
        expected = sum(COSTS[stage].seconds(self._frames) for stage in self._finished)
        return (measured + PRIOR_S) / (expected + PRIOR_S)


def stages_from(first: str) -> tuple[str, ...]:
    """Return the stages of a reconstruction that starts with a given stage.

    The result is empty if the stage is not the first stage of a reconstruction.

    Example:
        >>> stages_from("scan")[:3], stages_from("render")
        (('scan', 'register', 'fuse'), ())
    """
    if first == RECONSTRUCTION[0]:
        return RECONSTRUCTION
    return FROM_PHOTOS if first == FROM_PHOTOS[0] else ()
