"""Train the model that gives objects fine names, on the objects of generated rooms.

``python -m benchmarks.train_names --out object_names.npz [--rooms 400] [--steps 3000]
[--furnishing basic full]``

Boxes get the errors of scans: cells, hidden backs, wrong classes. Votes are those of a segmentation
network with errors: mostly for the true NYU40 class, else for similar ones, or missing. Printed are
the share of right names and the calibration error on rooms kept from training, with and without
votes.
"""

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import torch
from torch.nn import functional

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.errors import World2MinecraftError
from world2minecraft.core.files import write_npz
from world2minecraft.core.types import LayoutObject
from world2minecraft.core.vocabulary import ThingName, nyu40_classes, nyu40_names, read_vocabulary
from world2minecraft.procgen import generate_room
from world2minecraft.procgen.rooms.full_furnishing import FURNISHINGS
from world2minecraft.procgen.rooms.recipes import KINDS, TRAINING_KINDS
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.reconstruction.naming.name_model import FEATURES, features_of
from world2minecraft.reconstruction.naming.object_traits import traits_of

FIRST_SEED, HELD_OUT_SEED, HELD_OUT = 30_000, 8_500, 60
COPIES = 12  # Of each room, with different errors.
HIDDEN = 64
UNVOTED, WRONG_VOTE, WRONG_CLASS = 0.25, 0.2, 0.12
CELL_M, SIZE_SIGMA_M = 0.08, 0.04
GENERIC = ("other furniture", "other prop", "other structure", "cabinet", "wall", "box")


def named(item: LayoutObject) -> ThingName | None:
    """Return the name of an object of a generated room."""
    return read_vocabulary().find(item.name.replace("_", " "))


def draw_votes(entry: ThingName, rng: np.random.Generator) -> np.ndarray:
    """Return votes for an object, shares float [40]; zeros if no view votes for it."""
    votes = np.zeros(40)
    if rng.random() < UNVOTED:
        return votes
    own = rng.uniform(0, 0.35) if rng.random() < WRONG_VOTE else rng.uniform(0.3, 1)
    votes[entry.nyu40 - 1] = own
    classes = nyu40_classes()[1:41]
    similar = np.flatnonzero(classes == classes[entry.nyu40 - 1])
    generic = [nyu40_names()[name] - 1 for name in GENERIC]
    pools = (similar, generic, np.arange(40))
    for share in rng.dirichlet(np.ones(3)) * (1 - own):
        votes[int(rng.choice(pools[int(rng.choice(3, p=[0.45, 0.4, 0.15]))]))] += share
    return votes


def scanned(item: LayoutObject, rng: np.random.Generator) -> LayoutObject:
    """Return an object as a reconstruction might find it."""
    size = item.size_m + rng.normal(0, SIZE_SIGMA_M, 3)
    if rng.random() < 0.3:
        size[int(rng.integers(2))] *= rng.uniform(0.55, 1)
    size = np.maximum(np.ceil(size / CELL_M) * CELL_M, CELL_M)
    center = item.center_m + rng.normal(0, SIZE_SIGMA_M, 3)
    kind = item.class_id
    if rng.random() < WRONG_CLASS:
        likely = [SemanticClass.FURN, SemanticClass.OBJS, SemanticClass.TABLE, SemanticClass.CHAIR]
        kind = int(rng.choice(likely))
    turned = float(rng.choice([0, 90, 180, 270])) if rng.random() < 0.2 else 0.0
    return replace(
        item, size_m=size, center_m=center, class_id=kind, yaw_deg=(item.yaw_deg + turned) % 360
    )


def examples(room: Room, rng: np.random.Generator) -> tuple[np.ndarray, list[str]]:
    """Return the features of a room's objects, and their names."""
    rows, names = [np.zeros((0, FEATURES), np.float32)], []
    for layout in room.layouts:
        known = [(item, entry) for item in layout.objects if (entry := named(item)) is not None]
        kept = [pair for pair in known if rng.random() > 0.1]  # Some are not found.
        if not kept:
            continue
        votes = np.stack([draw_votes(entry, rng) for _, entry in kept])
        found = [scanned(item, rng) for item, _ in kept]
        rows.append(features_of(traits_of(found, layout, votes)))
        names += [entry.name for _, entry in kept]
    return np.concatenate(rows), names


