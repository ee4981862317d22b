"""Lengths known to the user, such as a table height or a distance between two pixels."""

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
    """A length known to the user.

    Attributes:
        name: Name of the length, such as ``table height``.
        length_m: The length in metres.
        measured: The same length in the unit of the scan, or None if it was not measured.
    """

    name: str
    length_m: float
    measured: float | None = None

    def __post_init__(self):
        if self.name not in LENGTHS_M:
            raise UnknownNameError("known length", self.name, LENGTHS_M)
        minimum, maximum = LENGTHS_M[self.name]
        if not minimum <= self.length_m <= maximum:
            raise UsageError(
                f"{self.name} must be from {minimum:g} to {maximum:g} m, got {self.length_m:g}; "
                "lengths are in metres"
            )
        if self.measured is not None and not 0 < self.measured < np.inf:
            raise ValueError(f"measured must be above 0, got {self.measured}")

    @property
    def sigma(self) -> float:
        """The relative error of the scale computed from this length."""
        return SIGMA.get(self.name, USUAL_SIGMA)


@dataclass(frozen=True)
class KnownDistance:
    """A known distance between two pixels of views.

    Attributes:
        image_a: Name of the first view.
        point_a: Pixel x and y in the depth image, or in the colour image if it is a different
            camera.
        image_b: Name of the second view, which may be the same.
        point_b: Pixel in the second view.
        length_m: Distance in metres.
    """

    image_a: str
    point_a: tuple[float, float]
    image_b: str
    point_b: tuple[float, float]
    length_m: float

    def known(self, views: Iterable[View]) -> KnownLength:
        """Measure the distance in the scan, and return it as a known length.

        Raises:
            UsageError: If a view is missing or has no depth at its pixel.
        """
        at = ((self.image_a, self.point_a), (self.image_b, self.point_b))
        return KnownLength("distance", self.length_m, length_between(views, *at))


def parse_known_length(name: str, length_m: float) -> KnownLength:
    """Return the known length with a given name; spaces, dashes and underscores are equivalent.

    Raises:
        UnknownNameError: If the name is unknown.
        UsageError: If the length is not plausible, or the name requires two points.
    """
    plain = " ".join(name.lower().replace("_", " ").replace("-", " ").split())
    if plain == "distance":
        raise UsageError(
            f"a distance requires two points in the photos; or give a named length, {EXAMPLE}"
        )
    if plain in NEEDS_POINTS:
        raise UsageError(
            f"{plain} cannot be measured automatically; give two points in the photos at its ends, "
            f"or another length, {EXAMPLE}"
        )
    if plain not in LENGTHS_M:
        raise UnknownNameError("known length", name, sorted(set(LENGTHS_M) - {"distance"}))
    return KnownLength(plain, float(length_m))


def length_between(
    views: Iterable[View], a: tuple[str, tuple[float, float]], b: tuple[str, tuple[float, float]]
) -> float:
    """Return the distance between the surface points of two pixels, in the unit of the scan.

    Args:
        views: Views with depth, read once and one at a time.
        a: Name of a view, and the pixel's x and y from the upper left corner of its depth image, or
            of its colour image if that is a different camera.
        b: View and pixel of the second point.

    Raises:
        UsageError: If a view is missing or has no depth at its pixel.
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
        raise UsageError(
            f"the two points in {a[0]} and {b[0]} are identical; give two different points"
        )
    return length


def _unproject_pixel(view: View, pixel: tuple[float, float]) -> np.ndarray:
    """Return the surface point [3] at a pixel, in the frame of the scan."""
    depth, camera = view.depth_m, view.depth_camera
    if depth is None or camera is None:
        raise UsageError(f"{view.name} has no depth; choose a point in another image")
    x, y = pixel
    if view.colour_camera is not None:
        # Captures of our own and of photos have both in one place; the images differ in size only.
        x *= camera.width_px / view.colour_camera.width_px
        y *= camera.height_px / view.colour_camera.height_px
    column, row = int(np.floor(x)), int(np.floor(y))
    if not (0 <= column < camera.width_px and 0 <= row < camera.height_px):
        raise UsageError(f"point {pixel[0]:g},{pixel[1]:g} is outside image {view.name}")
    near = depth[
        max(row - WINDOW_RADIUS_PX, 0) : row + WINDOW_RADIUS_PX + 1,
        max(column - WINDOW_RADIUS_PX, 0) : column + WINDOW_RADIUS_PX + 1,
    ]
    near = near[near > 0]
    if not len(near):
        raise UsageError(
            f"there is no depth at {pixel[0]:g},{pixel[1]:g} in {view.name}; choose a "
            "textured surface away from edges, glass and lamps"
        )
    z = float(np.median(near))
    point = [(x - camera.cx_px) / camera.fx_px * z, (y - camera.cy_px) / camera.fy_px * z, z, 1.0]
    return (view.depth_camera_to_scan @ np.array(point))[:3]


def candidate_lengths(known: KnownLength, measures: RoomMeasurements) -> list[tuple[float, float]]:
    """Return the candidates for a known length: (length in the unit of the scan, weight) each.

    Raises:
        UsageError: If the scan does not show the object of the length.
    """
    if known.measured is not None:
        return [(known.measured, 1.0)]
    if known.name in LEVEL_HEIGHTS:
        if not measures.levels:
            raise UsageError(_unseen(known.name, "no level face was seen above the floor"))
        return [(level.height, level.area) for level in measures.levels]
    value, missing = {
        "ceiling height": (measures.ceiling, "no ceiling"),
        "room height": (measures.ceiling, "no ceiling"),
        "room length": (measures.length, "no pair of opposite walls"),
        "room width": (measures.width, "no pair of opposite walls"),
        "camera height": (measures.camera if measures.floor_seen else None, "no floor"),
    }[known.name]
    if value is None:
        raise UsageError(_unseen(known.name, f"{missing} was seen"))
    return [(value, 1.0)]


def _unseen(name: str, reason: str) -> str:
    return f"{name} cannot be used: {reason}; give another length, {EXAMPLE}, or two points"
