"""How many steps a recipe takes, by the trainers' own loops, told before anybody pays for them."""

import math
from dataclasses import dataclass

from world2minecraft.core.errors import UsageError

# Of the paper's tables.
SFT_EPOCHS, SFT_BATCH, SFT_ACCUMULATED = 5, 1, 2
GRPO_EPOCHS, GRPO_BATCH, GRPO_ROLLOUTS = 30, 128, 5


@dataclass(frozen=True)
class GrpoPlan:
    """``batch`` prompts a step, of which an epoch has ``steps_an_epoch``; ``left_out`` do not fit.

    Which rows are left out changes from epoch to epoch: the loader shuffles, then drops the rest.
    """

    batch: int
    steps_an_epoch: int
    steps: int
    left_out: int


def sft_steps(rows: int, max_samples: int, gpus: int) -> int:
    """Return the optimizer's steps of the SFT recipe.

    Example:
        >>> sft_steps(1151, 1000, 1), sft_steps(249, 1000, 8)
        (2500, 80)
    """
    used = min(rows, max_samples) if max_samples else rows
    batches = math.ceil(used / (gpus * SFT_BATCH))
    return math.ceil(batches / SFT_ACCUMULATED) * SFT_EPOCHS


def grpo_plan(rows: int, gpus: int) -> GrpoPlan:
    """Return how EasyR1 goes through rows when a rollout batch is one batch of the paper.

    Its loader drops what does not fill a batch, and its own default of 512 leaves a set of the
    paper's Base without a single one; the batch is the paper's 128, or less where the rows are
    fewer, always a multiple of the GPUs.

    Raises:
        UsageError: there are fewer rows than GPUs.

    Example:
        >>> grpo_plan(249, 8)
        GrpoPlan(batch=128, steps_an_epoch=1, steps=30, left_out=121)
    """
    batch = min(GRPO_BATCH, rows) // gpus * gpus
    if batch == 0:
        raise UsageError(
            f"{rows} rows do not fill one batch on {gpus} GPUs; say --gpus {rows or 1}"
        )
    steps = rows // batch
    return GrpoPlan(batch, steps, steps * GRPO_EPOCHS, rows - steps * batch)
