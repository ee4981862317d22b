"""Compiling the inner loops once, before several processes would all do it at the same time."""

from collections.abc import Callable

from world2minecraft.core.jit import is_compiled
from world2minecraft.minecraftocc.building.cpu_clock import StageClock
from world2minecraft.minecraftocc.building.scenes import SceneTask, survey
from world2minecraft.minecraftocc.building.studio import studio_of

_LAST = "label_kernels.count_hits"  # A kernel that a sample needs last.


def is_cold() -> bool:
    """Whether the inner loops of a sample are still to be compiled."""
    return not is_compiled(_LAST)


def warm(task: SceneTask, tick: Callable[[int], None]) -> None:
    """Look at a scene and make one sample of it; the look is kept, the sample is not."""
    facts, _ = survey(task, tick)
    if facts.views:
        studio_of(task.folder, task.spec, task.recipe).sample(0, StageClock())
