"""A room as geometry in metres: floor polygon, walls, openings and furniture boxes."""

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from world2minecraft.core.types import checks

Hinge = Literal["left", "right"]


@dataclass(frozen=True, eq=False)
class Opening:
    """A window, door or doorway in a wall, from floor-plan point ``start_m`` to ``end_m``.

    A door has a leaf, a doorway has none. ``hinge`` is the side of the leaf's hinge as seen from
    inside the room, or None if it is unknown, and ``is_open`` whether the leaf stands open.
    """

    kind: Literal["window", "door", "doorway"]
    start_m: np.ndarray  # float64 [2]
    end_m: np.ndarray  # float64 [2]
    sill_m: float
    head_m: float
    hinge: Hinge | None = None
    is_open: bool = False

    def __post_init__(self):
        put = object.__setattr__
        put(self, "start_m", checks.coordinates("start_m", self.start_m, (2,)))
        put(self, "end_m", checks.coordinates("end_m", self.end_m, (2,)))
        if self.kind not in ("window", "door", "doorway"):
            raise ValueError(f"kind must be window, door or doorway, got {self.kind!r}")
        if not 0 <= self.sill_m < self.head_m:
            raise ValueError(f"sill_m must be below head_m, got {self.sill_m} and {self.head_m}")
        if self.hinge not in ("left", "right", None):
            raise ValueError(f"hinge must be left, right or null, got {self.hinge!r}")
        if not isinstance(self.is_open, bool):
            raise ValueError(f"open must be true or false, got {self.is_open!r}")
        if self.kind != "door" and (self.hinge or self.is_open):
            raise ValueError(f"a {self.kind} has no leaf, so it must have no hinge and not be open")


@dataclass(frozen=True, eq=False)
class LayoutObject:
    """A piece of furniture as an oriented box, with axes and angles as in ObjectInstance."""

    class_id: int
    center_m: np.ndarray  # float64 [3]
    size_m: np.ndarray  # float64 [3]
    yaw_deg: float
    name: str = ""

    def __post_init__(self):
        put = object.__setattr__
        put(self, "center_m", checks.coordinates("center_m", self.center_m, (3,)))
        put(self, "size_m", checks.lengths("size_m", self.size_m, (3,)))
        if (self.size_m <= 0).any():
            raise ValueError(f"size_m must be above 0, got {self.size_m.tolist()}")
        checks.floats("yaw_deg", [self.yaw_deg], (1,))


@dataclass(frozen=True, eq=False)
class Layout:
    """A room: its floor polygon (counter-clockwise from above), walls, openings and objects.

    ``floor_z_m`` is the height of the floor in the frame, above 0 for an upper storey. Sills, heads
    and the wall height are relative to the floor. Object positions are in the frame.
    """

    floor_polygon_m: np.ndarray  # float64 [N, 2]
    wall_height_m: float
    openings: tuple[Opening, ...] = ()
    objects: tuple[LayoutObject, ...] = field(default=())
    floor_z_m: float = 0.0
    name: str = ""

    def __post_init__(self):
        put = object.__setattr__
        polygon = checks.coordinates("floor_polygon_m", self.floor_polygon_m, (None, 2))
        if len(polygon) < 3:
            raise ValueError(f"floor_polygon_m must have 3 or more corners, got {len(polygon)}")
        put(self, "floor_polygon_m", polygon)
        checks.positive("wall_height_m", self.wall_height_m)
        checks.lengths("wall_height_m", [self.wall_height_m], (1,))
        checks.coordinates("floor_z_m", [self.floor_z_m], (1,))
        put(self, "openings", tuple(self.openings))
        put(self, "objects", tuple(self.objects))
