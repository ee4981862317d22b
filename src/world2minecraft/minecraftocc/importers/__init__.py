"""Importers for published occupancy data sets and for our own exports in the same formats."""

from world2minecraft.minecraftocc.importers.format_detection import IMPORTED, open_occupancy
from world2minecraft.minecraftocc.importers.imported_samples import ImportedSet

__all__ = ["IMPORTED", "ImportedSet", "open_occupancy"]
