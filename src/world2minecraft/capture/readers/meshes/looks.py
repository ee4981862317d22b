"""Frames of a solid: rendered when they are first asked for, and kept for the next stage."""

import threading
from collections import OrderedDict
from dataclasses import dataclass, field

import numpy as np

from world2minecraft.capture.images import ImageHeader
from world2minecraft.capture.readers.meshes.cloud_splatting import Surfels, see_points
from world2minecraft.capture.readers.meshes.mesh_rasterizer import GREY, see_triangles
from world2minecraft.capture.readers.meshes.spatial_blocks import Blocks
from world2minecraft.capture.readers.meshes.surface_model import Mesh
from world2minecraft.core.classes import CLASS_COLOURS
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.types import Camera

KEPT_BYTES = 192 << 20  # All 120 views of 480 x 360: 1.4 MB each.
MODES = {"colour": "RGB", "depth": "float32", "labels": "L"}
Seen = tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass(eq=False)
class Looker:
    """Renders views of one solid and keeps the last ones; ``name`` is that of its file."""

    name: str
    solid: Mesh | Surfels
    camera: Camera
    camera_to_world: np.ndarray
    blocks: Blocks
    by_class: bool = False  # Colours of the classes, for what has classes but no colours.
    _kept: "OrderedDict[int, Seen]" = field(default_factory=OrderedDict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def seen(self, view: int) -> Seen:
        """Return depth, colour and labels of a view, all [H, W]."""
        with self._lock:
            if view in self._kept:
                self._kept.move_to_end(view)
                return self._kept[view]
            found = self._rendered(view)
            if self.by_class:
                colours = np.full((256, 3), GREY, np.uint8)
                colours[: len(CLASS_COLOURS)] = CLASS_COLOURS
                found = found[0], colours[found[2]], found[2]
            self._kept[view] = found
            most = max(2, KEPT_BYTES // sum(image.nbytes for image in found))
            while len(self._kept) > most:
                self._kept.popitem(last=False)
            return found

    def _rendered(self, view: int) -> Seen:
        world_to_camera = invert_rigid(self.camera_to_world[view])
        runs = self.blocks.runs(self.camera, world_to_camera)
        if isinstance(self.solid, Mesh):
            return see_triangles(self.solid, self.camera, world_to_camera, runs)
        return see_points(self.solid, self.camera, world_to_camera, runs)


@dataclass(frozen=True, eq=False)
class Look:
    """One image of one view: ``kind`` is colour, depth or labels. An ``ImageSource``."""

    looker: Looker
    view: int
    kind: str

    def __str__(self) -> str:
        """The file's name and the view, for messages."""
        return f"{self.looker.name}/view {self.view} ({self.kind})"

    @property
    def stem(self) -> str:
        """The frame's name."""
        return view_name(self.view)

    @property
    def name(self) -> str:
        """The frame's name."""
        return view_name(self.view)

    def header(self) -> ImageHeader:
        """Return size and mode; nothing is rendered."""
        camera = self.looker.camera
        return ImageHeader(camera.width_px, camera.height_px, MODES[self.kind])

    def check_whole(self) -> None:
        """Do nothing: the file was read whole before."""

    def colour(self) -> np.ndarray:
        """Return uint8 [H, W, 3]."""
        return self.looker.seen(self.view)[1]

    def raw(self) -> np.ndarray:
        """Return float32 metres, or uint8 class ids."""
        depth, _, labels = self.looker.seen(self.view)
        return depth if self.kind == "depth" else labels


def view_name(view: int) -> str:
    """Return the name of a frame.

    Example:
        >>> view_name(7)
        'view-007'
    """
    return f"view-{view:03d}"
