"""A finished reconstruction against the truth of the room that was scanned virtually.

``evaluate_reconstruction`` scores the files of a run. What is scored, and why those cells, is in
docs/metrics.md.
"""

from world2minecraft.evaluation.scoring.score import evaluate_reconstruction
from world2minecraft.evaluation.scoring.truth_files import Truth, read_truth

__all__ = ["Truth", "evaluate_reconstruction", "read_truth"]
