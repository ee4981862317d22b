"""All losses of an occupancy network, each already weighted, so that their sum is minimised.

- cross entropy of the classes, and MonoScene's scene-class affinity (SCAL);
- MonoScene's frustum proportion loss: the classes in each part of the image, hidden or not;
- the loss of MonoScene's context prior: four relations of coarse cells with mega-voxels;
- the loss of a depth branch: cross entropy of the bin that a pixel's depth falls into.

Cells of 255 count in none. Where nothing is left to count, a loss is 0 and its gradients are 0.
"""

import math
from dataclasses import dataclass

import torch
from torch import Tensor

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.core.errors import UsageError
from world2minecraft.networks.batch import OccInput, OccOutput, OccTarget
from world2minecraft.networks.layers.context_prior import RELATIONS
from world2minecraft.networks.layers.depth_bins import bin_of, min_pool_depth
from world2minecraft.networks.layers.projection import project_cells

FRUSTA = 8  # Along each side of the picture.
MIN_SHARE = 1e-6
COARSE_FACTOR = 4  # From the grid to its coarsest level.
EMPTY_SHARE = 0.95  # SSCNet's: a coarse cell is empty where more than that is empty or unknown.
EMPTY_WEIGHT = 0.05  # MonoScene's weight of empty cells in the cross entropy; all others have 1.


def depth_loss(logits: Tensor, depth_m: Tensor) -> Tensor:
    """Return the mean over the branch's pixels that have a depth within its bins.

    Args:
        logits: float [B, bins, ceil(H / s), ceil(W / s)], s a power of two.
        depth_m: float32 [B, H, W], 0 where there is none. A pixel of the branch is to say the least
            depth of those that it covers, as the nearer hides what is behind.
    """
    scale = 2 ** round(math.log2(depth_m.shape[-1] / logits.shape[-1]))
    near = min_pool_depth(depth_m, scale)
    bins = int(logits.shape[1])
    wanted, known = bin_of(near, bins)
    each = torch.nn.functional.cross_entropy(logits.float(), wanted, reduction="none")
    return (each * known).sum() / known.sum().clamp(min=1)


def frustum_loss(logits: Tensor, labels: Tensor, inputs: OccInput) -> Tensor:
    """Return the mean KL divergence of the classes' shares in 8x8 parts of the pictures.

    Shares are of the whole batch: the cells that fall into a part in any of its pictures. Only
    classes that a part truly holds count.

    Args:
        logits: float [B, 12, X, Y, Z].
        labels: int64 [B, X, Y, Z].
        inputs: where the cells lie in the pictures.
    """
    part = frustum_of_cells(inputs)  # [B, N]
    labels = labels.flatten(1)
    counted = (part >= 0) & (labels != UNKNOWN)
    part, labels = part[counted], labels[counted]
    shares = torch.softmax(logits.float(), dim=1).flatten(2).movedim(1, 2)[counted]  # [K, 12]
    predicted = _sums(part, shares)
    truth = _sums(part, torch.nn.functional.one_hot(labels, CLASS_COUNT).float())
    cells = truth.sum(dim=1, keepdim=True)
    truth, predicted = truth / cells.clamp(min=1), predicted / cells.clamp(min=1)
    each = torch.where(
        truth > 0,
        truth * (truth.clamp(min=MIN_SHARE).log() - predicted.clamp(min=MIN_SHARE).log()),
        torch.zeros_like(truth),
    )
    return each.sum() / (cells > 0).sum().clamp(min=1)


def frustum_of_cells(inputs: OccInput) -> Tensor:
    """Return the part of the picture that each cell falls into, int64 [B, N], -1 for none."""
    sight = project_cells(inputs)
    height, width = sight.size_px
    column = (sight.pixels[..., 0] * FRUSTA / width).floor().clamp(0, FRUSTA - 1).long()
    row = (sight.pixels[..., 1] * FRUSTA / height).floor().clamp(0, FRUSTA - 1).long()
    return torch.where(sight.inside, row * FRUSTA + column, -1)


def _sums(part: Tensor, values: Tensor) -> Tensor:
    empty = values.new_zeros(FRUSTA * FRUSTA, values.shape[1])
    return empty.index_add(0, part, values)


