"""The losses of an occupancy network. Each is already weighted, and their sum is minimized.

- Cross entropy of the classes, and MonoScene's scene-class affinity loss (SCAL).
- MonoScene's frustum proportion loss: class proportions in each part of the image, including
  occluded cells.
- The loss of MonoScene's context prior: four kinds of relations between coarse cells and
  mega-voxels.
- The loss of a depth branch: cross entropy of the depth bin of each pixel.

Cells with the label 255 are ignored. If there is nothing to evaluate, a loss and its gradients are
0.
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

FRUSTA = 8  # Along each side of the image.
MIN_SHARE = 1e-6
COARSE_FACTOR = 4  # From the grid to its coarsest level.
EMPTY_SHARE = 0.95  # As in SSCNet, the share of empty or unknown cells above which a cell is empty.
EMPTY_WEIGHT = 0.05  # MonoScene's weight of empty cells in the cross entropy; all others have 1.


def depth_loss(logits: Tensor, depth_m: Tensor) -> Tensor:
    """Return the mean cross entropy over all pixels with a depth in the range of the bins.

    Args:
        logits: Bin logits, float [B, bins, ceil(H / s), ceil(W / s)], where s is a power of two.
        depth_m: Depth in metres, float32 [B, H, W]; 0 for none. The target of a pixel in ``logits``
            is the minimum depth of the pixels that it covers, because nearer surfaces hide those
            behind.
    """
    scale = 2 ** round(math.log2(depth_m.shape[-1] / logits.shape[-1]))
    near = min_pool_depth(depth_m, scale)
    bins = int(logits.shape[1])
    wanted, known = bin_of(near, bins)
    each = torch.nn.functional.cross_entropy(logits.float(), wanted, reduction="none")
    return (each * known).sum() / known.sum().clamp(min=1)


def frustum_loss(logits: Tensor, labels: Tensor, inputs: OccInput) -> Tensor:
    """Return the mean KL divergence of class proportions in 8x8 parts of the images.

    Proportions are computed over all cells of the batch that are projected to the same part. Only
    classes that occur in a part are counted.

    Args:
        logits: Class logits, float [B, 12, X, Y, Z].
        labels: Class of each cell, int64 [B, X, Y, Z].
        inputs: Inputs of the network, which define the projection of the cells.
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
    """Return the part of the image that each cell is projected to, int64 [B, N], -1 for none."""
    sight = project_cells(inputs)
    height, width = sight.size_px
    column = (sight.pixels[..., 0] * FRUSTA / width).floor().clamp(0, FRUSTA - 1).long()
    row = (sight.pixels[..., 1] * FRUSTA / height).floor().clamp(0, FRUSTA - 1).long()
    return torch.where(sight.inside, row * FRUSTA + column, -1)


def _sums(part: Tensor, values: Tensor) -> Tensor:
    empty = values.new_zeros(FRUSTA * FRUSTA, values.shape[1])
    return empty.index_add(0, part, values)


def relation_loss(logits: Tensor, labels: Tensor) -> Tensor:
    """Return the binary cross entropy of all relations, each weighted by its rarity.

    A pair is counted if the cell and at least one cell of the mega-voxel are known; the published
    code treats pairs with unknown cells as unrelated.

    Args:
        logits: Relation logits, float [B, 4, megas, cells], at a quarter of the resolution.
        labels: Class of each cell, int64 [B, X, Y, Z], at full resolution.
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
    """Return which relations are true, and which pairs are known.

    The relations are: both occupied with the same class, both occupied with different classes, both
    empty, and one empty. A cell has a relation to a mega-voxel if it has this relation to any known
    cell of the mega-voxel.

    Args:
        labels: Class of each cell at the coarsest level, int64 [B, X, Y, Z].

    Returns:
        The relations, bool [B, 4, M, N], and the known pairs, bool [B, 1, M, N].
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


def coarse_labels(labels: Tensor) -> Tensor:
    """Downsample labels by ``COARSE_FACTOR`` with SSCNet's rule to int64, with sides rounded up.

    If more than 95 % of a block's cells are empty or unknown, the block gets the more frequent of
    these two labels, otherwise its most frequent occupied class. Cells outside the grid are
    unknown.
    """
    beyond = [(-int(side)) % COARSE_FACTOR for side in labels.shape[1:]]
    padded = torch.nn.functional.pad(
        labels, (0, beyond[2], 0, beyond[1], 0, beyond[0]), value=UNKNOWN
    )
    kinds = torch.where(padded == UNKNOWN, CLASS_COUNT, padded)
    counts = torch.stack(
        [_block_sums((kinds == kind).float()) for kind in range(CLASS_COUNT + 1)], dim=1
    )
    empty, unknown = counts[:, 0], counts[:, CLASS_COUNT]
    best = counts[:, 1:CLASS_COUNT].argmax(dim=1) + 1
    hollow = torch.where(empty > unknown, 0, UNKNOWN)
    return torch.where(empty + unknown > EMPTY_SHARE * COARSE_FACTOR**3, hollow, best)


