"""Stage 3: the evidence of all views becomes one map of the room.

``fuse_views`` accumulates and settles what is solid, ``extract_grid`` says what each cell is, and
``clean`` takes floaters away and closes holes. This stands in place of the paper's F_embodied (a
memory of Gaussians). ``calibrate`` says of each labelled cell how surely it is right.
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