def relation_loss(logits: Tensor, labels: Tensor) -> Tensor:
    """Return the binary cross entropy of all relations, each balanced by how rare it is.

    Args:
        logits: float [B, 4, megas, cells], of the grid's quarter.
        labels: int64 [B, X, Y, Z] of the whole grid.

    A pair counts where the cell is known and a cell of the mega-voxel is too; the published code
    takes such pairs for unrelated.
    """
    truth, counted = relations_of(coarse_labels(labels))
    truth, weights = truth.float(), counted.float()
    positives = (truth * weights).sum(dim=(0, 2, 3))
    negatives = ((1 - truth) * weights).sum(dim=(0, 2, 3))
    balance = torch.where(
        positives > 0, negatives / positives.clamp(min=1), torch.ones_like(positives)
    )
    each = torch.nn.functional.binary_cross_entropy_with_logits(
        logits.float(), truth, pos_weight=balance[:, None, None], reduction="none"
    )
    return (each * weights).sum() / (weights.sum() * RELATIONS).clamp(min=1)


def relations_of(labels: Tensor) -> tuple[Tensor, Tensor]:
    """Return which relations hold, and which pairs are known.

    A relation holds between a cell and a mega-voxel where it holds between the cell and any known
    one of the mega-voxel's eight: both occupied and alike, both occupied and unlike, both empty,
    one of them empty.

    Args:
        labels: int64 [B, X, Y, Z] at the coarsest level.

    Returns:
        bool [B, 4, M, N], and bool [B, 1, M, N].
    """
    eight = _mega_voxel_cells(labels)[:, :, :, None]  # [B, M, 8, 1]
    cells = labels.flatten(1)[:, None, None]  # [B, 1, 1, N]
    known = (eight != UNKNOWN) & (cells != UNKNOWN)
    alike, both = eight == cells, (eight != 0) & (cells != 0)
    none = (eight == 0) & (cells == 0)
    relations = (alike & both, ~alike & both, none, ~alike & ~both)
    return torch.stack([(one & known).any(dim=2) for one in relations], dim=1), known.any(dim=2)[
        :, None
    ]


def coarse_labels(labels: Tensor, factor: int = COARSE_FACTOR) -> Tensor:
    """Return labels of blocks of cells by SSCNet's rule, int64, sides rounded up.

    A block is not occupied where more than 95 % of its cells are empty or unknown: then it is what
    more of them are. Else it is the class that most of its occupied cells have. Cells beyond the
    grid are unknown.
    """
    beyond = [(-int(side)) % factor for side in labels.shape[1:]]
    padded = torch.nn.functional.pad(
        labels, (0, beyond[2], 0, beyond[1], 0, beyond[0]), value=UNKNOWN
    )
    kinds = torch.where(padded == UNKNOWN, CLASS_COUNT, padded)
    counts = torch.stack(
        [_block_sums((kinds == kind).float(), factor) for kind in range(CLASS_COUNT + 1)], dim=1
    )
    empty, unknown = counts[:, 0], counts[:, CLASS_COUNT]
    best = counts[:, 1:CLASS_COUNT].argmax(dim=1) + 1
    hollow = torch.where(empty > unknown, 0, UNKNOWN)
    return torch.where(empty + unknown > EMPTY_SHARE * factor**3, hollow, best)


def _block_sums(values: Tensor, factor: int) -> Tensor:
    sums = torch.nn.functional.avg_pool3d(values[:, None], factor)[:, 0] * factor**3
    return torch.round(sums)


