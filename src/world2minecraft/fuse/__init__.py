"""Stage 3: the evidence of all views becomes one map of the room.

``fuse_views`` accumulates, ``read_out`` decides what each cell is, and ``clean`` takes floaters
away and closes holes. This stands in place of the paper's F_embodied (a memory of Gaussians).
"""

from world2minecraft.fuse.accumulator import EvidenceMap, FuseParameters, fuse_views
from world2minecraft.fuse.clean import CleanParameters, close_structure, remove_floaters
from world2minecraft.fuse.read_out import read_out

__all__ = [
    "CleanParameters",
    "EvidenceMap",
    "FuseParameters",
    "close_structure",
    "fuse_views",
    "read_out",
    "remove_floaters",
]
