"""Make the samples on which the completion network is trained.

``python -m benchmarks.make_completion_samples --out FOLDER [--first 10000 --rooms 500]`` makes five
virtual scans for each generated room. ``--nyu DATA`` makes one sample for each training frame of
NYUv2 instead, lifted with its depth; ``DATA`` is the folder of shared inputs. ``--votes DATA``
writes the votes of the segmentation network on frames kept from its training, which the training
simulates, to ``FOLDER/segmenter_votes.npz``.

Each room is one file named by its seed, and each frame one named by ``FIRST_FRAME`` plus its
number. Existing files are skipped, so that an interrupted run continues.
"""

import argparse
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.fit_vote_weights import fused, registered_frame
from benchmarks.real_captures.scenes import NYU_FOLDER, read_nyu_classes
from world2minecraft.core.classes import CLASS_NAMES, SemanticClass
from world2minecraft.core.errors import World2MinecraftError
from world2minecraft.core.files import write_npz
from world2minecraft.core.types import FusedEvidence
from world2minecraft.networks.completion.samples import (
    FIRST_SEED,
    Sample,
    labelled_sample,
    make_samples,
    write_samples,
)
from world2minecraft.networks.completion.simulated_votes import VOTES_FILE, group_votes
from world2minecraft.networks.segmentation.frames import Part, nyu_part

FIRST_FRAME = 1_000_000
STRIDE = 4
MAX_VOTES, FEW_VOTES = 96, 500  # Of each class.


def frame_numbers(data: Path, part: Part) -> list[int]:
    """Return the numbers of the NYUv2 frames of a part of the split."""
    names = sorted(path.name for path in (data / NYU_FOLDER).glob("*.label40.png"))
    return [number for name in names if nyu_part(number := int(name[:4])) == part]


def labelled_evidence(data: Path, number: int, semantics: str) -> tuple[FusedEvidence, ...]:
    """Fuse a frame with its label image, and with the votes of a network unless it is ``none``."""
    with tempfile.TemporaryDirectory() as folder:
        scan = registered_frame(data, Path(folder), number)
        classes = read_nyu_classes(data / NYU_FOLDER / f"{number:04d}.label40.png")
        views = tuple(replace(view, labels=classes) for view in scan.views)
        labelled = fused(replace(scan, views=views), "none")
        return (labelled,) if semantics == "none" else (labelled, fused(scan, semantics))


def frame_samples(data: Path, number: int) -> list[Sample]:
    """Return the only sample of a frame."""
    return [labelled_sample(labelled_evidence(data, number, "none")[0])]


def measured_votes(data: Path) -> np.ndarray:
    """Return the network's votes by true class on the calibration frames, uint8 [11, N, 11]."""
    found: list[list[np.ndarray]] = [[] for _ in range(11)]
    for number in frame_numbers(data, "calibration"):
        labelled, voted = labelled_evidence(data, number, "nyu")
        known = labelled.votes[..., 1:].any(axis=-1) & voted.votes[..., 1:].any(axis=-1)
        votes = voted.votes[known][:, 1:].astype(np.float64)
        votes /= votes.sum(axis=1, keepdims=True)
        kinds = labelled.votes[known][:, 1:].argmax(axis=1)
        for kind, rows in enumerate(group_votes(votes, kinds, np.argwhere(known))):
            found[kind].append(rows)
        print(f"frame {number}", flush=True)
    rows = [np.concatenate(votes) for votes in found]
    for kind, votes in enumerate(rows, start=1):
        right = (votes.argmax(axis=1) == kind - 1).mean()
        print(f"{CLASS_NAMES[kind]}: {len(votes)} votes, {right:.2f} right")
    return (choose_votes(rows) * 255).round().astype(np.uint8)


def choose_votes(rows: Sequence[np.ndarray]) -> np.ndarray:
    """Choose as many votes for each class, float [11, MAX_VOTES, 11].

    A class with few votes, which come from one or two objects, borrows half of them from other
    things: in these, it takes the place of their class.
    """
    rng = np.random.default_rng(0)
    things = range(SemanticClass.CHAIR - 1, len(rows))
    chosen = []
    for kind, own in enumerate(rows):
        picked = own[rng.integers(0, len(own), MAX_VOTES)]
        if len(own) < FEW_VOTES:
            others = rng.choice([n for n in things if n != kind], MAX_VOTES // 2)
            for place, other in enumerate(others.tolist()):
                votes = rows[other][int(rng.integers(len(rows[other])))].copy()
                votes[[kind, other]] = votes[[other, kind]]
                picked[place] = votes
        chosen.append(picked)
    return np.stack(chosen)


def write_all(out: Path, numbers: list[int], make: Callable[[int], list[Sample]]) -> None:
    """Write the files that do not exist, and print the share of false surface so far."""
    false: dict[str, list[float]] = {}
    for number in numbers:
        path = out / f"{number}.npz"
        if path.exists():
            continue
        start = time.process_time()
        try:
            samples = make(number)
        except World2MinecraftError as error:
            print(f"{number} left out: {error}", flush=True)
            continue
        write_samples(path, samples)
        for sample in samples:
            false.setdefault(sample.kind, []).append(sample.false_share)
        shares = ", ".join(f"{kind} {np.mean(values):.3f}" for kind, values in false.items())
        print(f"{number} {time.process_time() - start:.2f} CPU s; false: {shares}", flush=True)


def main() -> None:
    """Write the files."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--first", type=int, default=FIRST_SEED)
    parser.add_argument("--rooms", type=int, default=500)
    parser.add_argument("--nyu", type=Path, metavar="DATA")
    parser.add_argument("--votes", type=Path, metavar="DATA")
    chosen = parser.parse_args()
    chosen.out.mkdir(parents=True, exist_ok=True)
    if chosen.votes:
        write_npz(chosen.out / VOTES_FILE.name, {"votes": measured_votes(chosen.votes)})
    elif chosen.nyu:
        frames = [FIRST_FRAME + number for number in frame_numbers(chosen.nyu, "train")]
        # Neighbours show the same rooms, so that few frames made early are of many rooms.
        numbers = [number for first in range(STRIDE) for number in frames[first::STRIDE]]
        write_all(chosen.out, numbers, lambda n: frame_samples(chosen.nyu, n - FIRST_FRAME))
    else:
        write_all(chosen.out, list(range(chosen.first, chosen.first + chosen.rooms)), make_samples)


if __name__ == "__main__":
    main()