def _block_sums(values: Tensor) -> Tensor:
    means = torch.nn.functional.avg_pool3d(values[:, None], COARSE_FACTOR)[:, 0]
    return torch.round(means * COARSE_FACTOR**3)


def _mega_voxel_cells(labels: Tensor) -> Tensor:
    """Return the eight cells of each complete mega-voxel, [B, M, 8]."""
    x, y, z = (int(side) // 2 * 2 for side in labels.shape[1:])
    blocks = labels[:, :x, :y, :z].reshape(-1, x // 2, 2, y // 2, 2, z // 2, 2)
    return blocks.permute(0, 1, 3, 5, 2, 4, 6).reshape(len(labels), -1, 8)


def cross_entropy(logits: Tensor, labels: Tensor, class_weights: Tensor | None = None) -> Tensor:
    """Return the weighted mean cross entropy over known cells.

    Args:
        logits: Class logits, float [B, 12, X, Y, Z].
        labels: Class of each cell (0 to 11 or 255), int64 [B, X, Y, Z].
        class_weights: Weight of each class, float32 [12]. Defaults to 1 for all.
    """
    known = labels != UNKNOWN
    targets = torch.where(known, labels, torch.zeros_like(labels))
    each = torch.nn.functional.cross_entropy(logits.float(), targets, reduction="none")
    weights = known.float()
    if class_weights is not None:
        weights = weights * class_weights.to(logits.device, torch.float32)[targets]
    return (each * weights).sum() / weights.sum().clamp(min=1e-6)


def semantic_affinity(logits: Tensor, labels: Tensor) -> Tensor:
    """Return MonoScene's semantic affinity loss.

    It consists of the soft precision, recall and specificity of each class, averaged over the
    classes that occur in the batch, including the empty class.
    """
    known = labels != UNKNOWN
    shares = torch.softmax(logits.float(), dim=1).movedim(1, 0)[:, known]  # [12, N]
    truth = (labels[known] == torch.arange(CLASS_COUNT, device=labels.device)[:, None]).float()
    present = (truth.sum(dim=1) > 0).float()
    return (_affinity(shares, truth) * present).sum() / present.sum().clamp(min=1)


def geometric_affinity(logits: Tensor, labels: Tensor) -> Tensor:
    """Return MonoScene's geometric affinity loss, computed for occupied against empty cells."""
    known = labels != UNKNOWN
    full = 1 - torch.softmax(logits.float(), dim=1)[:, 0]
    return _affinity(full[known][None], (labels[known] != 0).float()[None])[0]


def _affinity(shares: Tensor, truth: Tensor) -> Tensor:
    """Return the summed negative logs of precision, recall and specificity, [K].

    Terms without any cells are 0.
    """
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
    """The weights of the losses; 0 disables a loss. All but ``auxiliary`` are 1 as published.

    Attributes:
        cross_entropy: Weight of the cross entropy.
        semantic: Weight of the semantic affinity loss.
        geometric: Weight of the geometric affinity loss.
        frusta: Weight of the frustum proportion loss.
        relations: Weight of the relation loss.
        depth: Weight of the depth loss.
        auxiliary: Weight of the losses for outputs of earlier layers, as in Symphonies.
        classes: Weights of the 12 classes in the cross entropy. None uses the published weights:
            0.05 for empty cells and 1 for all other classes.
    """

    cross_entropy: float = 1.0
    semantic: float = 1.0
    geometric: float = 1.0
    frusta: float = 1.0
    relations: float = 1.0
    depth: float = 1.0
    auxiliary: float = 0.5
    classes: tuple[float, ...] | None = None

    def __post_init__(self):
        if self.classes is not None and len(self.classes) != CLASS_COUNT:
            raise UsageError(f"there must be {CLASS_COUNT} class weights, got {len(self.classes)}")
        if self.classes is not None and not all(0 <= weight < torch.inf for weight in self.classes):
            raise UsageError("class weights must be finite and 0 or more")

    def class_weights(self) -> Tensor:
        """Return the class weights of the cross entropy, float32 [12]."""
        published = (EMPTY_WEIGHT, *([1.0] * (CLASS_COUNT - 1)))
        return torch.tensor(self.classes or published)


def occupancy_losses(
    output: OccOutput,
    target: OccTarget,
    inputs: OccInput,
    weights: LossWeights | None = None,
) -> dict[str, Tensor]:
    """Compute the weighted losses by name. Their sum is the loss of a training step.

    Losses that cannot be computed are omitted: the relation and depth losses if the network does
    not predict relations or depth, and the depth loss if there is no target depth.

    Args:
        output: Output of the network.
        target: Ground truth. Cells with the label 255 are ignored.
        inputs: Inputs of the network. They define the frusta, and their depth is the target of a
            depth branch if ``target`` has none.
        weights: Weights of the losses.
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
