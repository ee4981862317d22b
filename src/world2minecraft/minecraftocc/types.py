"""The types of a data set: the cells of a scene, the labels of an image, and samples."""

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
    """What a cell is made of: a block's id, and the furniture design that it is a part of.

    Example:
        >>> FineClass("minecraft:oak_stairs", "chair_cafe").name
        'design:chair_cafe'
    """

    block: str  # "minecraft:oak_planks", without properties
    design: str = ""

    @property
    def name(self) -> str:
        """What counts as one class: the design where there is one, whatever it is made of."""
        return f"design:{self.design}" if self.design else self.block


@dataclass(frozen=True, eq=False)
class SceneVoxels:
    """The cells of a whole world, in its room frame: ``labels[x, y, z]``, z up.

    ``fine`` indexes ``fine_classes``, whose first stands for empty cells. ``instance`` is 0 or
    the object's number in ``scene.npz``.
    """

    labels: np.ndarray  # uint8 [X, Y, Z], 0 to 11 or 255
    fine: np.ndarray  # uint16 [X, Y, Z]
    instance: np.ndarray  # uint16 [X, Y, Z]
    fine_classes: tuple[FineClass, ...]
    voxel_m: float
    origin_m: np.ndarray  # float64 [3], minimum corner of cell (0, 0, 0)

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
            raise ValueError(f"fine goes to {self.fine.max()} of {len(self.fine_classes)} classes")


@dataclass(frozen=True, eq=False)
class OccLabels:
    """The labels of one image and their masks, all [X, Y, Z] of its region.

    Occluded is what is in the frustum, occupied and not hit; unknown what is in the frustum and
    neither hit nor free nor occupied.
    """

    region: LabelRegion
    labels: np.ndarray  # uint8, 0 to 11 or 255
    fine: np.ndarray  # uint16, into the scene's fine classes
    instance: np.ndarray  # uint16
    in_frustum: np.ndarray  # bool, the centre falls into the image, in front of the camera
    hits: np.ndarray  # uint32, how many pixels see the cell first
    free: np.ndarray  # bool, a pixel's ray went through it, and it is empty

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
        """Bool [X, Y, Z]: cells that hold something."""
        return (self.labels > 0) & (self.labels != 255)

    @property
    def visible(self) -> np.ndarray:
        """Bool [X, Y, Z]: cells that some pixel sees first."""
        return self.hits > 0


@dataclass(frozen=True, eq=False)
class OccSample:
    """One image with all that is known of it."""

    key: str  # unique in a data set: SCENE-TOUR-FRAME, of letters, digits, - and _
    scene_id: str
    tour_id: str
    frame: int
    camera: Camera
    camera_to_room: np.ndarray  # float64 [4, 4]
    occ: OccLabels
    fine_classes: tuple[FineClass, ...]
    colour: np.ndarray | None = None  # uint8 [H, W, 3]
    depth_m: np.ndarray | None = None  # float32 [H, W], z-depth, 0 where there is none
    split: str = ""  # train, val, test or ""
    facts: dict = field(default_factory=dict)  # block_to_room, the game's pose, light ...

    def __post_init__(self):
        put = object.__setattr__
        put(self, "camera_to_room", checks.transform("camera_to_room", self.camera_to_room))
        size = (self.camera.height_px, self.camera.width_px)
        if self.colour is not None:
            put(self, "colour", checks.array("colour", self.colour, np.uint8, (*size, 3)))
        if self.depth_m is not None:
            put(self, "depth_m", checks.array("depth_m", self.depth_m, np.float32, size))
