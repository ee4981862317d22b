"""Immutable value types that pass between the stages, checked in their constructors.

Arrays are stored as read-only views. To change a value, a stage creates a new one with
``dataclasses.replace``. ``coordinates`` defines the frames, axes and angles.
"""

from world2minecraft.core.types.block_volume import AIR, BlockEntity, BlockVolume, Entity
from world2minecraft.core.types.capture import (
    Camera,
    Corrections,
    FrameSigmas,
    Scan,
    View,
    ViewStream,
)
from world2minecraft.core.types.edit import BlockEdit, Blocks, GridCells, Operation, SceneObject
from world2minecraft.core.types.layout import Hinge, Layout, LayoutObject, Opening
from world2minecraft.core.types.objects import OWN_CELLS, Alternative, ObjectInstance, Placement
from world2minecraft.core.types.occupancy_and_evidence import (
    COMPLETED,
    OBSERVED,
    UNSEEN,
    FusedEvidence,
    GridEvidence,
    OccupancyGrid,
    PointEvidence,
)
from world2minecraft.core.types.photos import DepthMap, Photo, PhotoStream, SparseScene

__all__ = [
    "AIR",
    "COMPLETED",
    "OBSERVED",
    "OWN_CELLS",
    "UNSEEN",
    "Alternative",
    "BlockEdit",
    "BlockEntity",
    "BlockVolume",
    "Blocks",
    "Camera",
    "Corrections",
    "DepthMap",
    "Entity",
    "FrameSigmas",
    "FusedEvidence",
    "GridCells",
    "GridEvidence",
    "Hinge",
    "Layout",
    "LayoutObject",
    "ObjectInstance",
    "OccupancyGrid",
    "Opening",
    "Operation",
    "Photo",
    "PhotoStream",
    "Placement",
    "PointEvidence",
    "Scan",
    "SceneObject",
    "SparseScene",
    "View",
    "ViewStream",
]
