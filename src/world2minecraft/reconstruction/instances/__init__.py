"""Stage 5, OccupancyGrid -> objects: density map, threshold, clusters per class, centres, cells.

This is the paper's Algorithm 1 from ``density`` (D) to the centres (C'), and then the cells of
each object (O_k).
"""

from world2minecraft.reconstruction.instances.objects import (
    CenterMap,
    FoundObjects,
    find_objects,
    measure_object,
)
from world2minecraft.reconstruction.instances.parameters import InstanceParameters

__all__ = ["CenterMap", "FoundObjects", "InstanceParameters", "find_objects", "measure_object"]
