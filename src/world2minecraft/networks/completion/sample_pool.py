"""Batches for the completion network from a folder of sample files that may still grow."""

from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from world2minecraft.core.errors import InputError
from world2minecraft.networks.completion.augmentation import augment_sample
from world2minecraft.networks.completion.samples import Sample, read_samples
from world2minecraft.reconstruction.semantics.completion_channels import network_input

# A walk is what the program is mostly given, a single view the hardest.
KIND_WEIGHTS = {"walk": 0.42, "few": 0.18, "single": 0.4}
REFRESH_EVERY_STEPS = 100  # Steps after which new files are looked for.


class SamplePool:
    """Draws samples of a folder: the kind of look, a room, one of its samples. Files are kept."""

    def __init__(self, folder: Path, seeds: range):
        """Begin with the files of these seeds that are there.

        Raises:
            InputError: there is none.
        """
        self.folder, self.seeds = folder, seeds
        self._paths: list[Path] = []
        self._held: dict[Path, dict[str, list[Sample]]] = {}
        self.refresh()
        if not self._paths:
            raise InputError(folder, "has no samples; run benchmarks.make_completion_samples")

    def refresh(self) -> None:
        """Take in files that are new."""
        found = sorted(self.folder.glob("*.npz"))
        named = [path for path in found if path.stem.isdecimal()]
        self._paths = [path for path in named if int(path.stem) in self.seeds]

    def __len__(self) -> int:
        """The number of rooms."""
        return len(self._paths)

    def draw(self, rng: np.random.Generator) -> Sample:
        """Return one sample; a file that is drawn for the first time is read."""
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
        """Return inputs [B, C, X, Y, Z], truth int64 [B, X, Y, Z], and the observed surface."""
        chosen = [augment_sample(self.draw(rng), rng, crop) for _ in range(count)]
        return collate_samples(chosen)


def collate_samples(samples: list[Sample]) -> tuple[Tensor, Tensor, Tensor]:
    """Return samples of one shape as tensors."""
    cells = torch.from_numpy(np.stack([network_input(sample.sight) for sample in samples]))
    truth = torch.from_numpy(np.stack([sample.truth for sample in samples]).astype(np.int64))
    surface = torch.from_numpy(np.stack([sample.sight.log_odds > 0 for sample in samples]))
    return cells.contiguous(memory_format=torch.channels_last_3d), truth, surface
