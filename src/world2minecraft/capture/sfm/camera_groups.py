"""Groups of photos that share a camera, and conversion of cameras to and from pycolmap."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.capture.sfm.features import Features
from world2minecraft.core.types import Camera
from world2minecraft.geometry.unprojection import lens_distortion

# Focal length by the longer side: phones 0.7 to 0.9, webcams and Kinects 0.8 to 0.9.
DEFAULT_FOCAL = 0.8
# Focal lengths nearer than that are one lens that breathes with its focus.
SAME_FOCAL_TOLERANCE = 0.02
MIN_FOCAL, MAX_FOCAL = 0.3, 2.0  # Focal lengths / longer side of photos of rooms.
MAX_DISTORTION = 0.6  # Terms of distortion; wide phones have 0.3.


@dataclass(frozen=True)
class CameraGroup:
    """A group of photos that share a camera.

    Attributes:
        camera: The shared intrinsics.
        photos: Numbers of the photos.
        known: ``exact`` (fixed, since the photos were cut from panoramas), ``stated``, ``guessed``
            (from EXIF), ``unknown`` (starts from default intrinsics) or ``assumed`` (fixed, because
            the photos cannot determine the intrinsics).
    """

    camera: Camera
    photos: tuple[int, ...]
    known: str

    @property
    def is_fixed(self) -> bool:
        """Whether the intrinsics must not be refined."""
        return self.known in ("exact", "assumed")


def camera_by_photo(lenses: list[CameraGroup]) -> dict[int, Camera]:
    """Return the camera of each photo by photo number."""
    return {i: group.camera for group in lenses for i in group.photos}


def default_camera(width_px: int, height_px: int, focal: float = DEFAULT_FOCAL) -> Camera:
    """Return a camera without distortion, with a focal length typical for the longer side."""
    focal_px = focal * max(width_px, height_px)
    return Camera(width_px, height_px, focal_px, focal_px, width_px / 2, height_px / 2)


def group_cameras(photos: list[Features]) -> list[CameraGroup]:
    """Group photos of the same size with similar stated focal lengths.

    The camera of a group is the median of its photos' cameras.
    """
    groups: list[list[int]] = []
    for i, photo in enumerate(photos):
        for group in groups:
            if _share_camera(photos[group[0]], photo):
                group.append(i)
                break
        else:
            groups.append([i])
    return [_make_group(photos, group) for group in groups]


def _share_camera(one: Features, other: Features) -> bool:
    if one.size != other.size or sensor_of(one) != sensor_of(other):
        return False
    if one.camera is None or other.camera is None:
        return one.camera is other.camera
    return abs(one.camera.fx_px / other.camera.fx_px - 1) < SAME_FOCAL_TOLERANCE


def sensor_of(photo: Features) -> int | None:
    """Return the number of the sensor of a photo's rig, or None without a rig."""
    return None if photo.rig is None else photo.rig.sensor


def _make_group(photos: list[Features], group: list[int]) -> CameraGroup:
    cameras = [camera for i in group if (camera := photos[i].camera) is not None]
    if not cameras:
        return CameraGroup(default_camera(*photos[group[0]].size), tuple(group), "unknown")
    middle = sorted(cameras, key=lambda camera: camera.fx_px)[len(cameras) // 2]
    if all(photos[i].rig is not None for i in group):
        return CameraGroup(middle, tuple(group), "exact")
    guessed = any(photos[i].camera_guessed for i in group)
    return CameraGroup(middle, tuple(group), "guessed" if guessed else "stated")


def to_colmap(pycolmap: Any, camera: Camera, number: int, simple: bool) -> Any:
    """Convert a camera to pycolmap; ``simple`` uses one focal length and one distortion term.

    A simple camera omits all other terms, which suits intrinsics that are still to be estimated.
    """
    k1, k2, p1, p2, k3 = camera.distortion
    focal = (camera.fx_px * camera.fy_px) ** 0.5
    middle = [camera.cx_px, camera.cy_px]
    if simple:
        model, params = "SIMPLE_RADIAL", [focal, *middle, k1]
    elif k3 == 0 and p1 == 0 and p2 == 0 and abs(camera.fx_px / camera.fy_px - 1) < 1e-3:
        model, params = "RADIAL", [focal, *middle, k1, k2]
    else:
        both = [camera.fx_px, camera.fy_px, *middle, k1, k2, p1, p2]
        model, params = ("OPENCV", both) if k3 == 0 else ("FULL_OPENCV", [*both, k3, 0, 0, 0])
    made = pycolmap.Camera.create_from_model_name(
        number, model, focal, camera.width_px, camera.height_px
    )
    made.params = params
    made.has_prior_focal_length = True  # Verification then takes the lens for right within 4 px.
    return made


def from_colmap(made: Any) -> Camera:
    """Convert a pycolmap camera, with parameters rounded to 1e-9."""
    params = np.round(np.asarray(made.params, np.float64), 9).tolist()
    if made.model_name in ("SIMPLE_RADIAL", "RADIAL"):
        focal, cx, cy, *radial = params
        both, terms = (focal, focal), (*radial, 0.0)[:2]
        distortion = (*terms, 0.0, 0.0, 0.0)
    else:
        *both, cx, cy = params[:4]
        k1, k2, p1, p2, *more = params[4:]
        distortion = (k1, k2, p1, p2, more[0] if more else 0.0)
    fx, fy = both
    return Camera(made.width, made.height, fx, fy, cx, cy, distortion)


def normalise_pixels(camera: Camera, pixels: np.ndarray) -> np.ndarray:
    """Return the intersections of pixel rays with the plane z = 1, float64 [K, 2].

    Args:
        camera: Intrinsics with distortion.
        pixels: Pixel positions, [K, 2].
    """
    bent = (pixels - [camera.cx_px, camera.cy_px]) / [camera.fx_px, camera.fy_px]
    straight = bent.copy()
    for _ in range(20):  # A fixed point; phones' lenses need four rounds to 1e-9.
        x, y = straight.T
        radial, *shift = lens_distortion(x, y, camera.distortion)
        straight = (bent - np.stack(shift, axis=1)) / np.maximum(radial, 0.1)[:, None]
    return straight


def is_plausible_camera(camera: Camera) -> bool:
    """Return whether estimated intrinsics are plausible for photos of rooms.

    Photos of a single flat surface or with few details can lead to implausible intrinsics.
    """
    longer = max(camera.width_px, camera.height_px)
    in_range = MIN_FOCAL * longer < camera.fx_px < MAX_FOCAL * longer
    return in_range and max(abs(term) for term in camera.distortion) < MAX_DISTORTION
