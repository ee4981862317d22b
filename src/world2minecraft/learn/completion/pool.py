"""Batches for the completion network out of a folder of sample files that may still grow."""

from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from world2minecraft.errors import InputError
from world2minecraft.label.channels import network_input
from world2minecraft.learn.completion.augment import augmented
from world2minecraft.learn.completion.samples import Sample, read_samples

# A walk is what the program is mostly given, a single view the hardest.
KIND_WEIGHTS = {"walk": 0.42, "few": 0.18, "single": 0.4}
LOOK_AGAIN = 100  # Steps after which new files are looked for.


class SamplePool:
    """Draws samples of a folder: first the kind of look, then one of its samples."""

    def __init__(self, folder: Path, seeds: range):
        """Begin with the files of these seeds that are there.

        Raises:
            InputError: there is none.
        """
        self.folder, self.seeds = folder, seeds
        self._known: set[str] = set()
        self._held: dict[str, list[Sample]] = {}
        self.refresh()
        if not self._held:
            raise InputError(folder, "has no samples; run benchmarks.make_completion_samples")

    def refresh(self) -> None:
        """Take in files that are new."""
        for path in sorted(self.folder.glob("*.npz")):
            if path.name not in self._known and int(path.stem) in self.seeds:
                self._known.add(path.name)
                for sample in read_samples(path):
                    self._held.setdefault(sample.kind, []).append(sample)

    def __len__(self) -> int:
        """The number of samples."""
        return sum(len(samples) for samples in self._held.values())

    def batch(
        self, rng: np.random.Generator, count: int, crop: tuple[int, int, int]
    ) -> tuple[Tensor, Tensor, Tensor]:
        """Return inputs [B, C, X, Y, Z], truth int64 [B, X, Y, Z], and the observed surface."""
        kinds = sorted(self._held)
        shares = np.array([KIND_WEIGHTS[kind] for kind in kinds])
        chosen = []
        for kind in rng.choice(kinds, count, p=shares / shares.sum()):
            held = self._held[str(kind)]
            chosen.append(augmented(held[int(rng.integers(len(held)))], rng, crop))
        return as_batch(chosen)


def as_batch(samples: list[Sample]) -> tuple[Tensor, Tensor, Tensor]:
    """Return samples of one shape as tensors."""
    cells = torch.from_numpy(np.stack([network_input(sample.sight) for sample in samples]))
    truth = torch.from_numpy(np.stack([sample.truth for sample in samples]).astype(np.int64))
    surface = torch.from_numpy(np.stack([sample.sight.log_odds > 0 for sample in samples]))
    return cells.contiguous(memory_format=torch.channels_last_3d), truth, surface
