"""CPU time measurement for the stages of a data set build."""

import time
from collections import defaultdict
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

STAGES = ("render", "encode", "labels", "write", "scenes")
TITLES = {
    "render": "render",
    "encode": "encode",
    "labels": "labels and masks",
    "write": "write and index",
    "scenes": "worlds and views",
}


class StageClock:
    """A clock for the CPU seconds that this process spends in each stage."""

    def __init__(self):
        """Create a clock with no recorded time."""
        self.seconds: defaultdict[str, float] = defaultdict(float)

    @contextmanager
    def of(self, stage: str) -> Iterator[None]:
        """Measure the CPU time of a ``with`` block and add it to a stage."""
        began = time.process_time()
        try:
            yield
        finally:
            self.seconds[stage] += time.process_time() - began


def milliseconds_per_image(seconds: Mapping[str, float], images: int) -> dict[str, float]:
    """Return the CPU milliseconds per image for each stage and, as ``all``, in total."""
    if not images:
        return {}
    per_image = {stage: 1000 * seconds.get(stage, 0.0) / images for stage in STAGES}
    return {**per_image, "all": sum(per_image.values())}
