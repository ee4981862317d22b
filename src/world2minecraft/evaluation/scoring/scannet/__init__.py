"""Ground truth from the labelled mesh of a ScanNet scene.

``write_scannet_truth`` writes ``truth.npz`` and ``truth.json``. Because a mesh contains only
surfaces, this ground truth is partial: cells that no camera saw through have the label 255 and are
not scored (docs/how-to/evaluate-scannet.md).
"""

from world2minecraft.evaluation.scoring.scannet.scannet_truth import (
    TruthMade,
    scenes_in,
    write_scannet_truth,
)

__all__ = ["TruthMade", "scenes_in", "write_scannet_truth"]
