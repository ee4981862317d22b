"""Where photos were taken: found from nothing, or measured and put right where poses are stated."""

from world2minecraft.posing.check import check_poses
from world2minecraft.posing.find import find_poses
from world2minecraft.posing.parameters import PosingParameters
from world2minecraft.posing.similarity import Similarity, align_similarity

__all__ = ["PosingParameters", "Similarity", "align_similarity", "check_poses", "find_poses"]
