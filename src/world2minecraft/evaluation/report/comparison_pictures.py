"""The images of the report: photos beside the built world from the same pose."""

import base64
import io
from dataclasses import dataclass

import numpy as np
from PIL import Image

from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.capture.view_stream import views_named
from world2minecraft.core.parallel import map_parallel
from world2minecraft.core.types import Camera, Scan, View
from world2minecraft.geometry.undistort import pinhole_camera
from world2minecraft.reconstruction.verification.photo_samples import evenly_spread
from world2minecraft.rendering.batch import render_batch
from world2minecraft.rendering.picture import render_volume
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.shading_parameters import NEUTRAL

PAIRS = 6
CHOICE_PX, MIN_SHARE = 64, 0.005  # Width of the pictures that choose views, and share of an object.
WIDTH_PX = 480
SAMPLES = 2  # Rays across a pixel; light is even, so that colours compare with the photo's.
AGREES_M = 0.25  # One block at the default scale.


@dataclass(frozen=True, eq=False)
class Pair:
    """The photo of a view, the world rendered from its pose, and their depth difference.

    Attributes:
        name: The name of the view.
        photo: The photo as uint8 [H, W, 3], or None.
        built: The rendered world as uint8 [H, W, 3].
        depth_error_m: The median absolute depth difference in metres, or None without depth.
        depth_agrees: The share of pixels whose depths differ by at most ``AGREES_M``, or None.
    """

    name: str
    photo: np.ndarray | None
    built: np.ndarray
    depth_error_m: float | None
    depth_agrees: float | None


def make_pairs(scan: Scan, scene: BlockScene) -> list[Pair]:
    """Return up to six pairs: of each sixth of the frames used, one that shows many objects."""
    chosen = choose_views(scan, scene)
    views = list(views_named(scan.views, chosen))
    return map_parallel(lambda view: _pair(view, scan, scene), views)


def choose_views(scan: Scan, scene: BlockScene) -> list[str]:
    """Return the names of up to six views that show most objects of the built world.

    They are spread over the frames used. Without the frames of a capture, whose poses are known
    before they are decoded, every n-th frame is taken.
    """
    frames = {frame.name: frame for frame in getattr(scan.views, "frames", ())}
    known = [frames[name] for name in scan.frames_used if name in frames]
    if len(known) < len(scan.frames_used):
        return evenly_spread(scan.frames_used, PAIRS)
    parts = np.array_split(np.arange(len(known)), min(PAIRS, len(known)))
    things = map_parallel(lambda frame: _things(frame, scan, scene), known)
    return [known[max(part, key=lambda n: things[n])].name for part in parts]


def _things(frame: FrameFiles, scan: Scan, scene: BlockScene) -> int:
    """Return the number of objects that the built world shows from the pose of a frame."""
    camera, pose = frame.colour_camera or frame.depth_camera, frame.camera_to_world
    if camera is None or pose is None or not np.isfinite(pose).all():
        return 0
    small = pinhole_camera(camera, CHOICE_PX)
    poses = (scan.scan_to_room @ pose)[None]
    seen = np.asarray(render_batch(scene, small, poses, outputs=("instance",)).instance)
    ids, counts = np.unique(seen, return_counts=True)
    return int((counts[ids > 0] >= MIN_SHARE * seen.size).sum())


def _pair(view: View, scan: Scan, scene: BlockScene) -> Pair:
    camera = view.colour_camera or view.depth_camera
    if camera is None:
        raise ValueError(f"view {view.name} has neither a colour nor a depth image")
    small = camera.resized(WIDTH_PX, round(WIDTH_PX * camera.height_px / camera.width_px))
    camera_to_room = scan.scan_to_room @ view.camera_to_scan
    picture = render_volume(scene, small, camera_to_room, light=NEUTRAL, samples=SAMPLES)
    error_m, agrees = _depth_apart(view, scan, scene)
    photo = None
    if view.colour is not None:
        size = (small.width_px, small.height_px)
        photo = np.asarray(Image.fromarray(view.colour).resize(size, Image.Resampling.LANCZOS))
    if picture.colour is None:
        raise RuntimeError("the renderer returned no colour image")
    return Pair(view.name, photo, picture.colour, error_m, agrees)


def _depth_apart(view: View, scan: Scan, scene: BlockScene) -> tuple[float | None, float | None]:
    """Return the median depth difference and the share of agreeing pixels, on a coarse raster."""
    if view.depth_m is None or view.depth_camera is None:
        return None, None
    step = max(view.depth_camera.width_px // 160, 1)
    shape = view.depth_m[::step, ::step].shape
    coarse = Camera(
        shape[1],
        shape[0],
        view.depth_camera.fx_px / step,
        view.depth_camera.fy_px / step,
        view.depth_camera.cx_px / step,
        view.depth_camera.cy_px / step,
    )
    measured = view.depth_m[::step, ::step]
    built = render_volume(
        scene, coarse, scan.scan_to_room @ view.depth_camera_to_scan, outputs=()
    ).depth_m
    both = (measured > 0) & (built > 0)
    if not both.any():
        return None, None
    difference = np.abs(measured - built)[both]
    return round(float(np.median(difference)), 4), round(float((difference <= AGREES_M).mean()), 4)


def as_data_uri(image: np.ndarray, *, lossless: bool = False) -> str:
    """Encode an image, uint8 [H, W, 3], as a ``data:`` URI in JPEG or PNG format."""
    if lossless:
        kind, data = "png", as_png(image)
    else:
        buffer = io.BytesIO()
        Image.fromarray(image).save(buffer, "JPEG", quality=86, subsampling=0)
        kind, data = "jpeg", buffer.getvalue()
    return f"data:image/{kind};base64,{base64.b64encode(data).decode()}"


def as_png(image: np.ndarray) -> bytes:
    """Encode an image, uint8 [H, W, 3], as PNG."""
    buffer = io.BytesIO()
    Image.fromarray(image).save(buffer, "PNG", compress_level=6)
    return buffer.getvalue()
