"""CPU time of the stages of making an image."""

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
    """Seconds of CPU by stage, of this process."""

    def __init__(self):
        """Begin at 0."""
        self.seconds: defaultdict[str, float] = defaultdict(float)

    @contextmanager
    def of(self, stage: str) -> Iterator[None]:
        """Count what the block takes."""
        began = time.process_time()
        try:
            yield
        finally:
            self.seconds[stage] += time.process_time() - began


def milliseconds_per_image(seconds: Mapping[str, float], images: int) -> dict[str, float]:
    """Return the CPU milliseconds of each stage for one image, and of all."""
    if not images:
        return {}
    per_image = {stage: 1000 * seconds.get(stage, 0.0) / images for stage in STAGES}
    return {**per_image, "all": sum(per_image.values())}
