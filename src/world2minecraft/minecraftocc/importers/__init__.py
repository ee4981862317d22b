"""Import the occupancy data sets of others, and our exports of the same formats, as samples."""

from world2minecraft.minecraftocc.importers.format_detection import IMPORTED, open_occupancy
from world2minecraft.minecraftocc.importers.imported_samples import ImportedSet

__all__ = ["IMPORTED", "ImportedSet", "open_occupancy"]
