"""Rendering of an image of a block volume from a camera in the room."""

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.observed_free_space import observed_free_space
from world2minecraft.rendering.picture_arrays import PixelArrays, draw_into, pixel_arrays
from world2minecraft.rendering.ray_caster.ray import GridCamera
from world2minecraft.rendering.scene import BlockScene, prepare_scene
from world2minecraft.rendering.shading_parameters import DAY, Backdrop, shading_parameters

OUTPUTS = ("colour", "depth", "semantic", "instance", "opaque", "normal", "free")
DEFAULT_OUTPUTS = ("colour", "depth", "semantic", "instance")
MAX_PIXELS = 64_000_000  # Two gigabytes of outputs.
MAX_SAMPLES = 8


@dataclass(frozen=True, eq=False)
class Picture:
    """The outputs of one rendered image. Outputs that were not requested are None.

    The outputs describe the first surface, including glass but not texture holes. Without a
    surface, depth and range are 0, ``block_index`` is -1, ``face`` is 255, ``semantic`` and
    ``instance`` are 0. On a display entity ``block_index`` is -1, ``cube_index`` is at least 0, and
    ``face`` is the most similar block face. The ``opaque_*`` arrays describe the first surface
    behind all glass.
    """

    depth_m: np.ndarray  # float32 [H, W], z-depth
    range_m: np.ndarray  # float32 [H, W], along the ray
    block_index: np.ndarray  # int32 [H, W], C-order index into volume.states
    face: np.ndarray  # uint8 [H, W], of block axes: -x +x -y +y -z +z
    cube_index: np.ndarray  # int32 [H, W], of the display entity, -1 for none
    colour: np.ndarray | None = None  # uint8 [H, W, 3]
    semantic: np.ndarray | None = None  # uint8 [H, W]
    instance: np.ndarray | None = None  # uint16 [H, W]
    opaque_depth_m: np.ndarray | None = None  # float32 [H, W]
    opaque_index: np.ndarray | None = None  # int32 [H, W]
    opaque_cube_index: np.ndarray | None = None  # int32 [H, W]
    normal: np.ndarray | None = None  # float32 [H, W, 3], outward, of block axes
    free: np.ndarray | None = None  # bool [X, Y, Z]: air that some ray has crossed

    @property
    def glass_index(self) -> np.ndarray:
        """The first glass block in front of an opaque surface, int32 [H, W], or -1."""
        if self.opaque_index is None or self.opaque_depth_m is None:
            raise ValueError("glass_index requires the output 'opaque'")
        return np.where(self.opaque_depth_m == self.depth_m, -1, self.block_index)


def render_volume(
    volume: BlockVolume | BlockScene,
    camera: Camera,
    camera_to_room: np.ndarray,
    *,
    outputs: Collection[str] = DEFAULT_OUTPUTS,
    light: LightSettings = DAY,
    samples: int = 1,
    threads: int = 1,
    background: Backdrop | None = None,
) -> Picture:
    """Render an image of a volume.

    Args:
        volume: The blocks, or their scene if several images are rendered.
        camera: Camera intrinsics. Distortion is ignored.
        camera_to_room: Camera pose, 4x4, OpenCV axes, metres.
        outputs: Additional outputs from ``OUTPUTS``. Depth, range, block and face are always
            included.
        light: Light settings, such as the time of day and the exposure.
        samples: Each pixel's colour is the mean of ``samples`` x ``samples`` rays. All other
            outputs are sampled at the pixel's centre.
        threads: Number of bands of rows rendered in parallel. It does not affect the result.
        background: sRGB colours of the first and last row of the background. None uses the sky.

    Raises:
        ValueError: If an output is unknown, or if the image has more than 64 million pixels.
    """
    rays = np.array([camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px])
    size = (camera.height_px, camera.width_px)
    return _draw(
        volume, rays, 1.0, camera_to_room, size, outputs, light, samples, threads, background
    )


def render_parallel(
    volume: BlockVolume | BlockScene,
    px_per_metre: float,
    size: tuple[int, int],
    camera_to_room: np.ndarray,
    *,
    outputs: Collection[str] = DEFAULT_OUTPUTS,
    light: LightSettings = DAY,
    samples: int = 1,
    threads: int = 1,
    background: Backdrop | None = None,
) -> Picture:
    """Render an orthographic image with rays along the camera's z axis.

    The centre of the image is at the camera's position. ``size`` is the height and width in pixels;
    the other arguments are those of ``render_volume``.
    """
    rays = np.array([px_per_metre, px_per_metre, size[1] / 2, size[0] / 2])
    return _draw(
        volume, rays, 0.0, camera_to_room, size, outputs, light, samples, threads, background
    )


