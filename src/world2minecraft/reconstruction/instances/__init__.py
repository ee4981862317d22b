"""Stage 5: find objects in the labelled grid by density, threshold and clustering per class.

This is the paper's Algorithm 1 from the density D to the centres C', followed by the cells of each
object O_k.
"""

from world2minecraft.reconstruction.instances.objects import (
    CenterMap,
    FoundObjects,
    find_objects,
    measure_object,
)
from world2minecraft.reconstruction.instances.parameters import InstanceParameters

__all__ = ["CenterMap", "FoundObjects", "InstanceParameters", "find_objects", "measure_object"]
