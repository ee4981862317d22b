"""Structure from motion: camera poses of photos, estimated or verified from their pixels."""

from world2minecraft.capture.sfm.incremental_mapping import find_poses
from world2minecraft.capture.sfm.parameters import SfmParameters
from world2minecraft.capture.sfm.pose_verification import check_poses
from world2minecraft.capture.sfm.similarity_transform import (
    Similarity,
    align_similarity,
    align_views,
)

__all__ = [
    "SfmParameters",
    "Similarity",
    "align_similarity",
    "align_views",
    "check_poses",
    "find_poses",
]
