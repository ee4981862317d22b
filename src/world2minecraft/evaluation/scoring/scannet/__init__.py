"""A ScanNet scene's labelled mesh as a truth that a reconstruction of the scene is scored by.

``write_scannet_truth`` writes ``truth.npz`` and ``truth.json``. A mesh knows surfaces alone, so the
truth is partial: what no camera saw through is 255 and not scored (docs/scan-benchmark.md).
"""

from world2minecraft.evaluation.scoring.scannet.scannet_truth import (
    TruthMade,
    scenes_in,
    write_scannet_truth,
)

__all__ = ["TruthMade", "scenes_in", "write_scannet_truth"]
