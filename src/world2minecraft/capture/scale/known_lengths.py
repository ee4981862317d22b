"""Lengths that the user knows: a table's height, a room's side, or a distance of two pixels."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.scale.measurements import RoomMeasurements
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.types import View

LEVEL_HEIGHTS = ("table height", "counter height", "seat height", "bed height")
LENGTHS_M: dict[str, tuple[float, float]] = {
    "table height": (0.3, 1.3),
    "counter height": (0.6, 1.3),
    "seat height": (0.2, 0.9),
    "bed height": (0.15, 1.6),
    "ceiling height": (1.5, 12.0),
    "room height": (1.5, 12.0),
    "room length": (1.0, 40.0),
    "room width": (1.0, 40.0),
    "camera height": (0.05, 12.0),
    "distance": (0.02, 40.0),
}
NEEDS_POINTS = ("door height", "door width", "window width", "window height")  # No level face.
# How exactly each is measured in the scan, relative: a hand that holds a camera rises and sinks.
SIGMA = {"camera height": 0.03, "ceiling height": 0.01, "room height": 0.01, "distance": 0.01}
USUAL_SIGMA = 0.015
WINDOW_RADIUS_PX = 2  # Pixels on each side of a clicked one: a median of 5 x 5.
EXAMPLE = "such as 'table height' 0.72"


@dataclass(frozen=True)
class KnownLength:
    """A length that the user knows. ``measured`` is the same in the scan's unit, if known too."""

    name: str
    length_m: float
    measured: float | None = None

    def __post_init__(self):
        if self.name not in LENGTHS_M:
            raise UnknownNameError("known length", self.name, LENGTHS_M)
        minimum, maximum = LENGTHS_M[self.name]
        if not minimum <= self.length_m <= maximum:
            raise UsageError(
                f"{self.name} must be {minimum:g} to {maximum:g} m, not {self.length_m:g}; "
                "lengths are in metres"
            )
        if self.measured is not None and not 0 < self.measured < np.inf:
            raise ValueError(f"measured must be above 0, not {self.measured}")

    @property
    def sigma(self) -> float:
        """The relative error of the scale that it gives."""
        return SIGMA.get(self.name, USUAL_SIGMA)


@dataclass(frozen=True)
class KnownDistance:
    """Two pixels, each x and y in the depth image's or colour image's own size, and their distance.

    ``image_a`` and ``image_b`` are names of views; they may be the same.
    """

    image_a: str
    point_a: tuple[float, float]
    image_b: str
    point_b: tuple[float, float]
    length_m: float

    def known(self, views: Iterable[View]) -> KnownLength:
        """Return the known length with what it measures in the scan.

        Raises:
            UsageError: an image is not there, or has no depth at its point.
        """
        at = ((self.image_a, self.point_a), (self.image_b, self.point_b))
        return KnownLength("distance", self.length_m, length_between(views, *at))


def parse_known_length(name: str, length_m: float) -> KnownLength:
    """Return a known length by its name; spaces, dashes and underscores are alike.

    Raises:
        UnknownNameError: nothing is measured under this name. UsageError: no such length.
    """
    plain = " ".join(name.lower().replace("_", " ").replace("-", " ").split())
    if plain == "distance":
        raise UsageError(f"a distance needs two points of the photos; or give a name, {EXAMPLE}")
    if plain in NEEDS_POINTS:
        raise UsageError(
            f"{plain} is not measured by itself: give two points of the photos at its ends, "
            f"or another length, {EXAMPLE}"
        )
    if plain not in LENGTHS_M:
        raise UnknownNameError("known length", name, sorted(set(LENGTHS_M) - {"distance"}))
    return KnownLength(plain, float(length_m))


def length_between(
    views: Iterable[View], a: tuple[str, tuple[float, float]], b: tuple[str, tuple[float, float]]
) -> float:
    """Return the distance of two pixels' surface points, in the scan's unit.

    Args:
        views: read once, one at a time; those with depth.
        a: the name of a view and the pixel's x and y, from the left upper corner of its depth
            image, or of its colour image where that is another camera.
        b: the same of the other point.

    Raises:
        UsageError: an image is not there, or has no depth at its point.
    """
    found: dict[int, np.ndarray] = {}
    names = []
    for view in views:
        names.append(view.name)
        for index, (name, pixel) in enumerate((a, b)):
            if view.name == name:
                found[index] = _unproject_pixel(view, pixel)
    for index, (name, _) in enumerate((a, b)):
        if index not in found:
            raise UnknownNameError("image", name, names)
    length = float(np.linalg.norm(found[0] - found[1]))
    if length <= 0:
        raise UsageError(f"the two points of {a[0]} and {b[0]} are one; give two different ones")
    return length


def _unproject_pixel(view: View, pixel: tuple[float, float]) -> np.ndarray:
    """Return the surface point [3] under a pixel, in the scan's frame."""
    depth, camera = view.depth_m, view.depth_camera
    if depth is None or camera is None:
        raise UsageError(f"{view.name} has no depth; click in another image")
    x, y = pixel
    if view.colour_camera is not None:
        # Captures of our own and of photos have both in one place; the images differ in size only.
        x *= camera.width_px / view.colour_camera.width_px
        y *= camera.height_px / view.colour_camera.height_px
    column, row = int(np.floor(x)), int(np.floor(y))
    if not (0 <= column < camera.width_px and 0 <= row < camera.height_px):
        raise UsageError(f"point {pixel[0]:g},{pixel[1]:g} lies outside image {view.name}")
    near = depth[
        max(row - WINDOW_RADIUS_PX, 0) : row + WINDOW_RADIUS_PX + 1,
        max(column - WINDOW_RADIUS_PX, 0) : column + WINDOW_RADIUS_PX + 1,
    ]
    near = near[near > 0]
    if not len(near):
        raise UsageError(
            f"there is no depth at {pixel[0]:g},{pixel[1]:g} of {view.name}; "
            "click on a surface with texture, away from edges, glass and light"
        )
    z = float(np.median(near))
    point = [(x - camera.cx_px) / camera.fx_px * z, (y - camera.cy_px) / camera.fy_px * z, z, 1.0]
    return (view.depth_camera_to_scan @ np.array(point))[:3]


def candidate_lengths(known: KnownLength, measures: RoomMeasurements) -> list[tuple[float, float]]:
    """Return what may be meant by a known length: (length in the scan's unit, weight) each.

    Raises:
        UsageError: nothing of the kind was seen.
    """
    if known.measured is not None:
        return [(known.measured, 1.0)]
    if known.name in LEVEL_HEIGHTS:
        if not measures.levels:
            raise UsageError(_unseen(known.name, "no level face was seen over the floor"))
        return [(level.height, level.area) for level in measures.levels]
    value = {
        "ceiling height": measures.ceiling,
        "room height": measures.ceiling,
        "room length": measures.length,
        "room width": measures.width,
        "camera height": measures.camera if measures.floor_seen else None,
    }[known.name]
    if value is None:
        what = {"c": "no floor", "r": "not both of its walls"}.get(known.name[0], "no ceiling")
        if known.name in ("ceiling height", "room height"):
            what = "no ceiling"
        raise UsageError(_unseen(known.name, f"{what} was seen"))
    return [(value, 1.0)]


def _unseen(name: str, reason: str) -> str:
    return f"{name} cannot be taken: {reason}; give another length, {EXAMPLE}, or two points"
