"""A labeller with a small 3D network, which also completes unseen cells close to surfaces.

The network (``weights/completion.onnx``) was trained on virtual scans of generated rooms. Observed
occupied cells stay occupied and get one of the eleven classes; observed free cells stay free.
Unseen cells are filled only in the rooms, and marked as completed: floor and walls continue behind
furniture, and other cells of structure are filled if the network is confident and surface of the
same class was seen nearby. Planes of floors and walls are straightened as by the other
labellers, and the labels of the geometric labeller are an input of the network. Large grids are
processed in tiles.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import CLASS_COUNT, SemanticClass
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.onnx_sessions import open_session, session_options
from world2minecraft.core.parameters import parameter
from world2minecraft.core.shipped_weights import read_weights, shipped
from world2minecraft.core.types import COMPLETED, UNSEEN, FusedEvidence, OccupancyGrid
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.reconstruction.layout.parameters import GeometricParameters
from world2minecraft.reconstruction.layout.room_space import RoomSpace, room_space
from world2minecraft.reconstruction.layout.storeys import Storey, find_storeys
from world2minecraft.reconstruction.layout.structure import structure_of
from world2minecraft.reconstruction.layout.surface_cells import Surface, surface_of
from world2minecraft.reconstruction.semantics.completion_channels import (
    CHANNELS,
    Sight,
    network_input,
    sight_of,
)
from world2minecraft.reconstruction.semantics.geometric_labeller import GeometricLabeller
from world2minecraft.reconstruction.semantics.smoothing import smooth_labels
from world2minecraft.reconstruction.semantics.votes_labeller import (
    geometric_prior,
    is_from_network,
)

WEIGHTS = shipped("completion.onnx")
LEARNT_VOXEL_M, VOXEL_TOLERANCE = 0.08, 0.25  # The network knows only such cells.
MULTIPLE = 8  # The sides of the network input are multiples of it.
TILE, MARGIN = 96, 16  # Cells; most rooms are one tile. At its edge, a tile shows less context.
MAX_BYTES = 64 << 20
THREADS = 2
HALF = 0.5

MIN_CHANCE = 1e-4
# Of a room's columns: generated single frames with floor in view show 0.06 to 0.53 of it, and
# those without 0.012 at most.
FLOOR_SHARE = 0.03
FIRST_THING = int(SemanticClass.CHAIR)
STRUCTURE = (SemanticClass.CEILING, SemanticClass.FLOOR, SemanticClass.WALL)
OFTEN_CHAIRS = (SemanticClass.TABLE, SemanticClass.OBJS)  # What the network takes chairs for.


class CompletionModel:
    """The completion network of a file, which is read on first use."""

    def __init__(self, weights: Path | None = None):
        self.weights = weights or WEIGHTS

    @cached_property
    def _session(self) -> Any:
        options = session_options(THREADS)
        options.enable_cpu_mem_arena = False
        session = open_session(self.weights, read_weights(self.weights, MAX_BYTES), options)
        taken = session.get_inputs()[0].shape
        if len(taken) != 5 or taken[1] != CHANNELS:
            raise DamagedFileError(
                self.weights,
                f"expected a network input of shape [1, {CHANNELS}, X, Y, Z], got {taken}",
            )
        return session

    def chances(self, sight: Sight) -> np.ndarray:
        """Predict the probability of each class for each cell, float32 [12, X, Y, Z].

        Raises:
            InputError: If the weights file does not exist.
            DamagedFileError: If the weights file is not a valid network.
        """
        cells = network_input(sight)
        shape = cells.shape[1:]
        result = np.zeros((CLASS_COUNT, *shape), np.float32)
        for x in spans(shape[0]):
            for y in spans(shape[1]):
                logits = self._logits(cells[:, x[0] : x[3], y[0] : y[3]])
                inner = logits[:, x[1] - x[0] : x[2] - x[0], y[1] - y[0] : y[2] - y[0]]
                result[:, x[1] : x[2], y[1] : y[2]] = softmax(inner)
        return result

    def _logits(self, cells: np.ndarray) -> np.ndarray:
        """Return the logits of one tile, padded with unknown cells to a multiple of the stride."""
        shape = cells.shape[1:]
        padding = [(0, -side % MULTIPLE) for side in shape]
        padded = np.pad(cells, [(0, 0), *padding])
        padded[2] = np.pad(cells[2], padding, constant_values=1)
        (logits,) = self._session.run(None, {self._session.get_inputs()[0].name: padded[None]})
        return logits[0, :, : shape[0], : shape[1], : shape[2]]


def likeliest(chance: np.ndarray, log_odds: np.ndarray) -> np.ndarray:
    """Return the most probable class of each cell, uint8 [X, Y, Z], keeping observed surface.

    Surface cells take the most probable of the eleven classes. Any other cell is solid if the sum
    of its class probabilities exceeds that of empty, which preserves more complete rooms than the
    best single class.

    Args:
        chance: Class probabilities, float32 [12, X, Y, Z].
        log_odds: Log-odds [X, Y, Z]; positive for observed surface.
    """
    best = chance[1:].argmax(axis=0).astype(np.uint8) + 1
    solid = (log_odds > 0) | (chance[0] < HALF)
    return np.where(solid, best, np.uint8(0))


def spans(length: int) -> list[tuple[int, int, int, int]]:
    """Return the tiles along a side: each with the cells to read and the cells to keep.

    Example:
        >>> spans(100)
        [(0, 0, 100, 100)]
        >>> spans(200)
        [(0, 0, 67, 83), (51, 67, 133, 149), (117, 133, 200, 200)]
    """
    count = 1 if length <= TILE + MARGIN else -(-length // TILE)
    edges = [round(length * n / count) for n in range(count + 1)]
    return [(max(a - MARGIN, 0), a, b, min(b + MARGIN, length)) for a, b in pairwise(edges)]


def softmax(logits: np.ndarray) -> np.ndarray:
    """Convert logits to probabilities along the first axis."""
    shares = np.exp(logits - logits.max(axis=0))
    return shares / shares.sum(axis=0)


@dataclass(frozen=True)
class CompletionParameters:
    """Parameters of the use of the network's prediction.

    small_cells: Number of cells below which a part takes the class around it.
    agreed_share: Minimum share of a geometric piece, weighted by probability, that must agree on a
        class before the whole piece takes this class.
    hint_share: Amount added to the probability of the geometric class of floor, walls and ceiling,
        and of a chair where the network prefers a table or an object.
    beside_votes: Weight of the network's probabilities compared to the shares of votes of label
        images in cells that have votes; the geometric label then counts as in the votes labeller.
    beside_network: The same beside the votes of a segmentation network.
    sure: Minimum probability of being solid for an unseen cell to be completed.
    reach_cells: Maximum distance of a completed cell from observed surface; 3 cells are 24 cm.
    clear_cells: Minimum distance of a completed cell from an observed object, except for the floor
        of the room.
    filled: Classes that are completed: ceiling, floor and wall.
    """

    small_cells: int = parameter(4, unit="cells", origin="not recorded")
    agreed_share: float = parameter(0.6, unit="share", origin="not recorded")
    hint_share: float = parameter(
        0.9,
        unit="chance",
        origin="on 36 NYUv2 frames, for cells that only the geometric labeller calls chair: "
        "it is right in 72 % and the network in 17 % if the network predicts a table or an object, "
        "but 38 % and 61 % if it predicts furniture; for other geometric classes, the network is "
        "right more often (objects 19 % and 40 %, furniture 14 % and 37 %); at 0.3, chairs at the "
        "table of a real kitchen are lost; for structure, the accuracy changes by less than 0.002",
    )
    beside_votes: float = parameter(0.2, unit="votes", origin="not recorded")
    beside_network: float = parameter(
        0.6,
        unit="votes",
        origin="on 19 NYUv2 frames that the segmentation network was not trained on, class "
        "accuracy is 0.811, 0.808, 0.803 and 0.798 at 0.2, 0.4, 0.6 and 0.8, and the worst frame "
        "loses 0.092, 0.069, 0.034 and 0.005 beside no votes",
    )
    sure: float = parameter(
        0.8,
        unit="chance",
        origin="chosen once on the held-out rooms; docs/explanation/completion.md",
    )
    reach_cells: int = parameter(3, unit="cells", origin="not recorded")
    clear_cells: int = parameter(
        1,
        unit="cells",
        origin="completed cells next to an object are hidden, and the object is lost if it shares "
        "a block with the completed wall behind it",
    )
    filled: tuple[int, ...] = parameter(
        (1, 2, 3),
        origin="completed furniture is mostly correct, but it reduced the object F1 of three "
        "tuning scans from 0.85 to 0.82",
    )


class CompletionLabeller:
    """A labeller that classifies observed surface with a network and completes cells near it."""

    def __init__(
        self,
        parameters: CompletionParameters | None = None,
        geometric: GeometricParameters | None = None,
        *,
        weights: Path | None = None,
    ):
        self.parameters = parameters or CompletionParameters()
        self.geometric = GeometricLabeller(geometric)
        self.model = CompletionModel(weights)

    def label(self, grid: OccupancyGrid, evidence: FusedEvidence) -> OccupancyGrid:
        """Return the grid with a class for each occupied cell and with unseen cells completed.

        The confidence is the probability of the class given by the network.

        Raises:
            ValueError: If grid and evidence do not have the same cells.
            DamagedFileError: If the weights file is not a valid network.
        """
        surface = surface_of(grid, evidence)
        storeys = find_storeys(surface, self.geometric.parameters.structure)
        base, origin = self.geometric.traced(grid, evidence, storeys)
        hint = hint_of(base, origin)
        chance = self._chances(grid, evidence, hint, storeys)
        named = self._named(base, origin, hint, chance, evidence.votes)
        return self._completed(named, chance, self._space(surface, storeys))

    def _space(self, surface: Surface, storeys: Sequence[Storey]) -> RoomSpace:
        """Return the space of the rooms of all storeys, without floors that were hardly seen."""
        rules = self.geometric.parameters.structure
        space = RoomSpace(*np.zeros((3, *surface.occupied.shape), bool))
        for storey in storeys:
            structure = structure_of(storey.surface(surface), rules)
            found = room_space(structure)
            seen = int((structure.floor.cells & found.floor).sum())
            if seen < FLOOR_SHARE * found.floor.sum():  # Its height is a guess.
                found.floor[:] = False
            for name, mask in vars(space).items():
                storey.part(mask)[:] = getattr(found, name)
        return space

    def _chances(
        self,
        grid: OccupancyGrid,
        evidence: FusedEvidence,
        hint: np.ndarray,
        storeys: Sequence[Storey],
    ) -> np.ndarray:
        """Return the probabilities, float32 [12, X, Y, Z], each storey relative to its floor."""
        chance = np.zeros((CLASS_COUNT, *grid.shape), np.float32)
        for storey in storeys:
            layers = slice(storey.low, storey.high)
            part = columns(grid, layers)
            sight = sight_of(
                part, columns_of_evidence(evidence, layers), hint[:, :, layers], storey.floor_z_m
            )
            chance[..., layers] = self.model.chances(sight)
        return chance

    def _named(
        self,
        base: OccupancyGrid,
        origin: np.ndarray,
        hint: np.ndarray,
        chance: np.ndarray,
        votes: np.ndarray,
    ) -> OccupancyGrid:
        """Return the straightened grid with the network's classes, unified per piece."""
        voted = piece_votes(hint, chance, self.parameters.agreed_share)
        cells = base.occupied
        share = voted.reshape(CLASS_COUNT, -1)[1:, origin[cells]]
        share = share / np.maximum(share.sum(axis=0), MIN_CHANCE)
        scores = share + self._from_hint(hint.reshape(-1)[origin[cells]], share)
        counts = votes.reshape(-1, CLASS_COUNT)[origin[cells], 1:].astype(np.float32).T
        has = counts.any(axis=0)
        shares = counts[:, has] / counts[:, has].sum(axis=0)
        votes_of = counts[:, has].T
        prior = geometric_prior(base.labels[cells][has], votes_of).T
        rules = self.parameters
        beside = np.where(is_from_network(votes_of), rules.beside_network, rules.beside_votes)
        scores[:, has] = shares + prior + beside * share[:, has]
        labels, confidence = base.labels.copy(), np.array(base.confidence, np.float32)
        kinds = scores.argmax(axis=0)
        labels[cells] = kinds + 1
        confidence[cells] = share[kinds, np.arange(len(kinds))]
        labels = smooth_labels(labels, self.parameters.small_cells)
        confidence = np.round(np.clip(confidence, 0, 1), 3)
        return replace(base, labels=labels, confidence=confidence.astype(np.float16))

    def _from_hint(self, hint: np.ndarray, share: np.ndarray) -> np.ndarray:
        """Return what geometric labels [N] add to the probabilities, both float32 [11, N]."""
        result = np.zeros_like(share)
        chair = (hint == SemanticClass.CHAIR) & np.isin(share.argmax(axis=0) + 1, OFTEN_CHAIRS)
        trusted = np.flatnonzero(chair | np.isin(hint, STRUCTURE))
        result[hint[trusted] - 1, trusted] = self.parameters.hint_share
        return result

    def _completed(
        self, grid: OccupancyGrid, chance: np.ndarray, space: RoomSpace
    ) -> OccupancyGrid:
        """Return the grid with unseen cells of the rooms filled.

        The floor and the walls' faces continue behind furniture. Other cells of floor, walls and
        ceiling are filled close to surface of their class if the network is confident.
        """
        rules = self.parameters
        best = chance[1:].argmax(axis=0).astype(np.uint8) + 1
        unseen = grid.source == UNSEEN
        clear = ~_near(grid.occupied & (grid.labels >= FIRST_THING), rules.clear_cells)
        wanted = unseen & space.cells & clear & (1 - chance[0] >= rules.sure)
        explained = {SemanticClass.FLOOR: space.floor, SemanticClass.WALL: space.wall & clear}
        labels, source = grid.labels.copy(), grid.source.copy()
        confidence, colour = grid.confidence.copy(), grid.colour.copy()
        for kind in rules.filled:
            seen, like = grid.labels == kind, wanted & (best == kind)
            if not seen.any():
                continue
            fill = like & _reached(like | seen, kind, seen, rules.reach_cells)
            if kind in explained:
                fill |= unseen & explained[SemanticClass(kind)]
            if not fill.any():
                continue
            labels[fill], source[fill] = kind, COMPLETED
            confidence[fill] = np.round(chance[kind][fill], 3)
            nearest = ndimage.distance_transform_edt(
                ~seen, return_distances=False, return_indices=True
            )
            colour[fill] = grid.colour[tuple(np.asarray(nearest)[:, fill])]
        return replace(grid, labels=labels, source=source, confidence=confidence, colour=colour)


