"""Agreement of the built world with the photos: place, look and name of what each pixel shows.

Each sample of a photo is compared with the world rendered from the same pose. A pixel with a
measured depth shows a thing: the object or the structure (wall, floor, ceiling, window) of the cell
in which the measured point lies. The thing is

- **there** if the rendered image shows the same thing within half a block of the pixel, at a depth
  that differs by at most one block;
- of the right **look** if the CIEDE2000 difference of the smoothed colours is at most
  ``MAX_COLOUR``;
- of the right **name** if the class that the segmentation network sees in the photo is one of
  those that the built thing shows.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.geometry.colour import ciede2000, linear_to_lab, srgb_to_linear
from world2minecraft.reconstruction.verification.built_names import BuiltThing
from world2minecraft.reconstruction.verification.photo_samples import PhotoSample
from world2minecraft.rendering.picture import render_volume
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.shading_parameters import NEUTRAL

MAX_COLOUR = 18.0  # Kitchen: 79% of right pairs of pixels are below, 20% of wrong ones.
SMOOTH_PX = 5  # Of both images before colours are compared: blocks have textures.
MAX_GAIN = 2.0  # Of the photo's brightness, which the camera chose.
RAYS = 2  # Across a pixel.
NOTHING = 0
AROUND = np.array([(0, 0), (-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (-1, 1), (1, -1), (1, 1)])


@dataclass(frozen=True, eq=False)
class ViewAgreement:
    """The agreement of one sample, in arrays of its H x W pixels.

    Attributes:
        thing: What the photo shows: object id, minus the class of structure, or 0 for nothing.
        built: What the rendered image shows, in the same numbers.
        measured: Whether the depth is known.
        there: Whether the thing is there.
        difference: CIEDE2000 difference where the thing is there, NaN elsewhere, float32.
        named: Whether the name is right.
    """

    thing: np.ndarray
    built: np.ndarray
    measured: np.ndarray
    there: np.ndarray
    difference: np.ndarray
    named: np.ndarray

    @property
    def looks(self) -> np.ndarray:
        """Whether the look is right, bool [H, W]."""
        return self.there & (self.difference <= MAX_COLOUR)

    @property
    def right(self) -> np.ndarray:
        """Whether the thing is there with the right look and name, bool [H, W]."""
        return self.looks & self.named


def things_of_photo(sample: PhotoSample, grid: OccupancyGrid) -> np.ndarray:
    """Return what each pixel of a photo shows, int32 [H, W]; see ``ViewAgreement``.

    A measured point lies in an occupied cell, or up to half a cell behind or before one.
    """
    points_m = sample.points_m
    away = points_m - sample.camera_to_room[:3, 3]
    away /= np.maximum(np.linalg.norm(away, axis=2, keepdims=True), 1e-9)
    result = np.full(sample.depth_m.shape, NOTHING, np.int32)
    keys = thing_numbers(grid.labels, grid.instance)
    for step in (0.0, 0.5, -0.5, 1.0, -1.0):
        cells = np.floor((points_m + step * grid.voxel_m * away - grid.origin_m) / grid.voxel_m)
        cells = cells.astype(np.int64)
        inside = ((cells >= 0) & (cells < grid.shape)).all(axis=2)
        found = np.where(inside, keys[tuple(np.where(inside[..., None], cells, 0).T)].T, NOTHING)
        result = np.where(result == NOTHING, found, result)
    return np.where(sample.depth_m > 0, result, NOTHING).astype(np.int32)


def thing_numbers(labels: np.ndarray, instance: np.ndarray) -> np.ndarray:
    """Return object ids, minus the class where there is no object, and 0 for nothing, as int32."""
    known = np.where(labels == UNKNOWN, 0, labels).astype(np.int32)
    return np.where((instance > 0) & (known > 0), instance.astype(np.int32), -known)


def compare_view(
    sample: PhotoSample,
    thing: np.ndarray,
    scene: BlockScene,
    things: Mapping[int, BuiltThing],
    tolerance_m: float,
) -> ViewAgreement:
    """Compare the world with a photo from the same pose.

    Args:
        sample: The photo.
        thing: What it shows, from ``things_of_photo``.
        scene: The built world.
        things: What built things show, by object id or minus the class of structure.
        tolerance_m: Depth tolerance in metres.
    """
    picture = render_volume(
        scene,
        sample.camera,
        sample.camera_to_room,
        outputs=("colour", "semantic", "instance"),
        light=NEUTRAL,
        samples=RAYS,
    )
    if picture.colour is None or picture.semantic is None or picture.instance is None:
        raise RuntimeError("the renderer returned no colour, class or object image")
    built = thing_numbers(picture.semantic, picture.instance)
    measured = sample.depth_m > 0
    there, place = _found(sample, thing, built, picture.depth_m, tolerance_m)
    difference = np.full(thing.shape, np.nan, np.float32)
    if there.any():
        difference[there] = _colour_differences(sample.colour, picture.colour, there, place[there])
    named = np.zeros(thing.shape, bool)
    for number in np.unique(thing[measured]):
        if number in things:
            mine = thing == number
            named[mine] = np.isin(sample.seen[mine], list(things[number].nyu40))
    return ViewAgreement(thing, built, measured, there, difference, named)


def _found(
    sample: PhotoSample,
    thing: np.ndarray,
    built: np.ndarray,
    depth_m: np.ndarray,
    tolerance_m: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Return which things are there, bool [H, W], and the flat pixel that shows each."""
    height, width = thing.shape
    reach = 0.5 * tolerance_m * sample.camera.fx_px / np.maximum(sample.depth_m, 0.1)
    rows, columns = np.indices(thing.shape)
    there, place = np.zeros(thing.shape, bool), rows * width + columns
    for down, right in AROUND:
        v = np.clip(np.rint(rows + down * reach), 0, height - 1).astype(np.int64)
        u = np.clip(np.rint(columns + right * reach), 0, width - 1).astype(np.int64)
        same = (built[v, u] == thing) & (np.abs(depth_m[v, u] - sample.depth_m) <= tolerance_m)
        same &= ~there & (thing != NOTHING)
        place[same] = (v * width + u)[same]
        there |= same
    return there, place


def _colour_differences(
    photo: np.ndarray, built: np.ndarray, there: np.ndarray, place: np.ndarray
) -> np.ndarray:
    """Return the CIEDE2000 differences of the pixels ``there`` and those that show the same things.

    Both images are smoothed, and the photo is brought to the world's brightness.
    """
    light, light_built = (
        uniform_filter(srgb_to_linear(image), SMOOTH_PX, axes=(0, 1)) for image in (photo, built)
    )
    middle, middle_built = (np.median(image[there].mean(axis=1)) for image in (light, light_built))
    gain = np.clip(middle_built / max(middle, 1e-6), 1 / MAX_GAIN, MAX_GAIN)
    lab = linear_to_lab(np.clip(light[there] * gain, 0, 1))
    return ciede2000(lab, linear_to_lab(light_built.reshape(-1, 3)[place]))
