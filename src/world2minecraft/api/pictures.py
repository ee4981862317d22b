"""Render images of builds from any camera pose, in memory or as files."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import path_of
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.progress import Progress, no_progress

if TYPE_CHECKING:
    from PIL.Image import Image

    from world2minecraft.core.types import BlockVolume
    from world2minecraft.rendering.output import FileFormats
    from world2minecraft.rendering.picture_files.draw_settings import DrawSettings
    from world2minecraft.rendering.picture_files.drawing import DrawnFiles
    from world2minecraft.rendering.picture_files.shot_selection import CameraChoice, View
    from world2minecraft.rendering.views import GamePose

VIEWS = ("isometric", "plan", "inside")
FILE_VIEWS = ("start", "orbit", "tour", "turntable")
Box = tuple[int, int, int, int, int, int]
MAX_THREADS = 512


def render(
    source: Run | str | Path, *, size: tuple[int, int] = (640, 480), view: str = "isometric"
) -> "Image":
    """Render a build as one image, without the game, a display or a graphics card.

    Args:
        source: Run, run folder, world, or block file such as ``house.schem``.
        size: Image width and height in pixels.
        view: ``isometric`` (from outside, with the ceiling and near walls cut away), ``plan`` (from
            above) or ``inside`` (from the player's spawn point).

    Returns:
        The RGB image.

    Raises:
        UnknownNameError: If the view is unknown.
        InputError: If the build cannot be read.
        UsageError: If the size is out of range, or if ``inside`` is requested for a build without a
            spawn point.

    Example:
        >>> import world2minecraft as w2m
        >>> w2m.render(run, size=(320, 240)).size
        (320, 240)
    """
    from PIL import Image

    from world2minecraft.formats.build_reader import read_build
    from world2minecraft.rendering.preview import preview

    if view not in VIEWS:
        raise UnknownNameError("view", view, VIEWS)
    if min(size) < 1:
        raise UsageError(f"size must be 1 or more pixels per side, got {size[0]}x{size[1]}")
    build = read_build(path_of(source))
    volume = build.volume
    if view == "inside":
        if build.start is None:
            raise UsageError(f"{path_of(source)} has no player spawn point; use view='isometric'")
        start = build.start
        return _inside(volume, (start.x, start.y, start.z, start.yaw_deg), size)
    try:
        if view == "isometric":
            return Image.fromarray(preview(volume, *size))
        return _plan(volume, size)
    except ValueError as error:
        raise UsageError(f"size {size[0]}x{size[1]}: {error}") from error


def _plan(volume: "BlockVolume", size: tuple[int, int]) -> "Image":
    """Return a plan in the middle of an image of a size."""
    from PIL import Image

    from world2minecraft.rendering.preview import plan_view

    width, height = size
    across, along = volume.states.shape[0], volume.states.shape[2]
    plan = Image.fromarray(plan_view(volume, max(min(width // across, height // along), 1)))
    plan.thumbnail(size)
    picture = Image.new("RGB", size, plan.getpixel((0, 0)))  # type: ignore[arg-type]
    picture.paste(plan, ((width - plan.width) // 2, (height - plan.height) // 2))
    return picture


def _inside(
    volume: "BlockVolume", start: tuple[float, float, float, float], size: tuple[int, int]
) -> "Image":
    from PIL import Image

    from world2minecraft.core.coordinates import eye_height_blocks
    from world2minecraft.rendering import render_volume
    from world2minecraft.rendering.views import GamePose, camera_of
    from world2minecraft.rendering.views.cameras import GAME_FOV_DEG

    camera = camera_of(*size, vertical_fov_deg=GAME_FOV_DEG, horizontal_fov_deg=None)
    eye_blocks = eye_height_blocks(volume.blocks_per_metre)
    pose = GamePose(*start, 0.0).camera_to_room(volume.block_to_room, eye_blocks)
    picture = render_volume(volume, camera, pose, outputs=("colour",), samples=2)
    return Image.fromarray(np.asarray(picture.colour))


def render_files(
    source: Run | str | Path,
    out: str | Path | None = None,
    *,
    view: str = "start",
    poses: "Sequence[Sequence[float] | GamePose] | str | Path | None" = None,
    frames: int | None = None,
    opened: bool | None = None,
    box: Box | None = None,
    size: tuple[int, int] = (1280, 720),
    vertical_fov_deg: float | None = None,
    horizontal_fov_deg: float | None = None,
    outputs: Sequence[str] = ("rgb",),
    image_format: str = "png",
    depth_format: str = "png",
    depth_scale: int = 1000,
    quality: int = 92,
    fps: float = 24.0,
    light: str | None = None,
    hour: float | None = None,
    brightness: float = 0.5,
    exposure: float | None = None,
    sun_shadow: bool = False,
    samples: int | None = None,
    texture_px: int | None = None,
    packs: Sequence[str | Path] = (),
    photo: bool = False,
    photo_samples: int = 16,
    device: str = "auto",
    threads: int | None = None,
    jobs: int = 1,
    force: bool = False,
    progress: Progress = no_progress,
) -> "DrawnFiles":
    """Render a build to image files with their camera poses, without the game or a display.

    Args:
        source: Run, run folder, world, or block file such as ``house.schem``.
        out: Image file (.png .jpg .webp .exr .npy), animation (.gif .apng .webp .mp4 .webm) or
            folder. By default, a file in the working directory named after the source and the view.
        view: ``start`` (from the player's spawn point, or from outside if the build has none),
            ``orbit``, ``tour`` (a walk through the rooms) or ``turntable``.
        poses: Camera poses to use instead of a view: (x, y, z, yaw, pitch) at the feet, as on the
            game's F3 screen, ``GamePose`` values, or a JSON lines or CSV file of poses.
        frames: Number of images in an orbit, a tour or a turntable.
        opened: Omit ceilings and near walls in views from outside. By default, only for rooms with
            class labels.
        box: Render only the blocks in this box: x0, y0, z0, x1, y1, z1, with exclusive upper
            bounds.
        size: Image width and height in pixels.
        vertical_fov_deg: Vertical field of view in degrees. Defaults to 70, as in the game, or 40
            for an orbit.
        horizontal_fov_deg: Horizontal field of view in degrees, given instead of the vertical one.
        outputs: Image layers: ``rgb``, ``depth``, ``range``, ``block``, ``state``, ``class``,
            ``instance``, ``face`` and others. ``id`` selects state, class and instance. ``all``
            selects every layer.
        image_format: File format of colour images in a folder: ``png``, ``jpg`` or ``webp``.
        depth_format: ``png`` (16 bits), ``exr`` or ``npy`` (float32, metres).
        depth_scale: Value of one metre in a depth PNG.
        quality: JPEG and WebP quality from 1 to 100.
        fps: Frames per second of an animation.
        light: ``shader`` (soft), ``game`` or ``neutral`` (even).
        hour: Time of day from 0 to 24.
        brightness: Brightness setting of the game, from 0 (moody) to 1 (bright).
        exposure: Exposure from 0.01 to 100. Chosen automatically by default.
        sun_shadow: Render the shadows that the sun casts.
        samples: Number of rays along each side of a pixel, 1 to 4.
        texture_px: Texture size of a block face in pixels: 16, 32, 64 or 128.
        packs: Resource packs or client jar files. Later packs take precedence.
        photo: Use path tracing, which is slow but renders soft shadows.
        photo_samples: Number of light paths per pixel with ``photo``.
        device: ``auto``, ``cpu`` or ``gpu``.
        threads: Number of threads. Defaults to all cores.
        jobs: Number of processes that render a folder or an animation.
        force: Write into a folder that contains other files.
        progress: Callback that is called after each image, or after each path tracing pass.

    Returns:
        The written path, the camera poses and notes.

    Raises:
        UsageError: If an argument is out of range, two arguments exclude each other, or the folder
            contains other files without ``force``.
        UnknownNameError: If a view or an output layer is unknown.
        InputError: If the build, the poses or a resource pack cannot be read.
        ConflictError: If another process writes the folder.
        OutputError: If the files cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> drawn = w2m.render_files(run, tmp / "walk", view="tour", frames=2, size=(64, 48))
        >>> [pose["image"] for pose in drawn.poses]
        ['000000.png', '000001.png']
    """
    from world2minecraft.rendering.picture_files.draw_settings import DrawSettings

    choice = camera_choice(size, vertical_fov_deg, horizontal_fov_deg)
    seen = _view_of(view, poses, frames, fps, opened)
    files = _file_formats(image_format, depth_format, quality, depth_scale)
    settings = DrawSettings(
        light, hour, brightness, exposure, sun_shadow, samples, texture_px,
        tuple(Path(pack) for pack in packs), photo, photo_samples, device,
        _thread_count(threads), jobs,
    )  # fmt: skip
    return _draw(path_of(source), out, seen, choice, outputs, files, settings, box, force, progress)


def _draw(
    source: Path,
    out: str | Path | None,
    view: "View",
    choice: "CameraChoice",
    outputs: Sequence[str],
    files: "FileFormats",
    settings: "DrawSettings",
    box: Box | None,
    force: bool,
    progress: Progress,
) -> "DrawnFiles":
    """Check the arguments before any work, then read the build and render it."""
    from world2minecraft.core.output_folders import check_owned, output_folder
    from world2minecraft.rendering.output import parse_layers
    from world2minecraft.rendering.picture_files.destination import RENDERED, choose_target
    from world2minecraft.rendering.picture_files.drawing import draw_files
    from world2minecraft.rendering.picture_files.source import read_source

    target = choose_target(
        None if out is None else Path(out),
        source.resolve().stem,
        view.kind,
        parse_layers(",".join(outputs)),
        files,
        view.frames or len(view.poses) or None,
    )
    settings.light_of(view.kind)  # Raises where a value is out of range.
    if target.medium != "folder":
        return draw_files(read_source(source, box), view, choice, target, settings, progress)
    check_owned(target.path, RENDERED, force)
    read = read_source(source, box)
    with output_folder(target.path, RENDERED, "rendered", force=force, keep=False):
        return draw_files(read, view, choice, target, settings, progress)


def _thread_count(asked: int | None) -> int:
    from world2minecraft.core.machine import usable_cores

    if asked is None:
        return usable_cores()
    if not 1 <= asked <= MAX_THREADS:
        raise UsageError(f"threads must be 1 to {MAX_THREADS}, got {asked}")
    return asked


def _view_of(
    view: str,
    poses: "Sequence[Sequence[float] | GamePose] | str | Path | None",
    frames: int | None,
    fps: float,
    opened: bool | None,
) -> "View":
    """Return the view that the arguments of ``render_files`` describe."""
    from world2minecraft.rendering.picture_files.shot_selection import View
    from world2minecraft.rendering.views import GamePose

    if view not in FILE_VIEWS:
        raise UnknownNameError("view", view, FILE_VIEWS)
    if poses is None:
        return View("spawn" if view == "start" else view, (), None, frames, fps, opened)  # type: ignore[arg-type]
    if view != "start":
        raise UsageError(f"poses and view={view!r} exclude each other; use only one of them")
    if isinstance(poses, str | Path):
        return View("poses", (), Path(poses), frames, fps, opened)
    given = tuple(one if isinstance(one, GamePose) else game_pose(one) for one in poses)
    if not given:
        raise UsageError("poses is empty; give at least one pose")
    return View("pose", given, None, frames, fps, opened)


def _file_formats(image: str, depth: str, quality: int, per_metre: int) -> "FileFormats":
    """Return the file formats of the image layers."""
    from world2minecraft.rendering.output import FileFormats

    if image not in ("png", "jpg", "jpeg", "webp"):
        raise UsageError(f"the image format must be png, jpg or webp, got {image!r}")
    if depth not in ("png", "exr", "npy"):
        raise UsageError(f"the depth format must be png, exr or npy, got {depth!r}")
    if not 1 <= quality <= 100:
        raise UsageError(f"quality must be 1 to 100, got {quality}")
    if not 1 <= per_metre <= 65535:
        raise UsageError(f"the depth scale must be 1 to 65535, got {per_metre}")
    return FileFormats(f".{image}", f".{depth}", quality, per_metre)


def camera_choice(
    size: tuple[int, int],
    vertical_fov_deg: float | None = None,
    horizontal_fov_deg: float | None = None,
) -> "CameraChoice":
    """Return the image size in pixels with an optional field of view.

    Args:
        size: Image width and height in pixels.
        vertical_fov_deg: Vertical field of view in degrees.
        horizontal_fov_deg: Horizontal field of view in degrees. Excludes ``vertical_fov_deg``.

    Raises:
        UsageError: If a value is out of range or both fields of view are given.
    """
    from world2minecraft.rendering.picture_files.shot_selection import CameraChoice

    return CameraChoice(*size, vertical_fov_deg, horizontal_fov_deg)


def game_pose(values: Sequence[float], at: str = "feet") -> "GamePose":
    """Return a camera pose in game coordinates.

    Args:
        values: x, y and z in blocks, then yaw and pitch in degrees, as on the game's F3 screen.
        at: Reference point of x, y and z: ``feet`` or ``eye``.

    Raises:
        UsageError: If a value is out of range or there are not five.

    Example:
        >>> game_pose((4, 64, -3, 90, 10)).yaw_deg
        90
    """
    from world2minecraft.rendering.views import GamePose

    if len(values) != 5:
        raise UsageError(f"a pose must be x, y, z, yaw and pitch, got {len(values)} values")
    x, y, z, yaw_deg, pitch_deg = values
    return GamePose(x, y, z, yaw_deg, pitch_deg, at)  # type: ignore[arg-type]