def hint_of(base: OccupancyGrid, origin: np.ndarray) -> np.ndarray:
    """Return the class of each cell whose surface the geometric labeller kept, uint8 [X, Y, Z].

    Args:
        base: Grid from ``GeometricLabeller.traced``.
        origin: Cell in which the surface of each cell was seen, int64 [X, Y, Z], from the same
            call.
    """
    hint = np.zeros(base.shape, np.uint8)
    retained = base.occupied
    hint.reshape(-1)[origin[retained]] = base.labels[retained]
    return hint


def piece_votes(hint: np.ndarray, chance: np.ndarray, agreed_share: float) -> np.ndarray:
    """Return probabilities in which the cells of a piece agree if most of them do.

    A piece is a connected part of one object class (5 to 11) of the geometric labeller, which
    separates objects better than it classifies them.

    Args:
        hint: Geometric labels, uint8 [X, Y, Z].
        chance: Class probabilities, float32 [12, X, Y, Z].
        agreed_share: Minimum mean probability of the common class.
    """
    voted = chance.copy()
    for kind in range(SemanticClass.CHAIR, CLASS_COUNT):
        parts, count = label_components(hint == kind, corners=False)
        if not count:
            continue
        inside = parts > 0
        owner = parts[inside]
        of_cells = chance[1:, inside]
        of_cells = of_cells / np.maximum(of_cells.sum(axis=0), MIN_CHANCE)
        sums = np.stack([np.bincount(owner, row, count + 1) for row in of_cells])
        mean = sums / np.maximum(np.bincount(owner, minlength=count + 1), 1)
        agreed = mean.max(axis=0) >= agreed_share
        changed = agreed[owner]
        rows = voted[:, inside]
        rows[0, changed] = 0
        rows[1:, changed] = mean[:, owner[changed]]
        voted[:, inside] = rows
    return voted


