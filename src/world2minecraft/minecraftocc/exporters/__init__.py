"""Export data sets in the formats that the loaders of others read.

In: samples with their split, one at a time. Out: a folder. Each file is written whole or not at
all, and a sample's last file says that it is finished, so that a stopped export goes on where it
stopped. ``docs/occupancy-formats.md`` has every file and key.
"""

from world2minecraft.minecraftocc.exporters.export import ExportReport, export_samples
from world2minecraft.minecraftocc.exporters.options import FORMATS, ExportRule

__all__ = ["FORMATS", "ExportReport", "ExportRule", "export_samples"]