def _draw(
    volume, rays, spread, camera_to_room, size, outputs, light, samples, threads, background
) -> Picture:
    check_request(outputs, size, samples)
    scene = prepare_scene(volume) if isinstance(volume, BlockVolume) else volume
    pose = np.ascontiguousarray((scene.room_to_grid @ camera_to_room)[:3], np.float64)
    shading = shading_parameters(light, scene, background, pose[:, 3][None] if spread else None)
    camera = GridCamera(pose, rays, spread)
    fine = "colour" in outputs and samples > 1
    arrays = pixel_arrays(size, [name for name in outputs if not (fine and name == "colour")])
    draw_into(arrays, scene, camera, shading, threads)
    if fine:
        many = pixel_arrays((size[0] * samples, size[1] * samples), ("colour",))
        draw_into(many, scene, camera._replace(rays=rays * samples), shading, threads)
        arrays = arrays._replace(colour=_mean_of_squares(many.colour, samples))
    picture = picture_of(arrays, outputs)
    if "free" in outputs:
        picture = replace(picture, free=observed_free_space(scene.tables, camera, arrays.depth))
    return picture


def check_request(outputs: Collection[str], size: tuple[int, int], samples: int) -> None:
    """Check the arguments of ``render_volume``.

    Raises:
        ValueError: If an argument is invalid.
    """
    unknown = sorted(set(outputs) - set(OUTPUTS))
    if unknown:
        raise ValueError(f"unknown output {unknown[0]!r}; outputs: {', '.join(OUTPUTS)}")
    if not 1 <= samples <= MAX_SAMPLES:
        raise ValueError(f"samples must be 1 to {MAX_SAMPLES}, got {samples}")
    if size[0] * size[1] * samples**2 > MAX_PIXELS:
        raise ValueError(
            f"an image may have at most {MAX_PIXELS:,} samples, got {size[1]}x{size[0]}"
        )


def picture_of(arrays: PixelArrays, outputs: Collection[str]) -> Picture:
    """Return rendered arrays as an image that shares their memory."""
    opaque = "opaque" in outputs
    return Picture(
        depth_m=arrays.depth,
        range_m=arrays.distance,
        block_index=arrays.index,
        face=arrays.face,
        cube_index=arrays.thing,
        colour=arrays.colour if "colour" in outputs else None,
        semantic=arrays.semantic if "semantic" in outputs else None,
        instance=arrays.instance if "instance" in outputs else None,
        opaque_depth_m=arrays.opaque_depth if opaque else None,
        opaque_index=arrays.opaque_index if opaque else None,
        opaque_cube_index=arrays.opaque_thing if opaque else None,
        normal=arrays.normal if "normal" in outputs else None,
    )


def picture_colour(picture: Picture) -> np.ndarray:
    """Return the colours of an image, uint8 [H, W, 3].

    Raises:
        ValueError: If the image was rendered without the output ``colour``.
    """
    if picture.colour is None:
        raise ValueError("the image has no colour; request the output 'colour'")
    return picture.colour


def visible_furniture(picture: Picture) -> float:
    """Return the sum over all objects of the square root of their visible pixels.

    The picture needs the outputs ``semantic`` and ``instance``.
    """
    if picture.instance is None or picture.semantic is None:
        return 0.0
    is_object = picture.semantic >= SemanticClass.CHAIR
    return float(np.sqrt(np.bincount(picture.instance[is_object].astype(np.int64))).sum())


def _mean_of_squares(colour: np.ndarray, samples: int) -> np.ndarray:
    """Return the mean of every samples x samples of pixels."""
    height, width = colour.shape[0] // samples, colour.shape[1] // samples
    squares = colour.reshape(height, samples, width, samples, 3)
    count = samples * samples
    total = np.full((height, width, 3), count // 2, np.uint16)
    for row in range(samples):
        for column in range(samples):
            total += squares[:, row, :, column]
    return (total // np.uint16(count)).astype(np.uint8)
