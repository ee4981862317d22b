"""Exports of a set for trainers and simulators, in the formats that they read.

``set_export`` does it; ``llamafactory``, ``easyr1``, ``trl``, ``vlnce`` and ``r2r`` are the
formats; ``options`` groups the rows, ``pictures`` checks and copies images, ``training_costs`` says
what a recipe will take before it runs, ``loader_checks`` holds the loaders' rules.
"""

from world2minecraft.navigation.exporters.options import ExportOptions
from world2minecraft.navigation.exporters.set_export import FORMATS, ExportResult, export_set

__all__ = ["FORMATS", "ExportOptions", "ExportResult", "export_set"]
