"""The files of rooms that were not scanned, such as those of a floor plan."""

from pathlib import Path

from world2minecraft.core.types import Layout, ObjectInstance, OccupancyGrid, Placement, Scan
from world2minecraft.formats.layout import write_layouts
from world2minecraft.formats.objects_and_placements import write_objects, write_placements
from world2minecraft.formats.paper_json import write_centers_json, write_occ_json
from world2minecraft.formats.run_arrays import write_room
from world2minecraft.formats.scan_record import write_scan


def write_room_files(
    out: Path,
    scan: Scan,
    grid: OccupancyGrid,
    layouts: tuple[Layout, ...],
    instances: tuple[ObjectInstance, ...],
    placements: tuple[Placement, ...],
) -> None:
    """Write the files of a run from which its world is built."""
    write_scan(out / "scan.json", scan)
    write_room(out / "room.npz", grid, scan.scan_to_room)
    write_layouts(out / "layout.json", layouts)
    write_objects(out / "objects.json", instances)
    write_placements(out / "placements.json", placements)
    write_occ_json(out / "occ.json", grid)
    write_centers_json(out / "centers.json", instances)
