"""The choice of the labeller for ``auto``, by the kind of evidence."""

from world2minecraft.core.types import FusedEvidence
from world2minecraft.reconstruction.semantics.completion_labeller import (
    LEARNT_VOXEL_M,
    VOXEL_TOLERANCE,
)


def choose_labeller(evidence: FusedEvidence, from_photos: bool) -> str:
    """Return the name of the labeller that ``auto`` selects.

    The completion network is used for measured depth and the cell size it was trained with. It was
    not trained on stereo errors: in photos of a real kitchen it took the end of a table for a bed.
    """
    if not from_photos and abs(evidence.voxel_m / LEARNT_VOXEL_M - 1) <= VOXEL_TOLERANCE:
        return "completion"
    return "votes" if evidence.votes.any() else "geometric"
