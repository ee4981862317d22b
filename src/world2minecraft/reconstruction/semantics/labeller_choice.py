"""The labeller that ``auto`` stands for, by what the evidence is made of."""

from world2minecraft.core.types import FusedEvidence
from world2minecraft.reconstruction.semantics.completion_labeller import (
    LEARNT_VOXEL_M,
    VOXEL_TOLERANCE,
)


def choose_labeller(evidence: FusedEvidence, from_photos: bool) -> str:
    """Return the name of the labeller that ``auto`` takes.

    It is the network where depth was measured and cells are of the size that it learnt. The errors
    of stereo it has not seen: in a real kitchen's photos it took a table's end for a bed.
    """
    if not from_photos and abs(evidence.voxel_m / LEARNT_VOXEL_M - 1) <= VOXEL_TOLERANCE:
        return "completion"
    return "votes" if evidence.votes.any() else "geometric"
