"""Image and depth conventions of the published data sets: cameras, resampling and depth encodings.

The published loaders round projected coordinates, so their pixel centres are at whole numbers; ours
are at +0.5. The principal points therefore differ by half a pixel.

NYU depth PNGs contain millimetres whose 16 bits are rotated left by three. ISO rotates them back,
while Symphonies divides by 8000. The results are the same up to 8.191 m; beyond this depth, the
rotation wraps around. We therefore write whole millimetres up to 8.191 m, multiplied by eight,
which both loaders read correctly, and write larger depths as holes. OccScanNet PNGs contain plain
millimetres.
"""

import math
from typing import Literal

import numpy as np
from PIL import Image

from world2minecraft.capture.depth_images import DepthEncoding
from world2minecraft.core.coordinates import fov_deg_of_focal_px
from world2minecraft.core.errors import InputError
from world2minecraft.core.types import Camera
from world2minecraft.formats.sscnet import NYU_FOCAL_PX, NYU_SIZE_PX
from world2minecraft.rendering.output.images import number_bytes

NYU_MAX_MM = 8191
MAX_MM = 65534  # Some readers treat 65535 as a hole.
LOW_BITS_SHARE = 0.01
DepthCode = Literal["nyu", "mm"]
WIDTH_PX, HEIGHT_PX = NYU_SIZE_PX
HALF_PX = 0.5
NYU_CAMERA = Camera(WIDTH_PX, HEIGHT_PX, NYU_FOCAL_PX, NYU_FOCAL_PX, 320 + HALF_PX, 240 + HALF_PX)
TOLERANCE_PX = 1.01  # Pixels that may be missing at a border, which are repeated.
SAME_FOCAL_PX, SAME_CENTRE_PX = 0.05, 0.51


def encode_depth(depth_m: np.ndarray, code: DepthCode) -> bytes:
    """Encode a depth map in metres as a PNG, with 0 for holes and depths out of range.

    Args:
        depth_m: Depth in metres, float32 [H, W].
        code: ``nyu`` for the bit-rotated millimetres of NYUv2, or ``mm`` for plain millimetres.
    """
    millimetres = np.round(np.nan_to_num(depth_m, posinf=0) * 1000).astype(np.int64)
    far = NYU_MAX_MM if code == "nyu" else MAX_MM
    millimetres[(millimetres < 0) | (millimetres > far)] = 0
    values = millimetres * 8 if code == "nyu" else millimetres
    return number_bytes(values.astype(np.uint16))


def decode_depth(raw: np.ndarray, code: DepthCode) -> np.ndarray:
    """Decode stored depth values to metres, float32 [H, W], with 0 for holes.

    The two NYU encodings are distinguished by their three low bits: rotated millimetres have the
    value 0 or 1 there (for depths below 16.4 m), while units of 1/8000 m have any value.

    Example:
        >>> decode_depth(np.array([[8000, 0, 16385]], np.uint16), "nyu").tolist()
        [[1.0, 0.0, 10.239999771118164]]
    """
    if code == "mm":
        return DepthEncoding("mm").to_metres(raw)
    seen = raw[raw > 0]
    any_bits = seen.size and np.mean((seen & 7) > 1) > LOW_BITS_SHARE
    return DepthEncoding(str(1 / 8000) if any_bits else "rotated").to_metres(raw)


def is_same_camera(camera: Camera, other: Camera) -> bool:
    """Return whether two cameras produce the same image, within half a pixel."""
    return (
        (camera.width_px, camera.height_px) == (other.width_px, other.height_px)
        and abs(camera.fx_px - other.fx_px) <= SAME_FOCAL_PX
        and abs(camera.fy_px - other.fy_px) <= SAME_FOCAL_PX
        and abs(camera.cx_px - other.cx_px) <= SAME_CENTRE_PX
        and abs(camera.cy_px - other.cy_px) <= SAME_CENTRE_PX
        and not any(camera.distortion)
    )