def _mega_voxel_cells(labels: Tensor) -> Tensor:
    """Return the eight cells of each whole mega-voxel, [B, M, 8]."""
    x, y, z = (int(side) // 2 * 2 for side in labels.shape[1:])
    blocks = labels[:, :x, :y, :z].reshape(-1, x // 2, 2, y // 2, 2, z // 2, 2)
    return blocks.permute(0, 1, 3, 5, 2, 4, 6).reshape(len(labels), -1, 8)


def cross_entropy(logits: Tensor, labels: Tensor, class_weights: Tensor | None = None) -> Tensor:
    """Return the mean over known cells, weighted by their classes.

    Args:
        logits: float [B, 12, X, Y, Z].
        labels: int64 [B, X, Y, Z], 0 to 11 or 255.
        class_weights: float32 [12]; all 1 where left out.
    """
    known = labels != UNKNOWN
    targets = torch.where(known, labels, torch.zeros_like(labels))
    each = torch.nn.functional.cross_entropy(logits.float(), targets, reduction="none")
    weights = known.float()
    if class_weights is not None:
        weights = weights * class_weights.to(logits.device, torch.float32)[targets]
    return (each * weights).sum() / weights.sum().clamp(min=1e-6)


def semantic_affinity(logits: Tensor, labels: Tensor) -> Tensor:
    """Return MonoScene's L_scal over classes: soft precision, recall and specificity of each.

    The mean is over the classes that the batch holds, the empty one among them.
    """
    known = labels != UNKNOWN
    shares = torch.softmax(logits.float(), dim=1).movedim(1, 0)[:, known]  # [12, N]
    truth = (labels[known] == torch.arange(CLASS_COUNT, device=labels.device)[:, None]).float()
    present = (truth.sum(dim=1) > 0).float()
    return (_affinity(shares, truth) * present).sum() / present.sum().clamp(min=1)


def geometric_affinity(logits: Tensor, labels: Tensor) -> Tensor:
    """Return the same of two classes, where only the occupied one is judged: L_scal of geometry."""
    known = labels != UNKNOWN
    full = 1 - torch.softmax(logits.float(), dim=1)[:, 0]
    return _affinity(full[known][None], (labels[known] != 0).float()[None])[0]


def _affinity(shares: Tensor, truth: Tensor) -> Tensor:
    """Return [K] minus log precision, recall and specificity; what has nothing to count is 0."""
    met = (shares * truth).sum(dim=1)
    absent = 1 - truth
    precision = _less_log(met, shares.sum(dim=1), truth.sum(dim=1))
    recall = _less_log(met, truth.sum(dim=1), truth.sum(dim=1))
    specificity = _less_log(
        ((1 - shares) * absent).sum(dim=1), absent.sum(dim=1), absent.sum(dim=1)
    )
    return precision + recall + specificity


def _less_log(part: Tensor, whole: Tensor, counted: Tensor) -> Tensor:
    share = part / whole.clamp(min=MIN_SHARE)
    return torch.where(counted > 0, -share.clamp(min=MIN_SHARE).log(), torch.zeros_like(share))


@dataclass(frozen=True)
class LossWeights:
    """How much each loss counts; 0 leaves it out. All but the last are 1 as published.

    ``classes`` are the weights of the 12 classes in the cross entropy; None for the published
    0.05 of empty and 1 of all others.
    """

    cross_entropy: float = 1.0
    semantic: float = 1.0
    geometric: float = 1.0
    frusta: float = 1.0
    relations: float = 1.0
    depth: float = 1.0
    auxiliary: float = 0.5  # Of the answers of earlier layers, as Symphonies has it.
    classes: tuple[float, ...] | None = None

    def __post_init__(self):
        if self.classes is not None and len(self.classes) != CLASS_COUNT:
            raise UsageError(f"there are {CLASS_COUNT} class weights, not {len(self.classes)}")
        if self.classes is not None and not all(0 <= weight < torch.inf for weight in self.classes):
            raise UsageError("class weights are finite and not below 0")

    def class_weights(self) -> Tensor:
        """Return the weights of the classes in the cross entropy, float32 [12]."""
        published = (EMPTY_WEIGHT, *([1.0] * (CLASS_COUNT - 1)))
        return torch.tensor(self.classes or published)


def occupancy_losses(
    output: OccOutput,
    target: OccTarget,
    inputs: OccInput,
    weights: LossWeights | None = None,
) -> dict[str, Tensor]:
    """Return the weighted losses by name; ``sum(found.values())`` is the loss of a step.

    Args:
        output: of the network.
        target: what is true. Cells of 255 teach nothing.
        inputs: what the network saw: its cameras cut the frusta, its depth teaches a depth branch
            where the target has none.
        weights: how much each counts.

    Losses without an input are left out: relations and depth where the network predicts none of
    them or, for depth, where none is known.
    """
    chosen = weights or LossWeights()
    found = _class_losses(output.logits, target.labels, inputs, chosen)
    if output.relations is not None and chosen.relations:
        found["relations"] = chosen.relations * relation_loss(output.relations, target.labels)
    depth_m = inputs.depth_m if target.depth_m is None else target.depth_m
    if output.depth_logits is not None and depth_m is not None and chosen.depth:
        found["depth"] = chosen.depth * depth_loss(output.depth_logits, depth_m)
    if output.auxiliary and chosen.auxiliary:
        earlier = [
            sum(_class_losses(logits, target.labels, inputs, chosen).values(), logits.new_zeros(()))
            for logits in output.auxiliary
        ]
        found["auxiliary"] = chosen.auxiliary * torch.stack(earlier).sum()
    return found


def _class_losses(
    logits: Tensor, labels: Tensor, inputs: OccInput, weights: LossWeights
) -> dict[str, Tensor]:
    found: dict[str, Tensor] = {}
    if weights.cross_entropy:
        taught = cross_entropy(logits, labels, weights.class_weights())
        found["cross_entropy"] = weights.cross_entropy * taught
    if weights.semantic:
        found["semantic"] = weights.semantic * semantic_affinity(logits, labels)
    if weights.geometric:
        found["geometric"] = weights.geometric * geometric_affinity(logits, labels)
    if weights.frusta:
        found["frusta"] = weights.frusta * frustum_loss(logits, labels, inputs)
    return found