def make_set(
    first: int, count: int, copies: int, furnishings: Sequence[str] = ("basic",)
) -> tuple[np.ndarray, list[str]]:
    """Return the examples of rooms of all kinds, with the furnishings in turn."""
    kinds = tuple(KINDS) if "full" in furnishings else TRAINING_KINDS
    rows, names = [], []
    for seed in range(first, first + count):
        rng = np.random.default_rng([seed, 21])
        try:
            room = generate_room(
                seed,
                kind=kinds[seed % len(kinds)],
                clutter=float(rng.random()),
                shape=None,
                furnishing=furnishings[seed // len(kinds) % len(furnishings)],
            )
        except World2MinecraftError:
            continue
        for _ in range(copies):
            found, told = examples(room, rng)
            rows.append(found)
            names += told
    return np.concatenate(rows), names


def calibration_error(chance: np.ndarray, right: np.ndarray, bins: int = 10) -> float:
    """Return the expected calibration error of confidences, float [N], and hits, bool [N]."""
    place = np.minimum((chance * bins).astype(int), bins - 1)
    gaps = [
        abs(chance[place == n].mean() - right[place == n].mean()) * (place == n).mean()
        for n in range(bins)
        if (place == n).any()
    ]
    return float(sum(gaps))


def train(
    rows: np.ndarray, targets: np.ndarray, count: int, steps: int
) -> tuple[dict[str, np.ndarray], torch.nn.Sequential]:
    """Return the weights, and the network for the normed inputs."""
    torch.manual_seed(0)
    mean, scale = rows.mean(axis=0), rows.std(axis=0) + 0.05
    network = torch.nn.Sequential(
        torch.nn.Linear(FEATURES, HIDDEN),
        torch.nn.ReLU(),
        torch.nn.Dropout(0.1),
        torch.nn.Linear(HIDDEN, count),
    )
    optimiser = torch.optim.AdamW(network.parameters(), lr=3e-3, weight_decay=0.02)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, steps)
    inputs, wanted = torch.from_numpy((rows - mean) / scale), torch.from_numpy(targets)
    rng = np.random.default_rng(0)
    for _ in range(steps):
        chosen = torch.from_numpy(rng.integers(0, len(rows), 512))
        loss = functional.cross_entropy(network(inputs[chosen]), wanted[chosen])
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
    network.eval()
    first, last = network[0], network[3]
    arrays = {
        "mean": mean,
        "scale": scale,
        "w1": first.weight.detach().numpy().T,
        "b1": first.bias.detach().numpy(),
        "w2": last.weight.detach().numpy().T,
        "b2": last.bias.detach().numpy(),
    }
    return {key: value.astype(np.float32) for key, value in arrays.items()}, network


def main() -> None:
    """Train, print the figures and write the file."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--rooms", type=int, default=400)
    parser.add_argument("--steps", type=int, default=3000)
    parser.add_argument("--furnishing", nargs="+", default=["basic"], choices=FURNISHINGS)
    chosen = parser.parse_args()
    torch.set_num_threads(1)
    rows, names = make_set(FIRST_SEED, chosen.rooms, COPIES, chosen.furnishing)
    known = sorted(set(names))
    targets = np.array([known.index(name) for name in names])
    arrays, network = train(rows, targets, len(known), chosen.steps)
    held, held_names = make_set(HELD_OUT_SEED, HELD_OUT, 2, chosen.furnishing)
    with torch.no_grad():
        inputs = torch.from_numpy((held - arrays["mean"]) / arrays["scale"])
        chance = network(inputs).softmax(dim=1).numpy()
    best = chance.argmax(axis=1)
    right = np.array([known[n] == name for n, name in zip(best, held_names, strict=True)])
    voted = held[:, :40].any(axis=1)
    print(f"{len(rows)} examples of {len(known)} names; held out: {len(held)}")
    print(f"right {right.mean():.3f}; with votes {right[voted].mean():.3f}, ", end="")
    print(f"without {right[~voted].mean():.3f}; ", end="")
    print(f"calibration error {calibration_error(chance.max(axis=1), right):.3f}")
    write_npz(chosen.out, arrays | {"names": np.array(known)})


if __name__ == "__main__":
    main()
