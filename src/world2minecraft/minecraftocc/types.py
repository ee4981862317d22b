"""The data types of a data set: cells of a scene, labels of an image, and samples."""

from dataclasses import dataclass, field

import numpy as np

from world2minecraft.core.types import Camera, checks
from world2minecraft.geometry.view_region import DEFAULT_SHAPE, DEFAULT_VOXEL_M, LabelRegion

__all__ = [
    "DEFAULT_SHAPE",
    "DEFAULT_VOXEL_M",
    "FineClass",
    "LabelRegion",
    "OccLabels",
    "OccSample",
    "SceneVoxels",
]


@dataclass(frozen=True, order=True)
class FineClass:
    """The block and the furniture design that a cell belongs to.

    Attributes:
        block: Block id without properties, such as ``minecraft:oak_planks``.
        design: Name of the furniture design, or an empty string.

    Example:
        >>> FineClass("minecraft:oak_stairs", "chair_cafe").name
        'design:chair_cafe'
    """

    block: str
    design: str = ""

    @property
    def name(self) -> str:
        """Name of the fine class: the design if there is one, otherwise the block id."""
        return f"design:{self.design}" if self.design else self.block


@dataclass(frozen=True, eq=False)
class SceneVoxels:
    """The labelled cells of a complete world, along the axes of its room with z up.

    Attributes:
        labels: Class of each cell (0 to 11 or 255), uint8 [X, Y, Z].
        fine: Index into ``fine_classes`` for each cell, uint16 [X, Y, Z].
        instance: Object number of each cell as in ``scene.npz``, or 0, uint16 [X, Y, Z].
        fine_classes: Fine classes of the world; the first one stands for empty cells.
        voxel_m: Cell size in metres.
        origin_m: Minimum corner of cell (0, 0, 0) in metres, float64 [3].
    """

    labels: np.ndarray
    fine: np.ndarray
    instance: np.ndarray
    fine_classes: tuple[FineClass, ...]
    voxel_m: float
    origin_m: np.ndarray

    def __post_init__(self):
        put = object.__setattr__
        labels = checks.labels("labels", self.labels, (None, None, None))
        put(self, "labels", labels)
        for name in ("fine", "instance"):
            put(self, name, checks.array(name, getattr(self, name), np.uint16, labels.shape))
        put(self, "fine_classes", tuple(self.fine_classes))
        put(self, "voxel_m", checks.positive("voxel_m", self.voxel_m))
        put(self, "origin_m", checks.floats("origin_m", self.origin_m, (3,)))
        if self.fine.size and int(self.fine.max()) >= len(self.fine_classes):
            raise ValueError(
                f"fine must contain indices below {len(self.fine_classes)}, got {self.fine.max()}"
            )


@dataclass(frozen=True, eq=False)
class OccLabels:
    """The labels and masks of an image, each of shape [X, Y, Z] for the cells of its region.

    A cell is occluded if it is in the frustum and occupied but has no hits. It is unobserved if it
    is in the frustum and neither occupied nor free and has no hits.

    Attributes:
        region: Region of the image.
        labels: Class of each cell (0 to 11 or 255), uint8.
        fine: Fine class index of each cell, uint16.
        instance: Object number of each cell, uint16.
        in_frustum: Whether the cell centre is in front of the camera and inside the image, bool.
        hits: Number of pixels that see the cell, uint32.
        free: Whether the cell is empty and crossed by the ray of a pixel, bool.
    """

    region: LabelRegion
    labels: np.ndarray
    fine: np.ndarray
    instance: np.ndarray
    in_frustum: np.ndarray
    hits: np.ndarray
    free: np.ndarray

    def __post_init__(self):
        put = object.__setattr__
        shape = self.region.shape
        put(self, "labels", checks.labels("labels", self.labels, shape))
        kinds = {
            "fine": np.uint16,
            "instance": np.uint16,
            "in_frustum": np.bool_,
            "hits": np.uint32,
            "free": np.bool_,
        }
        for name, dtype in kinds.items():
            put(self, name, checks.array(name, getattr(self, name), dtype, shape))

    @property
    def occupied(self) -> np.ndarray:
        """Whether each cell is occupied, bool [X, Y, Z]."""
        return (self.labels > 0) & (self.labels != 255)

    @property
    def visible(self) -> np.ndarray:
        """Whether each cell is seen by at least one pixel, bool [X, Y, Z]."""
        return self.hits > 0


@dataclass(frozen=True, eq=False)
class OccSample:
    """An image with its camera, labels and further facts.

    Attributes:
        key: Unique key SCENE-TOUR-FRAME of letters, digits, ``-`` and ``_``.
        scene_id: Name of the scene.
        tour_id: Name of the tour.
        frame: Frame number within the tour.
        camera: Camera of the image.
        camera_to_room: Camera pose in the room, float64 [4, 4].
        occ: Labels and masks of the region.
        fine_classes: Fine classes to which ``occ.fine`` refers.
        colour: Colour image, uint8 [H, W, 3], or None.
        depth_m: Depth along the camera's z axis in metres, float32 [H, W], or None; 0 for no
            surface.
        split: ``train``, ``val``, ``test`` or an empty string.
        facts: Further facts, such as ``block_to_room``, the pose in the game and the light.
    """

    key: str
    scene_id: str
    tour_id: str
    frame: int
    camera: Camera
    camera_to_room: np.ndarray
    occ: OccLabels
    fine_classes: tuple[FineClass, ...]
    colour: np.ndarray | None = None
    depth_m: np.ndarray | None = None
    split: str = ""
    facts: dict = field(default_factory=dict)

    def __post_init__(self):
        put = object.__setattr__
        put(self, "camera_to_room", checks.transform("camera_to_room", self.camera_to_room))
        size = (self.camera.height_px, self.camera.width_px)
        if self.colour is not None:
            put(self, "colour", checks.array("colour", self.colour, np.uint8, (*size, 3)))
        if self.depth_m is not None:
            put(self, "depth_m", checks.array("depth_m", self.depth_m, np.float32, size))
