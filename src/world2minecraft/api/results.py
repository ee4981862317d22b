"""Runs, rooms and objects as Python values, read from the folders that the program writes."""

import base64
import html
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from world2minecraft.core.classes import CLASS_COLOURS, CLASS_NAMES, UNKNOWN
from world2minecraft.core.errors import InputError
from world2minecraft.core.files import image_bytes, read_json
from world2minecraft.core.types import BlockVolume, ObjectInstance, OccupancyGrid
from world2minecraft.core.vocabulary import object_title

if TYPE_CHECKING:
    from PIL.Image import Image

    from world2minecraft.api.datasets import Dataset
    from world2minecraft.procgen import Room as GeneratedRoom

MAX_LISTED = 12  # Objects in the text and in the notebook view of a run.


@dataclass(frozen=True, eq=False)
class RoomObject:
    """An object of a room.

    Attributes:
        id: Object id, 1 or more. The cells of the object are those with ``room.instances == id``.
        name: Readable name, such as ``television``.
        class_name: One of the paper's twelve classes, such as ``tvs``.
        center_m: Centre of the bounding box in the room frame (z up) in metres, float64 [3].
        size_m: Size of the bounding box along its own axes in metres, float64 [3]: front to back,
            side to side, height.
        yaw_deg: Rotation in degrees, counter-clockwise from above. At 0 the front faces +x.
        confidence: Mean confidence of the cells, 0 to 1.
        template: Furniture template that replaces the object in the world. Empty if the object is
            built from its cells.
    """

    id: int
    name: str
    class_name: str
    center_m: np.ndarray
    size_m: np.ndarray
    yaw_deg: float
    confidence: float
    template: str = ""

    def __repr__(self) -> str:
        x, y, z = self.center_m
        size = " x ".join(f"{side:.2f}" for side in self.size_m)
        return (
            f"RoomObject({self.id}, {self.name!r}, at ({x:.2f}, {y:.2f}, {z:.2f}) m, "
            f"{size} m, confidence {self.confidence:.2f})"
        )


@dataclass(frozen=True, eq=False)
class Room:
    """The semantic occupancy of a room: a class for each cell of a grid in the room frame.

    Attributes:
        grid: Cells with their class, confidence, colour and source.
        names: Object names by object id.
        scan_to_room: Transform from the capture frame to the room frame, float64 [4, 4].

    Example:
        >>> from world2minecraft.api.results import Room
        >>> from world2minecraft.core.types import OccupancyGrid
        >>> import numpy as np
        >>> shape = (25, 20, 30)
        >>> grid = OccupancyGrid(
        ...     labels=np.full(shape, 3, np.uint8), confidence=np.ones(shape, np.float16),
        ...     colour=np.zeros((*shape, 3), np.uint8), source=np.ones(shape, np.uint8),
        ...     instance=np.zeros(shape, np.uint16), voxel_m=0.08, origin_m=np.zeros(3),
        ... )
        >>> Room(grid)
        Room(25 x 20 x 30 cells of 0.08 m, 2.0 x 1.6 x 2.4 m, 0 objects)
    """

    grid: OccupancyGrid
    names: Mapping[int, str] = field(default_factory=dict)
    scan_to_room: np.ndarray = field(default_factory=lambda: np.eye(4))

    @property
    def labels(self) -> np.ndarray:
        """The class of each cell as uint8 [X, Y, Z]: 0 for empty, 1 to 11, 255 for unknown."""
        return self.grid.labels

    @property
    def instances(self) -> np.ndarray:
        """The object id of each cell as uint16 [X, Y, Z], or 0 for cells without an object."""
        return self.grid.instance

    @property
    def voxel_m(self) -> float:
        """The cell size in metres."""
        return self.grid.voxel_m

    @property
    def origin_m(self) -> np.ndarray:
        """The minimum corner of cell (0, 0, 0) in the room frame in metres, float64 [3]."""
        return self.grid.origin_m

    @property
    def size_m(self) -> np.ndarray:
        """The size of the grid in metres, float64 [3]."""
        return np.array(self.grid.shape) * self.grid.voxel_m

    def plan(self, px_per_cell: int = 4) -> "Image":
        """Draw the room from above without its ceiling, with each cell in the colour of its class.

        Args:
            px_per_cell: Side length of a cell in pixels.
        """
        from PIL import Image

        colours = np.full((256, 3), 235, np.uint8)
        colours[: len(CLASS_COLOURS)] = CLASS_COLOURS
        seen = (self.labels > 1) & (self.labels != UNKNOWN)
        top = self.labels.shape[2] - 1 - np.argmax(seen[:, :, ::-1], axis=2)
        classes = np.take_along_axis(self.labels, top[:, :, None], axis=2)[:, :, 0]
        flat = np.where(seen.any(axis=2), classes, UNKNOWN)
        pixels = colours[flat].transpose(1, 0, 2)[::-1]  # x to the right, y up.
        return Image.fromarray(pixels.repeat(px_per_cell, axis=0).repeat(px_per_cell, axis=1))

    def __repr__(self) -> str:
        cells = " x ".join(str(side) for side in self.grid.shape)
        return (
            f"Room({cells} cells of {self.voxel_m:g} m, {_metres(self.size_m)}, "
            f"{len(self.names)} objects)"
        )

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(repr(self))}</p>{_img(self.plan())}"


