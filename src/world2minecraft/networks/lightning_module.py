"""The Lightning module for training: the losses, the learning rate and the seed of each step.

All random numbers of a step are derived from the seed of the run and the step number.
"""

# Not by a scheduler of torch that Lightning steps: its state would have to be kept and restored
# with each checkpoint; here the rate, as all that is by chance, follows from the step's number.

import dataclasses
import math
from typing import Any

import lightning
import torch
from torch import Tensor, nn

from world2minecraft.networks.batch import OccOutput
from world2minecraft.networks.config import RunConfig
from world2minecraft.networks.data.batches import Batch
from world2minecraft.networks.losses import LossWeights, occupancy_losses

STEP_GAMMA = 0.1  # As MonoScene, a tenth of the rate
STEP_MILESTONE = 2 / 3  # from epoch 20 of 30 onwards.
SEED_STRIDE = 1_000_003  # Runs with different seeds never have the same seed at the same step.


def learning_rate_at(config: RunConfig, step: int) -> float:
    """Return the learning rate at a step, counted from 0.

    Example:
        >>> config = RunConfig("iso", ("x",), steps=100, warmup_steps=10, learning_rate=1.0)
        >>> [round(learning_rate_at(config, step), 3) for step in (0, 9, 10, 55, 99)]
        [0.1, 1.0, 1.0, 0.5, 0.0]
    """
    full = config.learning_rate
    if step < config.warmup_steps:
        return full * (step + 1) / config.warmup_steps
    if config.schedule == "constant":
        return full
    if config.schedule == "step":
        return full * (STEP_GAMMA if step >= STEP_MILESTONE * config.steps else 1.0)
    done = (step - config.warmup_steps) / max(config.steps - config.warmup_steps, 1)
    return full * 0.5 * (1 + math.cos(math.pi * min(done, 1.0)))


class OccupancyModule(lightning.LightningModule):
    """A network with its losses for training.

    ``first_step`` is the number of steps that earlier attempts have completed.
    """

    def __init__(self, network: nn.Module, config: RunConfig, class_weights: Tensor):
        super().__init__()
        self.network, self.config, self.first_step = network, config, 0
        self.weights = LossWeights(classes=tuple(class_weights.tolist()))
        self.losses: dict[str, Tensor] = {}  # The losses of the last step.

    def configure_optimizers(self) -> torch.optim.Optimizer:
        """Return an AdamW optimizer for all trainable weights."""
        learning = [one for one in self.network.parameters() if one.requires_grad]
        config = self.config
        return torch.optim.AdamW(
            learning, lr=config.learning_rate, weight_decay=config.weight_decay
        )

    def transfer_batch_to_device(
        self, batch: Any, device: torch.device, dataloader_idx: int
    ) -> Any:
        """Move a batch to a device, since Lightning does not support frozen dataclasses."""
        more = tuple(one.to(device) for one in batch.more)
        return Batch(batch.inputs.to(device), batch.target.to(device), more)

    def on_train_batch_start(self, batch: Batch, batch_idx: int) -> None:
        """Set the learning rate and the random seed of a step."""
        step = self.first_step + batch_idx
        torch.manual_seed(self.config.seed * SEED_STRIDE + step)
        for group in self.trainer.optimizers[0].param_groups:
            group["lr"] = learning_rate_at(self.config, step)

    def training_step(self, batch: Batch, batch_idx: int) -> Tensor:
        """Return the loss of a step."""
        more = (batch.more,) if batch.more else ()
        output = self.network(batch.inputs, *more)
        with torch.autocast(self.device.type, enabled=False):
            losses = occupancy_losses(to_float32(output), batch.target, batch.inputs, self.weights)
        total = torch.stack(list(losses.values())).sum()
        self.losses = {"loss": total.detach(), **{k: v.detach() for k, v in losses.items()}}
        return total


def to_float32(output: OccOutput) -> OccOutput:
    """Convert a network output to float32.

    Sums over 130,000 cells are inaccurate in bfloat16.
    """
    return OccOutput(
        **{
            entry.name: _to_float32(getattr(output, entry.name))
            for entry in dataclasses.fields(output)
        }
    )


def _to_float32(value: Any) -> Any:
    if isinstance(value, Tensor):
        return value.float()
    return tuple(one.float() for one in value) if isinstance(value, tuple) else value
