"""Votes for the 40 NYU classes and for fine names, by place in the room.

Segmentation networks and label images vote for cells with twelve classes (``semantic_fusion``).
Their finer labels are kept beside that, summed over the points of small cubes, so that objects can
get fine names after they have been found.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError
from world2minecraft.core.files import npz_array_names, read_npz, write_npz
from world2minecraft.core.types import OccupancyGrid, checks
from world2minecraft.core.vocabulary import NYU40_COUNT, label_id_names, label_id_nyu40

NAME_VOTES = "names.npz"  # In the folder of a run.
CUBE_M = 0.08  # Of votes, whatever the cells of the grid.
MAX_STORED = 60_000.0  # Votes in a cube, as 16-bit floats; more are scaled down.


@dataclass(frozen=True, eq=False)
class NameVotes:
    """Votes at places of a room.

    Attributes:
        cubes: Cubes of ``CUBE_M`` by their index from the room's origin, int32 [N, 3].
        votes: Sums of the probabilities of the label ids from 1 (``core.vocabulary.
            label_id_names``), float32 [N, K]: 40 NYU classes, and then all names if labels state
            some.
    """

    cubes: np.ndarray
    votes: np.ndarray

    def __post_init__(self):
        cubes = checks.array("cubes", self.cubes, np.int32, (None, 3))
        object.__setattr__(self, "cubes", cubes)
        votes = checks.array("votes", self.votes, np.float32, (len(cubes), None))
        if votes.shape[1] not in (NYU40_COUNT, len(label_id_names()) - 1):
            raise ValueError(f"votes must be for {NYU40_COUNT} classes or for all label ids")
        object.__setattr__(self, "votes", votes)


class CubeIndex:
    """The places of cubes, int [N, 3], for look-up."""

    def __init__(self, cubes: np.ndarray):
        self._low = cubes.min(axis=0, initial=np.iinfo(np.int32).max).astype(np.int64)
        self._shape = np.maximum(cubes.max(axis=0, initial=-1) + 1 - self._low, 0)
        numbers = self._numbers(cubes)
        self._order = np.argsort(numbers, kind="stable")
        self._sorted = numbers[self._order]

    def find(self, cubes: np.ndarray) -> np.ndarray:
        """Return the row of each cube, int [M, 3], as int64 [M], or -1 if it is not among them."""
        inside = ((cubes >= self._low) & (cubes < self._low + self._shape)).all(axis=1)
        found = np.full(len(cubes), -1)
        wanted = self._numbers(cubes[inside])
        place = np.minimum(np.searchsorted(self._sorted, wanted), len(self._sorted) - 1)
        found[inside] = np.where(self._sorted[place] == wanted, self._order[place], -1)
        return found

    def _numbers(self, cubes: np.ndarray) -> np.ndarray:
        x, y, z = (cubes.astype(np.int64) - self._low).T
        return (x * self._shape[1] + y) * self._shape[2] + z


class NameVoteMap:
    """Collects the votes of views."""

    def __init__(self) -> None:
        self._cubes: list[np.ndarray] = []
        self._votes: list[np.ndarray] = []

    @classmethod
    def joined(cls, maps: Sequence["NameVoteMap"]) -> "NameVoteMap":
        """Return a map with the votes of several maps."""
        result = cls()
        for one in maps:
            result._cubes += one._cubes
            result._votes += one._votes
        return result

    def add(self, points_m: np.ndarray, pixels: np.ndarray, probabilities: np.ndarray) -> None:
        """Add the votes of one view. Each pixel of the network votes at one of its points.

        Args:
            points_m: Points in the room in metres, float [N, 3].
            pixels: Flat index of the network's pixel that shows each point, int [N].
            probabilities: Probabilities of NYU40 classes 1 to 40 by pixel, float [P, 40].
        """
        shown, first = _first_of_each(pixels, len(probabilities))
        cubes = np.floor(points_m[first] / CUBE_M).astype(np.int32)
        summed = _summed(cubes, probabilities[shown].astype(np.float32))
        self._cubes.append(summed.cubes)
        self._votes.append(summed.votes)

    def add_labels(self, points_m: np.ndarray, pixels: np.ndarray, label_ids: np.ndarray) -> None:
        """Add the labels of one view. Each pixel of its label image votes at one of its points.

        Args:
            points_m: Points in the room in metres, float [N, 3].
            pixels: Flat index of the pixel of the label image that shows each point, int [N].
            label_ids: Label ids by pixel, uint16 [P]; 0 does not vote.
        """
        shown, first = _first_of_each(pixels, len(label_ids))
        voting = label_ids[shown] > 0
        cubes = np.floor(points_m[first[voting]] / CUBE_M).astype(np.int32)
        kept, owner = np.unique(cubes, axis=0, return_inverse=True)
        votes = np.zeros((len(kept), len(label_id_names()) - 1), np.float32)
        np.add.at(votes, (owner.reshape(-1), label_ids[shown[voting]].astype(np.int64) - 1), 1)
        if len(kept):
            self._cubes.append(kept)
            self._votes.append(votes)

    def votes(self) -> NameVotes:
        """Return the sums over all views."""
        if not self._cubes:
            return NameVotes(np.zeros((0, 3), np.int32), np.zeros((0, NYU40_COUNT), np.float32))
        width = max(votes.shape[1] for votes in self._votes)
        votes = [np.pad(part, ((0, 0), (0, width - part.shape[1]))) for part in self._votes]
        return _summed(np.concatenate(self._cubes), np.concatenate(votes))


def _first_of_each(values: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the different values below ``count`` in order, and the first place of each."""
    first = np.full(count, -1, np.int64)
    first[values[::-1]] = np.arange(len(values) - 1, -1, -1)
    shown = np.flatnonzero(first >= 0)
    return shown, first[shown]


