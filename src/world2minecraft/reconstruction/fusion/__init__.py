"""Stage 3: fuse the evidence of all views into one map of the room.

``fuse_views`` accumulates evidence and decides which cells are solid, ``extract_grid`` determines
the state of each cell, and ``clean`` removes floaters and closes holes. This replaces the paper's
F_embodied, a memory of Gaussians. ``calibrate`` computes the confidence of each labelled cell.
"""

from world2minecraft.reconstruction.fusion.accumulator import (
    EvidenceMap,
    FusionParameters,
    fuse_views,
)
from world2minecraft.reconstruction.fusion.confidence_calibration import (
    ConfidenceTable,
    calibrate,
    confidence_table,
)
from world2minecraft.reconstruction.fusion.extract_grid import extract_grid
from world2minecraft.reconstruction.fusion.grid_cleaning import (
    CleaningParameters,
    close_structure,
    remove_floaters,
)

__all__ = [
    "CleaningParameters",
    "ConfidenceTable",
    "EvidenceMap",
    "FusionParameters",
    "calibrate",
    "close_structure",
    "confidence_table",
    "extract_grid",
    "fuse_views",
    "remove_floaters",
]
