"""The fidelity report of a scene: a self-contained ``report.html``, ``report.json`` and an image.

The page shows whether a reconstruction is correct, and the JSON file contains the scores. Runs
without photos have a brief report.
"""

from world2minecraft.evaluation.report.writer import write_brief_report, write_report

__all__ = ["write_brief_report", "write_report"]
