"""Scoring of a finished reconstruction against the ground truth of a virtually scanned room.

``evaluate_reconstruction`` scores the files of a run. docs/reference/metrics.md describes the
scores and the choice of scored cells.
"""

from world2minecraft.evaluation.scoring.score import evaluate_reconstruction
from world2minecraft.evaluation.scoring.truth_files import Truth, read_truth

__all__ = ["Truth", "evaluate_reconstruction", "read_truth"]
