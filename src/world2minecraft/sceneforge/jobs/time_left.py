"""How much of a job of several stages is done, and how long the rest takes.

Each stage has a length in seconds that it usually takes; what it takes here is told by the clock.
Early on the usual lengths decide, later the pace of this machine.
"""

from collections.abc import Mapping

PRIOR_S = 4.0  # For so long the usual lengths weigh as much as the clock.


class TimeLeft:
    """Follows one job.

    Args:
        usual_s: the stages in their order, each with the seconds that it usually takes.

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
        """Return the share of the whole job that is done, 0 to 1, and the seconds left.

        Both are None where nothing is known of the job; neither ever jumps back for a stage that
        is not among the usual ones.
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
