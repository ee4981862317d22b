"""The fidelity report of one scene: ``report.html`` (self-contained), ``report.json``, a picture.

It tells a person at a glance whether the room came out right, and a program in figures. A run
without photos has a brief one.
"""

from world2minecraft.evaluation.report.brief import write_brief_report
from world2minecraft.evaluation.report.write import write_report

__all__ = ["write_brief_report", "write_report"]
