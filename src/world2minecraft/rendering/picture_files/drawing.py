"""Rendering of the shots of a view, with each image written while the next is rendered."""

from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass, field, replace
from itertools import groupby
from pathlib import Path
from time import perf_counter
from typing import Any

from world2minecraft.core.errors import UsageError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import BlockVolume
from world2minecraft.rendering import Picture, prepare_scene
from world2minecraft.rendering.batch.streaming import SPARE, ordered_map
from world2minecraft.rendering.output import required_outputs
from world2minecraft.rendering.picture_files.destination import (
    LINES_FILE,
    Target,
    Writer,
    check_many,
    check_pixels,
    check_same_size,
)
from world2minecraft.rendering.picture_files.draw_settings import DrawSettings, Looks, take_pictures
from world2minecraft.rendering.picture_files.shot_selection import (
    CameraChoice,
    Plan,
    View,
    plan_shots,
    resolve_view,
    turntable_count,
)
from world2minecraft.rendering.picture_files.source import Source
from world2minecraft.rendering.presentation.shot_rendering import DrawOptions, with_common_exposure
from world2minecraft.rendering.presentation.turntable import FOV_DEG, turntable
from world2minecraft.rendering.views import Shot
from world2minecraft.rendering.views.cameras import GAME_FOV_DEG

MAX_WRITERS = 16  # Each holds a picture.


@dataclass(frozen=True)
class DrawnFiles:
    """The image files that were written, with the pose of each image.

    Attributes:
        path: The image, the animation, or the folder of images.
        poses_file: JSON Lines file with one pose for each image.
        poses: The same lines as dicts with ``x``, ``y``, ``z``, ``yaw``, ``pitch``, ``files`` ...
        size_blocks: Size of the build in blocks along x, y and z.
        corner: World coordinates of the first block.
        notes: Automatic choices, and blocks or files that could not be rendered.
        seconds: Rendering time of one image.
    """

    path: Path
    poses_file: Path
    poses: list[dict[str, Any]] = field(repr=False)
    size_blocks: tuple[int, int, int]
    corner: tuple[int, int, int]
    notes: tuple[str, ...] = ()
    seconds: float = field(default=0.0, compare=False)

    def __len__(self) -> int:
        return len(self.poses)


def draw_files(
    source: Source,
    view: View,
    choice: CameraChoice,
    target: Target,
    settings: DrawSettings,
    progress: Progress = no_progress,
) -> DrawnFiles:
    """Render a view of a build to files.

    Args:
        source: The build.
        view: The viewpoints.
        choice: Image size and field of view.
        target: Destination of the images.
        settings: Light, textures and device.
        progress: Callback after each image, or after each pass of a path-traced image.

    Raises:
        UsageError: If arguments contradict each other or are out of range.
        InputError: If the poses or a resource pack cannot be read.
        OutputError: If a file cannot be written.
    """
    view = resolve_view(view, source)
    plan = plan_shots(view, source, choice, target.medium)
    count = len(plan.shots) or turntable_count(view, target.medium)
    check_many(target, count)
    check_same_size(plan.shots, target)
    options = settings.options_of(view.kind, target.medium, required_outputs(target.layers))
    cameras = [shot.camera for shot in plan.shots] or [choice.camera(GAME_FOV_DEG)]
    check_pixels(cameras, options.samples)
    _check_turntable(view, target, settings)
    looks = settings.looks()
    notes = [*source.notes, *plan.notes, *looks.notes(source.volume.palette)]
    tour_id = f"{source.name}-{view.kind}"
    writer = Writer(target, source.volume.block_to_room, source.name, tour_id)
    began = perf_counter()
    with writer.open(view.rate_hz):
        if view.kind == "turntable":
            _draw_turntable(source, view, choice, writer, count, looks, options, progress)
        else:
            _draw_plan(plan, writer, settings, looks, options, progress)
    writer.finish(plan.volume_of(plan.shots[0]) if plan.shots else source.volume)
    x, y, z = source.volume.states.shape
    return DrawnFiles(
        target.path,
        target.beside(LINES_FILE),
        writer.lines,
        (x, y, z),
        source.volume.corner,
        tuple(notes),
        (perf_counter() - began) / count,
    )


def _check_turntable(view: View, target: Target, settings: DrawSettings) -> None:
    if view.kind != "turntable":
        return
    if settings.photo:
        raise UsageError("turntable cannot be combined with photo; use orbit (--orbit --photo)")
    if settings.jobs > 1:
        raise UsageError("turntable cannot be combined with jobs; omit jobs (--jobs)")
    if target.layers != ("rgb",):
        raise UsageError("turntable can only output rgb; use orbit (--orbit) for depth and ids")


def _draw_plan(
    plan: Plan,
    writer: Writer,
    settings: DrawSettings,
    looks: Looks,
    options: DrawOptions,
    progress: Progress,
) -> None:
    total = len(plan.shots) * (settings.photo_samples if settings.photo else 1)
    done = 0

    def step(count: int) -> None:
        nonlocal done
        done += count
        if done < total:  # The last step is the writing of the last picture.
            progress("render", done, total)

    progress("render", 0, total)
    # Each picture is written while the next ones are drawn; an animation takes them one by one.
    most = 1 if writer.target.medium == "moving" else MAX_WRITERS
    writers = min(max(settings.threads, settings.jobs), most)
    with closing(_pictures(plan, settings, looks, options, step)) as pictures:
        written = (writer.later(*one) for one in pictures)
        for _ in ordered_map(written, lambda write: write(), writers, writers + SPARE):
            pass
    progress("render", total, total)


def _pictures(
    plan: Plan,
    settings: DrawSettings,
    looks: Looks,
    options: DrawOptions,
    step: Callable[[int], None],
) -> Generator[tuple[Shot, Picture, BlockVolume], None, None]:
    """Draw the pictures of a plan; the scene of each volume is prepared once in a row."""
    exposure = None
    for _, run_of in groupby(plan.shots, key=lambda shot: id(plan.volume_of(shot))):
        shots = list(run_of)
        volume = plan.volume_of(shots[0])
        scene = prepare_scene(volume, looks.source, texture_px=looks.side_px)
        if exposure is None:  # One for all pictures, so that they can be compared.
            exposure = with_common_exposure(scene, options.light, shots).exposure
        scene = replace(scene, exposure=exposure)
        pictures = take_pictures(scene, shots, settings, options, step)
        for shot, picture in zip(shots, pictures, strict=True):
            yield shot, picture, volume


def _draw_turntable(
    source: Source, view: View, choice: CameraChoice, writer: Writer, count: int,
    looks: Looks, options: DrawOptions, progress: Progress,
) -> None:  # fmt: skip

    turning = turntable(
        source.volume,
        choice.camera(FOV_DEG),
        count,
        options=options,
        looks=looks.source,
        texture_px=looks.side_px,
        rate_hz=view.rate_hz,
        opened=view.opened,
    )
    progress("render", 0, count)
    for done, (shot, colour) in enumerate(turning, 1):
        writer.colour(shot, colour)
        progress("render", done, count)
