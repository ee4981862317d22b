"""Exports of a set in the formats of trainers and simulators.

``set_export`` is the entry point. ``llamafactory``, ``easyr1``, ``trl``, ``vlnce`` and ``r2r``
implement the formats. ``options`` groups the rows, ``pictures`` checks and copies images,
``training_costs`` estimates the cost of a recipe, and ``loader_checks`` applies the loaders' rules.
"""

from world2minecraft.navigation.exporters.options import ExportOptions
from world2minecraft.navigation.exporters.set_export import FORMATS, ExportResult, export_set

__all__ = ["FORMATS", "ExportOptions", "ExportResult", "export_set"]
