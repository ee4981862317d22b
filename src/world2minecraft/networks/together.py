"""All losses of a network's answer, each already weighted, so that their sum is what to descend."""

from dataclasses import dataclass

import torch
from torch import Tensor

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.core.errors import UsageError
from world2minecraft.networks.batch import OccInput, OccOutput, OccTarget
from world2minecraft.networks.depth import depth_loss
from world2minecraft.networks.frusta import frustum_loss
from world2minecraft.networks.relations import relation_loss
from world2minecraft.networks.semantic import (
    cross_entropy,
    geometric_affinity,
    semantic_affinity,
)

EMPTY_WEIGHT = 0.05  # MonoScene's weight of empty cells in the cross entropy; all others have 1.


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
        output: what the network said.
        target: what is true. Cells of 255 teach nothing.
        inputs: what the network saw: its cameras cut the frusta, its depth teaches a depth branch
            where the target has none.
        weights: how much each counts.

    What has nothing to judge is left out: relations and depth where the network says none of them
    or, for depth, where none is known.
    """
    chosen = weights or LossWeights()
    found = _of_classes(output.logits, target.labels, inputs, chosen)
    if output.relations is not None and chosen.relations:
        found["relations"] = chosen.relations * relation_loss(output.relations, target.labels)
    depth_m = inputs.depth_m if target.depth_m is None else target.depth_m
    if output.depth_logits is not None and depth_m is not None and chosen.depth:
        found["depth"] = chosen.depth * depth_loss(output.depth_logits, depth_m)
    if output.auxiliary and chosen.auxiliary:
        earlier = [
            sum(_of_classes(logits, target.labels, inputs, chosen).values(), logits.new_zeros(()))
            for logits in output.auxiliary
        ]
        found["auxiliary"] = chosen.auxiliary * torch.stack(earlier).sum()
    return found


def _of_classes(
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
