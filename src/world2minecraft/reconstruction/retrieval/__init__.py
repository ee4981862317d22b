"""Stage 6, objects -> placements: the best template, turn, size and shift by IoU.

It is the paper's argmax of |O_k intersected with Rot(T_j, delta)| over their union.
"""

from world2minecraft.reconstruction.retrieval.furniture_placement import place_templates
from world2minecraft.reconstruction.retrieval.manual_placement import fit_template, ranked_matches
from world2minecraft.reconstruction.retrieval.parameters import RetrievalParameters

__all__ = ["RetrievalParameters", "fit_template", "place_templates", "ranked_matches"]
