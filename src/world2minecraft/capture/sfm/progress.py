"""Progress of structure from motion: one stage that consists of several parts."""

from dataclasses import dataclass

from world2minecraft.core.progress import Progress

STAGE = "poses"


@dataclass
class ProgressSteps:
    """A progress counter over several parts, reported as one stage."""

    progress: Progress
    parts: dict[str, int]
    at: int = 0

    def done(self, part: str, of: int = 0, count: int = 0) -> None:
        """Report one more step of a part, or ``of`` completed steps out of ``count``."""
        names = list(self.parts)
        begin = sum(self.parts[name] for name in names[: names.index(part)])
        end = begin + self.parts[part]
        ahead = begin + self.parts[part] * of // count if count else max(self.at, begin) + 1
        self.at = max(self.at, min(ahead, end))
        self.progress(STAGE, self.at, self.total + 1, part)

    @property
    def total(self) -> int:
        """The number of steps of all parts."""
        return sum(self.parts.values())

    def end(self) -> None:
        """Report that all parts are completed."""
        self.progress(STAGE, self.total + 1, self.total + 1, "")