def vga_camera(camera: Camera) -> Camera:
    """Return the 640x480 camera that covers the largest possible central part of an image.

    Example:
        >>> vga_camera(Camera(1920, 1080, 1000, 1000, 960, 540)).fx_px
        444.4444444444444
    """
    height = min(camera.height_px, camera.width_px * HEIGHT_PX / WIDTH_PX)
    scale = HEIGHT_PX / height
    left = (camera.width_px - WIDTH_PX / scale) / 2
    top = (camera.height_px - height) / 2
    return Camera(
        WIDTH_PX,
        HEIGHT_PX,
        camera.fx_px * scale,
        camera.fy_px * scale,
        (camera.cx_px - left) * scale,
        (camera.cy_px - top) * scale,
        camera.distortion,
    )


class Resampler:
    """A resampler that converts images of one camera to another camera with the same pose."""

    def __init__(self, name: str, source: Camera, target: Camera):
        """Check that the source camera covers the whole image of the target camera.

        Raises:
            InputError: If the source camera covers less, or if a lens has distortion.
        """
        self.same = is_same_camera(source, target)
        self.source, self.target = source, target
        if self.same:
            return
        if any(source.distortion) or any(target.distortion):
            raise InputError(
                name,
                "the camera has lens distortion; undistort the images or render them without it",
            )
        self.left, self.width = _span(source.fx_px, source.cx_px, target.fx_px, target.cx_px, 640)
        self.top, self.height = _span(source.fy_px, source.cy_px, target.fy_px, target.cy_px, 480)
        self.pad = math.ceil(max(self.width / 640, self.height / 480) * TOLERANCE_PX) + 1
        slack_x, slack_y = self.width / 640 * TOLERANCE_PX, self.height / 480 * TOLERANCE_PX
        if (
            min(self.left + slack_x, self.top + slack_y) < 0
            or self.left + self.width > source.width_px + slack_x
            or self.top + self.height > source.height_px + slack_y
        ):
            raise InputError(name, _too_narrow(source, target))

    def colour(self, pixels: np.ndarray) -> np.ndarray:
        """Resample a colour image to uint8 [480, 640, 3] with an antialiased bilinear filter."""
        if self.same:
            return pixels
        pad = self.pad
        padded = np.pad(pixels, ((pad, pad), (pad, pad), (0, 0)), mode="edge")
        box = (
            self.left + pad,
            self.top + pad,
            self.left + self.width + pad,
            self.top + self.height + pad,
        )
        size = (self.target.width_px, self.target.height_px)
        image = Image.fromarray(padded).resize(size, Image.Resampling.BILINEAR, box=box)
        return np.asarray(image)

    def depth(self, depth_m: np.ndarray) -> np.ndarray:
        """Resample a depth map to float32 [480, 640] by nearest neighbour."""
        if self.same:
            return depth_m
        columns = _nearest(self.left, self.width, self.target.width_px, depth_m.shape[1])
        rows = _nearest(self.top, self.height, self.target.height_px, depth_m.shape[0])
        return np.ascontiguousarray(depth_m[rows[:, None], columns])


def _span(
    source_focal: float, source_centre: float, focal: float, centre: float, side_px: int
) -> tuple[float, float]:
    """Return the start and the length of the target image in source pixels."""
    scale = source_focal / focal
    return source_centre - centre * scale, side_px * scale


def _nearest(start: float, length: float, count: int, size: int) -> np.ndarray:
    middles = start + (np.arange(count) + 0.5) * length / count
    return np.clip(np.floor(middles).astype(np.int64), 0, size - 1)


def _too_narrow(source: Camera, target: Camera) -> str:
    def angles(camera: Camera) -> str:
        across = fov_deg_of_focal_px(camera.width_px, camera.fx_px)
        return f"{across:.1f} x {fov_deg_of_focal_px(camera.height_px, camera.fy_px):.1f}"

    return (
        f"the camera covers {angles(source)} degrees, but the format needs {angles(target)}; "
        "use a wider field of view, or export to occscannet or npz"
    )
