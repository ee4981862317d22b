"""Stage 6: find the best template, rotation, size and shift for each object by IoU.

This is the paper's argmax of the intersection of O_k and Rot(T_j, delta) over their union.
"""

from world2minecraft.reconstruction.retrieval.furniture_placement import place_templates
from world2minecraft.reconstruction.retrieval.manual_placement import (
    fit_template,
    ranked_matches,
    score_placements,
)
from world2minecraft.reconstruction.retrieval.parameters import RetrievalParameters

__all__ = [
    "RetrievalParameters",
    "fit_template",
    "place_templates",
    "ranked_matches",
    "score_placements",
]