def _summed(cubes: np.ndarray, votes: np.ndarray) -> NameVotes:
    """Return the sums of votes in the same cube."""
    if not len(cubes):
        return NameVotes(cubes, votes)
    order, starts = _group(cubes)
    return NameVotes(cubes[order[starts]], np.add.reduceat(votes[order], starts, axis=0))


def _group(cubes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the order that sorts cubes, int [N, 3], and where each different one begins."""
    order = np.lexsort(cubes.T[::-1])
    placed = cubes[order]
    changes = (placed[1:] != placed[:-1]).any(axis=1)
    return order, np.flatnonzero(np.concatenate([[True], changes]))


def votes_of_objects(votes: NameVotes, grid: OccupancyGrid, count: int) -> np.ndarray:
    """Return the votes in the cells of each object, float32 [count + 1, K]; row 0 is no object.

    Args:
        votes: Votes in the room.
        grid: Grid with the instance of each cell, 1 to ``count``.
        count: Number of objects.
    """
    result = np.zeros((count + 1, votes.votes.shape[1]), np.float32)
    cells, rows = votes_of_cells(votes, grid)
    np.add.at(result, np.minimum(grid.instance[tuple(cells.T)], count), rows)
    return result


def votes_of_cells(votes: NameVotes, grid: OccupancyGrid) -> tuple[np.ndarray, np.ndarray]:
    """Return the cells of a grid at which there are votes, int64 [N, 3], and the votes [N, K]."""
    middles_m = (votes.cubes + 0.5) * CUBE_M
    cells = np.floor((middles_m - grid.origin_m) / grid.voxel_m).astype(np.int64)
    inside = ((cells >= 0) & (cells < grid.shape)).all(axis=1)
    return cells[inside], votes.votes[inside]


def class_votes(votes: np.ndarray) -> np.ndarray:
    """Return votes for the label ids from 1, float [..., K], as votes for NYU40 classes [..., 40].

    Votes for a name count for its class.
    """
    classes = votes[..., :NYU40_COUNT].copy()
    for number, nyu40 in enumerate(label_id_nyu40()[NYU40_COUNT : votes.shape[-1]], NYU40_COUNT):
        classes[..., nyu40 - 1] += votes[..., number]
    return classes


def write_name_votes(path: Path, votes: NameVotes) -> None:
    """Write votes to ``names.npz``, with the names of the columns after the NYU40 classes."""
    names = label_id_names()[NYU40_COUNT + 1 : votes.votes.shape[1] + 1]
    largest = votes.votes.max(axis=1, keepdims=True, initial=1.0)
    stored = votes.votes * np.minimum(MAX_STORED / largest, 1)
    arrays = {"cubes": votes.cubes, "votes": stored.astype(np.float16)}
    write_npz(path, arrays | {"names": np.array(names, np.str_)})


def read_name_votes(path: Path) -> NameVotes:
    """Read votes. Votes for names that the vocabulary lacks are left out.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file does not contain votes.
    """
    arrays = read_npz(path, ("cubes", "votes"))
    names: list[str] = []
    if "names" in npz_array_names(path):
        names = [str(name) for name in read_npz(path, ("names",))["names"].reshape(-1)]
    try:
        stored = arrays["votes"].astype(np.float32)
        if stored.ndim != 2 or stored.shape[1] != NYU40_COUNT + len(names):
            raise ValueError(f"votes must have {NYU40_COUNT + len(names)} columns")
        if not names:
            return NameVotes(arrays["cubes"], stored)
        votes = np.zeros((len(stored), len(label_id_names()) - 1), np.float32)
        votes[:, :NYU40_COUNT] = stored[:, :NYU40_COUNT]
        known = {name: number for number, name in enumerate(label_id_names()[NYU40_COUNT + 1 :])}
        for column, name in enumerate(names):
            if name in known:
                votes[:, NYU40_COUNT + known[name]] = stored[:, NYU40_COUNT + column]
        return NameVotes(arrays["cubes"], votes)
    except MALFORMED as error:
        raise DamagedFileError(path, f"does not contain votes ({error})") from error
