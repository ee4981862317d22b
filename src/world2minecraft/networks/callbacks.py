"""The Lightning callback for training: logging, validation, checkpoints and early stopping.

A run folder contains ``checkpoint.safetensors`` (for resuming), ``weights.safetensors`` (the best
weights by mIoU on the validation frames), ``last.safetensors``, ``metrics.csv`` and
``tensorboard/``.
"""

# Lightning's ModelCheckpoint and EarlyStopping are not used: their checkpoints are pickles, which
# can run code when they are read, and lack the sums of losses that are not logged yet, without
# which a resumed run would not produce the same metrics.

import math
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import lightning

from world2minecraft.core.errors import UsageError
from world2minecraft.core.progress import Progress
from world2minecraft.evaluation.metrics.occupancy import OccupancyCounts
from world2minecraft.networks.checkpoints import write_checkpoint, write_weights
from world2minecraft.networks.config import RunConfig
from world2minecraft.networks.csv_logger import CsvLogger
from world2minecraft.networks.lightning_module import OccupancyModule, learning_rate_at

CHECKPOINT, WEIGHTS, LAST = "checkpoint.safetensors", "weights.safetensors", "last.safetensors"
LOG_EVERY_STEPS = 20  # Steps over which logged losses are averaged.


@dataclass
class RunState:
    """The state of a run that is saved in a checkpoint.

    Attributes:
        step: Number of completed steps.
        best_miou: Best validation mIoU so far, or -1.
        best_step: Step at which it was reached.
        worse: Number of validations since then.
        stopped: Whether the run was stopped early.
        seconds: Elapsed seconds of training and validation over all attempts.
        cpu_seconds: CPU seconds of this process over all attempts.
        sums: Sums of losses that are not logged yet.
        summed: Number of steps in these sums.
    """

    step: int = 0
    best_miou: float = -1.0
    best_step: int = 0
    worse: int = 0
    stopped: bool = False
    seconds: float = 0.0
    cpu_seconds: float = 0.0
    sums: dict[str, float] = field(default_factory=dict)
    summed: int = 0


class TrainingCallback(lightning.Callback):
    """A callback that logs losses, validates, saves checkpoints and stops early."""

    def __init__(
        self,
        folder: Path,
        config: RunConfig,
        state: RunState,
        validate: Callable[[], OccupancyCounts],
        progress: Progress,
    ):
        self._folder, self._config, self._validate = folder, config, validate
        self._progress, self.state = progress, state
        self._logger = CsvLogger(folder, state.step)
        self._began, self._first = time.monotonic(), state.step
        self._cpu_began = time.process_time()
        self._before_s, self._cpu_before_s = state.seconds, state.cpu_seconds
        self._last_loss = ""

    def on_train_batch_end(
        self, trainer: Any, pl_module: Any, outputs: Any, batch: Any, batch_idx: int
    ) -> None:
        """Log the losses of a step and, when due, validate, save a checkpoint or stop."""
        module: OccupancyModule = pl_module
        state, config = self.state, self._config
        state.step += 1
        self._check_finite(module)
        self._log_losses(module)
        is_last = state.step == config.steps
        if state.step % config.validate_every == 0 or is_last:
            self._validate_network(module)
            trainer.should_stop = state.stopped
        if state.step % config.checkpoint_every == 0 or is_last or state.stopped:
            self._save_checkpoint(module, trainer.optimizers[0])
        self._report(state.sums)

    def _check_finite(self, module: OccupancyModule) -> None:
        """Stop a run whose loss is not finite, since its weights cannot recover."""
        if not math.isfinite(float(module.losses["loss"])):
            rate = learning_rate_at(self._config, self.state.step - 1)
            raise UsageError(
                f"the loss at step {self.state.step:,} is not finite (learning rate {rate:.2g}); "
                "use a lower learning rate (--lr) or 32-bit precision (--precision 32) with "
                "another output folder "
                "(the best weights are kept)"
            )

    def _log_losses(self, module: OccupancyModule) -> None:
        state = self.state
        for name, value in module.losses.items():
            state.sums[name] = state.sums.get(name, 0.0) + float(value)
        state.summed += 1
        if state.step % LOG_EVERY_STEPS == 0 or state.step == self._config.steps:
            figures = {f"train_{k}": v / state.summed for k, v in state.sums.items()}
            figures["learning_rate"] = learning_rate_at(self._config, state.step - 1)
            self._logger.log_metrics(state.step, figures)
            state.sums, state.summed = {}, 0
            self._last_loss = f"loss {figures['train_loss']:.3f}"

    def _validate_network(self, module: OccupancyModule) -> None:
        state, counts = self.state, self._validate()
        self._logger.log_metrics(state.step, {"val_iou": counts.iou, "val_miou": counts.miou})
        if counts.miou > state.best_miou:
            state.best_miou, state.best_step, state.worse = counts.miou, state.step, 0
            write_weights(self._folder / WEIGHTS, module.network, self._config)
        else:
            state.worse += 1
        state.stopped = 0 < self._config.patience <= state.worse

    def _save_checkpoint(self, module: OccupancyModule, optimiser: Any) -> None:
        self.state.seconds = self._before_s + time.monotonic() - self._began
        self.state.cpu_seconds = self._cpu_before_s + time.process_time() - self._cpu_began
        self._logger.save()
        write_checkpoint(self._folder / CHECKPOINT, module.network, optimiser, asdict(self.state))

    def _report(self, sums: dict[str, float]) -> None:
        state = self.state
        rate = (state.step - self._first) / max(time.monotonic() - self._began, 1e-9)
        best = f", best mIoU {100 * state.best_miou:.1f}" if state.best_miou >= 0 else ""
        note = f"{self._last_loss}{', ' if self._last_loss else ''}{rate:.2f} steps/s{best}"
        self._progress("train", state.step, self._config.steps, note)

    def finish(self, module: OccupancyModule) -> None:
        """Write the final weights and close the log files."""
        write_weights(self._folder / LAST, module.network, self._config)
        self._logger.finalize()
