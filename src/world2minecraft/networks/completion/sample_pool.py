"""Batches for the completion network from a folder of sample files, which may still grow."""

from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from world2minecraft.core.errors import InputError
from world2minecraft.networks.completion.augmentation import augment_sample
from world2minecraft.networks.completion.samples import Sample, read_samples
from world2minecraft.reconstruction.semantics.completion_channels import network_input

# Walks are the most frequent input of the program, single views the most difficult.
KIND_WEIGHTS = {"walk": 0.42, "few": 0.18, "single": 0.4}
REFRESH_EVERY_STEPS = 100  # Steps after which new files are looked for.


class SamplePool:
    """A pool that chooses random samples from files: first the kind of scan, then the room.

    Files are kept in memory after they are read.
    """

    def __init__(self, folder: Path, seeds: range):
        """Create a pool with the existing files for the given seeds.

        Raises:
            InputError: If there are no such files.
        """
        self.folder, self.seeds = folder, seeds
        self._paths: list[Path] = []
        self._held: dict[Path, dict[str, list[Sample]]] = {}
        self.refresh()
        if not self._paths:
            raise InputError(
                folder,
                "contains no samples for these seeds; create some with "
                "benchmarks.make_completion_samples",
            )

    def refresh(self) -> None:
        """Look for new files."""
        found = sorted(self.folder.glob("*.npz"))
        named = [path for path in found if path.stem.isdecimal()]
        self._paths = [path for path in named if int(path.stem) in self.seeds]

    def __len__(self) -> int:
        """Return the number of rooms."""
        return len(self._paths)

    def draw(self, rng: np.random.Generator) -> Sample:
        """Return a random sample, reading its file if necessary."""
        kinds = sorted(KIND_WEIGHTS)
        shares = np.array([KIND_WEIGHTS[kind] for kind in kinds])
        kind = str(rng.choice(kinds, p=shares / shares.sum()))
        path = self._paths[int(rng.integers(len(self._paths)))]
        if path not in self._held:
            by_kind: dict[str, list[Sample]] = {}
            for sample in read_samples(path):
                by_kind.setdefault(sample.kind, []).append(sample)
            self._held[path] = by_kind
        samples = self._held[path].get(kind) or next(iter(self._held[path].values()))
        return samples[int(rng.integers(len(samples)))]

    def batch(
        self, rng: np.random.Generator, count: int, crop: tuple[int, int, int]
    ) -> tuple[Tensor, Tensor, Tensor]:
        """Return a random batch of augmented samples.

        Returns:
            The inputs [B, C, X, Y, Z], the ground truth int64 [B, X, Y, Z], and the mask of
            observed surfaces bool [B, X, Y, Z].
        """
        chosen = [augment_sample(self.draw(rng), rng, crop) for _ in range(count)]
        return collate_samples(chosen)


def collate_samples(samples: list[Sample]) -> tuple[Tensor, Tensor, Tensor]:
    """Stack samples of the same shape into tensors, as returned by ``SamplePool.batch``."""
    cells = torch.from_numpy(np.stack([network_input(sample.sight) for sample in samples]))
    truth = torch.from_numpy(np.stack([sample.truth for sample in samples]).astype(np.int64))
    surface = torch.from_numpy(np.stack([sample.sight.log_odds > 0 for sample in samples]))
    return cells.contiguous(memory_format=torch.channels_last_3d), truth, surface
