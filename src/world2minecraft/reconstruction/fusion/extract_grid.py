"""Extract a grid from fused evidence: the state, the confidence and the colour of each cell."""

import numpy as np

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.types import OBSERVED, UNSEEN, FusedEvidence, OccupancyGrid


def extract_grid(evidence: FusedEvidence) -> OccupancyGrid:
    """Extract the grid of fused evidence, before cleaning and labelling.

    A cell is occupied if its log-odds are positive, free if negative, and unknown if 0. An occupied
    cell gets the class with the most votes, or ``objs`` without votes; a labeller improves this
    later. The confidence is the probability of the decision.
    """
    log_odds = evidence.log_odds.astype(np.float32)
    occupied, free = log_odds > 0, log_odds < 0
    labels = np.full(log_odds.shape, UNKNOWN, np.uint8)
    labels[free] = SemanticClass.EMPTY
    voted = evidence.votes[..., 1:].argmax(axis=3).astype(np.uint8) + 1
    any_vote = evidence.votes[..., 1:].max(axis=3) > 0
    labels[occupied] = np.where(any_vote, voted, np.uint8(SemanticClass.OBJS))[occupied]
    confidence = np.where(log_odds == 0, 0, 1 / (1 + np.exp(-np.abs(log_odds))))
    return OccupancyGrid(
        labels=labels,
        confidence=confidence.astype(np.float16),
        colour=mean_colour(evidence),
        source=np.where(log_odds == 0, UNSEEN, OBSERVED).astype(np.uint8),
        instance=np.zeros(log_odds.shape, np.uint16),
        voxel_m=evidence.voxel_m,
        origin_m=evidence.origin_m,
    )


def mean_colour(evidence: FusedEvidence) -> np.ndarray:
    """Return the mean colour of each cell's points, uint8 [X, Y, Z, 3]; black without points."""
    hits = np.maximum(evidence.hits, 1)[..., None].astype(np.float32)
    return np.clip(np.round(evidence.colour_sum / hits), 0, 255).astype(np.uint8)
