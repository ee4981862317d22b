"""The fidelity report of one scene: ``report.html`` (self-contained), ``report.json``, a picture.

It tells a person at a glance whether the room came out right, and a program in figures. A run
without photos has a brief one.
"""

from world2minecraft.evaluation.report.writer import write_brief_report, write_report

__all__ = ["write_brief_report", "write_report"]