def columns(grid: OccupancyGrid, layers: slice) -> OccupancyGrid:
    """Return some layers of a grid."""
    arrays = ("labels", "confidence", "colour", "source", "instance")
    cut = {name: getattr(grid, name)[:, :, layers] for name in arrays}
    return replace(grid, origin_m=_raised(grid, layers), **cut)


def columns_of_evidence(evidence: FusedEvidence, layers: slice) -> FusedEvidence:
    """Return some layers of evidence."""
    arrays = ("log_odds", "votes", "colour_sum", "offset_sum", "hits")
    cut = {name: getattr(evidence, name)[:, :, layers] for name in arrays}
    return replace(evidence, origin_m=_raised(evidence, layers), **cut)


def _raised(value: OccupancyGrid | FusedEvidence, layers: slice) -> np.ndarray:
    return value.origin_m + np.array([0.0, 0.0, layers.start * value.voxel_m])


def _near(cells: np.ndarray, steps: int) -> np.ndarray:
    """Return the cells within a number of steps of a mask, over faces, edges and corners."""
    box = np.ones([2 * steps + 1] * 3, bool)
    return np.asarray(ndimage.binary_dilation(cells, box), bool)


def _reached(way: np.ndarray, kind: int, seen: np.ndarray, steps: int) -> np.ndarray:
    """Return the cells reachable in few steps within the planes of a class of structure.

    A plane grows only along itself, since the network was not trained on the space behind walls.
    Walls are distinguished from objects across them by the 3 x 3 cells of their plane.
    """
    result = np.zeros(seen.shape, bool)
    level = kind in (SemanticClass.CEILING, SemanticClass.FLOOR)
    for axis in (2,) if level else (0, 1):
        plane = np.ones([1 if a == axis else 3 for a in range(3)], bool)
        flat = ndimage.binary_opening(seen, plane)
        result |= ndimage.binary_dilation(flat, plane, iterations=steps, mask=way | flat)
    return result
