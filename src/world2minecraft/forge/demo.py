"""The room that SceneForge shows first: generated, in the paper's cells of 8 cm."""

from pathlib import Path

import numpy as np

from world2minecraft.exchange.occupancy import DEFAULT_VOXEL_M, labels_grid
from world2minecraft.forge.sources import Opened, with_objects
from world2minecraft.rooms import generate_room

KIND, SEED = "living", 5  # That of w2m demo.


def demo_room(folder: Path = Path("OUT")) -> Opened:
    """Return a living room with its objects; ``folder`` is where it would be saved."""
    room = generate_room(SEED, kind=KIND)
    step = round(DEFAULT_VOXEL_M / room.voxel_m)
    grid = labels_grid(_coarse(room.labels, step), "the demo room")
    grid, objects = with_objects(grid)
    return Opened("Demo room", folder, (), grid, np.eye(4), objects, is_demo=True)


def _coarse(labels: np.ndarray, step: int) -> np.ndarray:
    """Return labels uint8 of cells ``step`` times as long: the commonest that is not air."""
    sides = [-(-side // step) for side in labels.shape]
    fine = np.pad(labels, [(0, n * step - m) for n, m in zip(sides, labels.shape, strict=True)])
    blocks = fine.reshape(sides[0], step, sides[1], step, sides[2], step)
    counts = np.stack([(blocks == kind).sum(axis=(1, 3, 5)) for kind in range(1, 12)])
    filled = counts.sum(axis=0) * 4 >= step**3
    return np.where(filled, counts.argmax(axis=0) + 1, 0).astype(np.uint8)
