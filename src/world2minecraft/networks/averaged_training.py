"""The base class of training runs that average their weights and can be resumed at any step.

The learning rate is constant and decreases to zero in the last part of a run, so a run can be
extended from any state before this part, or ended early with fewer steps.
"""

from dataclasses import asdict
from pathlib import Path
from typing import Any, Generic, TypeVar

import torch
from safetensors.torch import load_file, save_file
from torch import Tensor, nn

from world2minecraft.core.files import write_text

Network = TypeVar("Network", bound=nn.Module)


class AveragedTrainer(Generic[Network]):
    """A training run in progress, with the running mean of its weights.

    Attributes:
        run: Settings, a dataclass with ``steps``, ``rate``, ``fall``, ``warm_steps``, ``mean_of``.
        network: Network that is trained.
        mean: Network with the running mean of the weights.
        optimiser: Optimizer of the network.
        step: Number of steps done.
        min_rate: Fraction of the maximum learning rate that is left at the end.
    """

    run: Any
    network: Network
    mean: Network
    optimiser: torch.optim.Optimizer
    step: int
    min_rate: float = 0.01

    def learning_rate_at(self, step: int) -> float:
        """Return the learning rate at a step."""
        run = self.run
        left = (run.steps - step) / max(run.fall * run.steps, 1)
        return run.rate * min((step + 1) / run.warm_steps, 1.0, max(left, self.min_rate))

    def _minimize(self, loss: Tensor) -> None:
        """Do a step of the optimizer with clipped gradients, and update the running mean."""
        self.optimiser.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.network.parameters(), 5.0)
        self.optimiser.step()
        self._update_mean()

    @torch.no_grad()
    def _update_mean(self) -> None:
        """Update the running mean of the weights, faster at the beginning."""
        keep = min(self.run.mean_of, (self.step + 1) / (self.step + 10))
        new = self.network.state_dict()
        means: list[Tensor] = []
        values: list[Tensor] = []
        for name, value in self.mean.state_dict().items():
            if value.dtype.is_floating_point:
                means.append(value)
                values.append(new[name])
            else:
                value.copy_(new[name])
        torch._foreach_lerp_(means, values, 1 - keep)  # type: ignore[reportPrivateImportUsage]

    def _further_state(self) -> dict[str, Tensor]:
        """Return further tensors to save beside the optimizer state."""
        return {}

    def save(self, folder: Path) -> None:
        """Write the weights and the optimizer state to a folder."""
        folder.mkdir(parents=True, exist_ok=True)
        for name, network in (("network", self.network), ("mean", self.mean)):
            _write(network.state_dict(), folder / f"{name}.safetensors")
        state = self._further_state()
        for name, parameter in self.network.named_parameters():
            for key, value in self.optimiser.state.get(parameter, {}).items():
                state[f"{name}/{key}"] = torch.as_tensor(value)
        _write(state, folder / "optimiser.safetensors")
        write_text(folder / "step.txt", f"{self.step}\n")
        write_text(folder / "run.txt", f"{asdict(self.run)}\n")

    def resume(self, folder: Path) -> bool:
        """Load the state written by ``save``. Return False if the folder contains none."""
        if not (folder / "step.txt").is_file():
            return False
        self.network.load_state_dict(load_file(str(folder / "network.safetensors")))
        self.mean.load_state_dict(load_file(str(folder / "mean.safetensors")))
        state = load_file(str(folder / "optimiser.safetensors"))
        for name, parameter in self.network.named_parameters():
            keys = [key for key in state if key.rpartition("/")[0] == name]
            self.optimiser.state[parameter] = {
                key.rpartition("/")[2]: _moved(state[key], parameter.device) for key in keys
            }
        self.step = int((folder / "step.txt").read_text())
        return True


def _moved(value: Tensor, device: torch.device) -> Tensor:
    """Return a tensor of the optimizer on a device. Counts of steps stay on the CPU."""
    return value.to(device) if value.dim() else value


def _write(state: dict[str, Tensor], path: Path) -> None:
    """Write tensors to a file, whole or not at all."""
    spare = path.with_suffix(".tmp")
    save_file({key: value.contiguous().cpu() for key, value in state.items()}, str(spare))
    spare.replace(path)
