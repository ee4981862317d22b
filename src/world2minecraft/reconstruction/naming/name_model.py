"""The model that gives objects fine names from votes, size, place and the other objects.

``weights/object_names.npz`` holds a network with one hidden layer, trained by
``benchmarks/train_names.py`` on the objects of generated rooms with noise. It decides among the
names of an NYU40 class, such as table, desk and coffee table; votes decide among these classes.
Votes of label images for names, not for classes, decide among names too.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from world2minecraft.core.classes import CLASS_DISPLAY_NAMES, OBJECT_CLASSES
from world2minecraft.core.files import MAX_ARRAY_BYTES, read_npz_bytes
from world2minecraft.core.shipped_weights import read_weights, shipped
from world2minecraft.core.vocabulary import (
    MIN_NAME_CONFIDENCE,
    NYU40_COUNT,
    label_id_nyu40,
    read_vocabulary,
)
from world2minecraft.reconstruction.naming.name_votes import class_votes

WEIGHTS = shipped("object_names.npz")
MAX_WALL_M, MAX_GAP_M = 1.0, 1.0
SMALLEST_M, SMALLEST_CHANCE = 0.04, 1e-9
# Log-odds that a name is right: constant, and factors of the log-odds of its share in the votes and
# of log(votes / 1000). ``benchmarks/fit_name_confidence.py`` fits them.
CALIBRATION = (0.139, 1.486, 0.12)
SHARE_LIMITS = (0.01, 0.99)


@dataclass(frozen=True, eq=False)
class ObjectTraits:
    """What is known of an object.

    Attributes:
        class_id: Class, 5 to 11.
        size_m: Front to back, side to side and height in metres.
        bottom_m: Height of its lowest face above the floor.
        wall_m: Horizontal distance to the nearest wall; large if there is none.
        ceiling_m: Distance of its top to the ceiling; large if it was not seen.
        votes: Shares of the label ids from 1 in its votes, float [40] for the NYU40 classes or
            float [K] with all names after them; zeros without votes.
        vote_count: Number of votes, such as pixels of views; 0 without votes.
    """

    class_id: int
    size_m: tuple[float, float, float]
    bottom_m: float
    wall_m: float
    ceiling_m: float
    votes: np.ndarray
    vote_count: float = 0.0


def features_of(objects: Sequence[ObjectTraits]) -> np.ndarray:
    """Return the inputs of the model for the objects of one room, float32 [N, FEATURES]."""
    count = len(objects)
    if not count:
        return np.zeros((0, FEATURES), np.float32)
    votes = np.stack([class_votes(item.votes) for item in objects]).astype(np.float32)
    rows = []
    for number, item in enumerate(objects):
        side, across = sorted(item.size_m[:2])
        lengths = np.log(np.maximum([side, across, item.size_m[2]], SMALLEST_M))
        place = [
            item.bottom_m,
            item.bottom_m + item.size_m[2],
            min(item.wall_m, MAX_WALL_M),
            min(item.ceiling_m, MAX_GAP_M),
            float(votes[number].any()),
        ]
        kinds = [float(item.class_id == kind) for kind in OBJECT_CLASSES]
        others = np.delete(votes, number, axis=0).max(axis=0, initial=0.0)
        rows.append(np.concatenate([votes[number], others, lengths, place, kinds]))
    return np.stack(rows).astype(np.float32)


FEATURES = 40 + 40 + 3 + 5 + len(OBJECT_CLASSES)


@dataclass(frozen=True, eq=False)
class NameModel:
    """The weights of the model.

    Attributes:
        names: Names that it can give, in the order of its outputs.
        arrays: ``mean`` and ``scale`` of the inputs, and the weights ``w1``, ``b1``, ``w2`` and
            ``b2``, as float32.
    """

    names: tuple[str, ...]
    arrays: dict[str, np.ndarray]

    def probabilities(self, features: np.ndarray) -> np.ndarray:
        """Return the probability of each name, float32 [N, names].

        Args:
            features: Inputs from ``features_of``, float32 [N, FEATURES].
        """
        a = self.arrays
        hidden = np.maximum((features - a["mean"]) / a["scale"] @ a["w1"] + a["b1"], 0)
        logits = hidden @ a["w2"] + a["b2"]
        shares = np.exp(logits - logits.max(axis=1, keepdims=True, initial=-np.inf))
        return shares / shares.sum(axis=1, keepdims=True)


ARRAYS = ("mean", "scale", "w1", "b1", "w2", "b2")


@cache
def read_name_model() -> NameModel:
    """Read the weights of the program.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is damaged.
    """
    data = read_weights(WEIGHTS)
    arrays = read_npz_bytes(data, (*ARRAYS, "names"), WEIGHTS, MAX_ARRAY_BYTES)
    names = tuple(str(name) for name in arrays.pop("names"))
    return NameModel(names, arrays)


def name_objects(
    objects: Sequence[ObjectTraits], model: NameModel | None = None
) -> list[tuple[str, float]]:
    """Return the name of each object of a room, and its probability.

    The votes decide among the 40 NYU classes, and the model among the names of each class: the
    segmentation network saw real rooms, and the model saw generated rooms only. Votes for names
    count as such. Below ``MIN_NAME_CONFIDENCE``, and without votes, the name is that of the class;
    the probability is still that of the best name.
    """
    chosen = model or read_name_model()
    names, nyu40 = tuple(read_vocabulary().names), label_id_nyu40()[NYU40_COUNT:] - 1
    order = [names.index(name) for name in chosen.names]
    only = _names_without_model(chosen.names)
    chance = np.zeros((len(objects), len(names)), np.float32)
    chance[:, order] = chosen.probabilities(features_of(objects))
    result = []
    for item, row in zip(objects, chance, strict=True):
        within = np.bincount(nyu40, row, NYU40_COUNT)[nyu40]
        shares = item.votes[nyu40] * np.where(only, 1, row / np.maximum(within, SMALLEST_CHANCE))
        if len(item.votes) > NYU40_COUNT:
            shares += item.votes[NYU40_COUNT:]
        if not item.votes.any():
            result.append((CLASS_DISPLAY_NAMES[item.class_id], float(row.max())))
            continue
        best = int(shares.argmax())
        confidence = calibrated(float(shares[best]), item.vote_count)
        sure = confidence >= MIN_NAME_CONFIDENCE
        result.append((names[best] if sure else CLASS_DISPLAY_NAMES[item.class_id], confidence))
    return result


def _names_without_model(known: tuple[str, ...]) -> np.ndarray:
    """Return which names of the vocabulary are the first of an NYU40 class unknown to the model.

    Generated rooms have no blinds, cushions, papers and people, so votes alone decide on these.
    """
    seen = {read_vocabulary().names[name].nyu40 for name in known}
    result = np.zeros(len(read_vocabulary().names), bool)
    for number, entry in enumerate(read_vocabulary().names.values()):
        result[number] = entry.class_id in OBJECT_CLASSES and entry.nyu40 not in seen
        seen.add(entry.nyu40)
    return result


def calibrated(share: float, vote_count: float) -> float:
    """Return the probability that a name is right, from its share in a number of votes.

    Example:
        >>> round(calibrated(0.5, 1000), 2), calibrated(0.5, 40_000) > calibrated(0.5, 1000)
        (0.53, True)
    """
    constant, by_share, by_count = CALIBRATION
    limited = min(max(share, SHARE_LIMITS[0]), SHARE_LIMITS[1])
    odds = by_share * np.log(limited / (1 - limited))
    odds += by_count * np.log(max(vote_count, 1) / 1000)
    return float(1 / (1 + np.exp(-constant - odds)))
