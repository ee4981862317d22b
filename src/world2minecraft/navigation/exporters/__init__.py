"""A set of items handed to trainers and simulators, as they read files.

``exporting`` does it; ``llamafactory``, ``easyr1``, ``trl``, ``vlnce`` and ``r2r`` are the formats;
``parts`` says which rows go together, ``pictures`` checks and copies images, ``tokens`` and
``steps`` tell what a recipe will do before it runs, ``contracts`` holds the loaders' rules.
"""

from world2minecraft.navigation.exporters.options import ExportOptions
from world2minecraft.navigation.exporters.set_export import FORMATS, ExportResult, export_set

__all__ = ["FORMATS", "ExportOptions", "ExportResult", "export_set"]
