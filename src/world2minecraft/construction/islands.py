"""Leave out what was seen far beyond the room, such as through a doorway.

A frame that looks through an open door shows pieces of other rooms, metres away and without a floor
between. They are measured surface and stay in the grid, but they would hang beside the room in the
game.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from world2minecraft.core.types import OccupancyGrid, Placement
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.geometry.morphology import dilate

# A living room of NYUv2 has pieces 1.6, 3.9 and 4.9 m away with 0.7 to 5.5 % of its cells. In the
# other real captures, parts within 1.5 m are objects of the room whose floor was not seen.
GAP_M = 1.5
MAX_SHARE = 0.1  # Maximum share of the largest part's cells; larger parts are rooms.


def remove_islands(
    grid: OccupancyGrid, placements: Sequence[Placement]
) -> tuple[OccupancyGrid, list[Placement]]:
    """Return the grid and the placements without small parts far from everything else.

    Parts are far from each other if every gap between them is wider than ``GAP_M``.
    """
    parts, count = label_components(dilate(grid.occupied, int(GAP_M / 2 / grid.voxel_m)))
    if count < 2:
        return grid, list(placements)
    sizes = np.bincount(parts[grid.occupied], minlength=count + 1)
    small = sizes < MAX_SHARE * sizes.max()
    removed = grid.occupied & small[parts]
    left = set(np.unique(grid.instance[grid.occupied & ~removed]).tolist())
    gone = set(np.unique(grid.instance[removed]).tolist()) - left
    labels = np.where(removed, np.uint8(0), grid.labels)
    instance = np.where(removed, 0, grid.instance).astype(grid.instance.dtype)
    kept = [one for one in placements if one.object_id not in gone]
    return replace(grid, labels=labels, instance=instance), kept
