"""Exporters that write data sets in the published formats that existing data loaders read.

Samples with their splits are written to a folder one at a time. Each file is written atomically,
and the last file of a sample marks it as finished, so an interrupted export can be resumed.
``docs/reference/occupancy-formats.md`` describes all files and keys.
"""

from world2minecraft.minecraftocc.exporters.export import EXPORT, ExportReport, export_samples
from world2minecraft.minecraftocc.exporters.options import FORMATS, ExportRule

__all__ = ["EXPORT", "FORMATS", "ExportReport", "ExportRule", "export_samples"]