@dataclass(frozen=True, eq=False)
class Run:
    """A folder with a reconstructed or built room. Its files are read on first use.

    Attributes:
        folder: Folder of the run. Its files are described in docs/reference/file-formats.md.
    """

    folder: Path

    @cached_property
    def room(self) -> Room:
        """The semantic occupancy of the room.

        Raises:
            InputError: If the folder does not contain ``room.npz``.
            DamagedFileError: If ``room.npz`` does not contain a valid grid.
        """
        grid, scan_to_room, instances, _ = self._files
        names = {one.id: object_title(one.name, one.class_id) for one in instances}
        return Room(grid, names, scan_to_room)

    @cached_property
    def objects(self) -> tuple[RoomObject, ...]:
        """The objects of the room, ordered by id.

        Raises:
            InputError: If a file of the run is missing.
            DamagedFileError: If a file of the run cannot be read.
        """
        _, _, instances, templates = self._files
        return tuple(
            RoomObject(
                id=one.id,
                name=self.room.names[one.id],
                class_name=CLASS_NAMES[one.class_id],
                center_m=one.center_m,
                size_m=one.size_m,
                yaw_deg=one.yaw_deg,
                confidence=one.confidence,
                template=templates.get(one.id, ""),
            )
            for one in instances
        )

    @cached_property
    def report(self) -> dict[str, Any]:
        """The contents of ``report.json``. Empty if the run has no report."""
        path = self.folder / "report.json"
        return read_json(path) if path.is_file() else {}

    @property
    def notes(self) -> list[str]:
        """The remarks of the reconstruction about the capture and the result."""
        return list(self.report.get("scan", self.report).get("notes", ()))

    @property
    def world(self) -> Path:
        """The folder of the Minecraft world."""
        return self.folder / "build" / "world"

    @cached_property
    def blocks(self) -> BlockVolume:
        """The blocks of the world, with the class and the object id of each block.

        Raises:
            InputError: If the run has no build.
        """
        from world2minecraft.core.whole_reads import read_whole
        from world2minecraft.evaluation.report.finished_run import read_built

        return read_whole(self.folder, lambda: read_built(self.folder / "build"))

    @cached_property
    def _files(self) -> "_RunFiles":
        """The files of the scene, all of one state of the folder."""
        from world2minecraft.core.whole_reads import read_whole

        return read_whole(self.folder, self._read_files)

    def _read_files(self) -> "_RunFiles":
        from world2minecraft.formats.objects_and_placements import read_objects, read_placements
        from world2minecraft.formats.run_arrays import read_room

        grid, scan_to_room = read_room(self.folder / "room.npz")
        objects, placed = self.folder / "objects.json", self.folder / "placements.json"
        instances = read_objects(objects, grid) if objects.is_file() else ()
        placements = read_placements(placed) if placed.is_file() else ()
        templates = {one.object_id: one.template for one in placements if one.template != "cells"}
        return _RunFiles(grid, scan_to_room, instances, templates)

    def __repr__(self) -> str:
        return f"Run({str(self.folder)!r})"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{one.id}</td><td>{html.escape(one.name)}</td><td>{_metres(one.size_m)}</td>"
            f"<td>{one.confidence:.2f}</td></tr>"
            for one in self.objects[:MAX_LISTED]
        )
        more = len(self.objects) - MAX_LISTED
        rest = f"<p>and {more} more objects</p>" if more > 0 else ""
        head = "<tr><th>id</th><th>name</th><th>size</th><th>confidence</th></tr>"
        title = f"{self!r}: {_metres(self.room.size_m)}, {len(self.objects)} objects"
        return f"<p>{html.escape(title)}</p>{self._picture()}<table>{head}{rows}</table>{rest}"

    def _picture(self) -> str:
        from PIL import Image

        path = self.folder / "preview.png"
        if not path.is_file():
            return _img(self.room.plan())
        with Image.open(path) as picture:
            return _img(picture.resize((640, 480)))


class _RunFiles(NamedTuple):
    """The contents of the files of a run that belong together."""

    grid: OccupancyGrid
    scan_to_room: np.ndarray
    instances: tuple[ObjectInstance, ...]
    templates: dict[int, str]


def load(path: str | Path) -> "Run | GeneratedRoom | Dataset":
    """Open a folder that was written by this program.

    Args:
        path: Folder of a run, a build, a generated room or an occupancy data set.

    Returns:
        A ``Run``, a generated room or a ``Dataset``, depending on the contents of the folder.

    Raises:
        InputError: If the folder does not exist or was not written by this program.

    Example:
        >>> import world2minecraft as w2m
        >>> room = w2m.generate_room("study", seed=3, out=tmp / "room")
        >>> w2m.load(tmp / "room").kind
        'study'
    """
    folder = Path(path)
    if (folder / "room.npz").is_file():
        return Run(folder)
    if (folder / "truth.npz").is_file() and (folder / "layout.json").is_file():
        from world2minecraft.procgen import read_generated

        return read_generated(folder)
    if (folder / "shards").is_dir():
        from world2minecraft.api.datasets import open_dataset

        return open_dataset(folder)
    if not folder.exists():
        raise InputError(folder, "not found; give the folder of a run, a room or a data set")
    raise InputError(
        folder,
        "is not a run, a generated room or a data set; for captures use w2m.reconstruct, for "
        "worlds and schematics w2m.render or w2m.convert",
    )


def _metres(sides: np.ndarray) -> str:
    return " x ".join(f"{side:.1f}" for side in sides) + " m"


def _img(picture: "Image") -> str:
    text = base64.b64encode(image_bytes(picture, "PNG")).decode()
    return f'<img src="data:image/png;base64,{text}" style="max-width: 100%"/>'
