"""``w2m render``: pictures of any build: from the game's poses, from outside, on a walk within."""

from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING

from world2minecraft.cli.render import options as option
from world2minecraft.cli.render.look import Look, Looks, take_pictures
from world2minecraft.cli.render.output_files import (
    LINES_FILE,
    Target,
    Writer,
    check_many,
    check_pixels,
    one_size,
    target_of,
)
from world2minecraft.cli.render.shot_selection import (
    Plan,
    View,
    plan_of,
    resolve_view,
    turntable_count,
    view_of,
)
from world2minecraft.cli.render.source import Source, read_source
from world2minecraft.core.errors import UsageError
from world2minecraft.core.progress import Progress

if TYPE_CHECKING:
    from world2minecraft.core.types import BlockVolume
    from world2minecraft.rendering import Picture
    from world2minecraft.rendering.presentation.shot_rendering import DrawOptions
    from world2minecraft.rendering.views import Shot

MAX_WRITERS = 16  # Each holds a picture.
EXAMPLES = """\
w2m render OUT                                        from where the player starts
w2m render house.schem --out house.png                a schematic, from outside
w2m render OUT --pose 4,64,-3,90,10 --out here.jpg    as F3 in the game says
w2m render OUT --tour --out walk.mp4                  a walk through the rooms
w2m render OUT --turntable --out room.gif             the room turns on a plain ground
w2m render OUT --tour --frames 200 --outputs rgb,depth,id --out DATA
w2m render OUT --poses DATA/poses.jsonl --out AGAIN   the same views, once more
"""


def run(
    source: option.SourcePath,
    out: option.Out = None,
    pose: option.Pose = None,
    poses: option.Poses = None,
    orbit: option.Orbit = False,
    tour: option.Tour = False,
    turntable: option.Turntable = False,
    frames: option.Frames = None,
    opened: option.Opened = None,
    box: option.BoxText = "",
    size: option.Size = "1280x720",
    vfov: option.VerticalFov = None,
    hfov: option.HorizontalFov = None,
    outputs: option.Outputs = "rgb",
    image_format: option.ImageFormat = "png",
    depth_format: option.DepthFormat = "png",
    depth_scale: option.DepthScale = 1000,
    quality: option.Quality = 92,
    fps: option.Rate = 24.0,
    light: option.Light = None,
    hour: option.Hour = None,
    brightness: option.Brightness = 0.5,
    exposure: option.Exposure = None,
    sun_shadow: option.SunShadow = False,
    samples: option.Samples = None,
    textures: option.Textures = None,
    pack: option.Packs = None,
    photo: option.Photo = False,
    photo_samples: option.PhotoSamples = 16,
    device: option.Device = "auto",
    threads: option.Threads = None,
    jobs: option.Jobs = 1,
) -> None:
    """Draw a build, without the game, a display or a graphics card.

    One kind of view a command: --pose, --poses, --orbit, --tour or --turntable; without any, where
    the player of a world of this program starts, and other builds from outside. Beside the
    pictures lies NAME.poses.jsonl (in a folder poses.jsonl) with the pose, the intrinsics and the
    files of each, which --poses reads again; names.json says what the numbers of ids mean.

    Raises:
        UsageError: the words contradict each other, or one is out of range.
        InputError: the build or the poses cannot be read, or the output cannot be written.
    """
    option.check_count(frames, fps)
    choice = option.camera_choice(size, vfov, hfov)
    given = tuple(option.pose_of(text) for text in pose or ())
    flags = {"orbit": orbit, "tour": tour, "turntable": turntable}
    view = view_of(given, poses, flags, frames, fps, opened)  # type: ignore[arg-type]
    from world2minecraft.rendering.output import parse_layers

    files = option.file_choice(image_format, depth_format, quality, depth_scale)
    wanted = parse_layers(outputs)
    count = frames if frames is not None else len(given) or None
    target = target_of(out, source.resolve().stem, view.kind, wanted, files, count)
    look = Look(light, hour, brightness, exposure, sun_shadow, samples, textures, tuple(pack or ()),
                photo, photo_samples, device, option.threads_of(threads), jobs)  # fmt: skip
    look.light_of(view.kind)  # What is out of range is said before any work.
    draw(read_source(source, option.box_of(box)), view, choice, target, look)


def draw(
    source: Source, view: View, choice: option.CameraChoice, target: Target, look: Look
) -> None:
    """Draw a view and say what was drawn. Raises what ``run`` raises."""
    from time import perf_counter

    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.rendering.output import required_outputs
    from world2minecraft.rendering.views.cameras import GAME_FOV_DEG

    print_compile_note()
    view = resolve_view(view, source)
    plan = plan_of(view, source, choice, target.medium)
    count = len(plan.shots) or turntable_count(view, target.medium)
    check_many(target, count)
    one_size(plan.shots, target)
    options = look.options_of(view.kind, target.medium, required_outputs(target.layers))
    cameras = [shot.camera for shot in plan.shots] or [choice.camera(GAME_FOV_DEG)]
    check_pixels(cameras, options.samples)
    if look.photo and view.kind == "turntable":
        raise UsageError("a turntable is not traced; --orbit --photo is")
    if look.jobs > 1 and view.kind == "turntable":
        raise UsageError("a turntable is drawn by one process; --jobs is for the other views")
    looks = look.looks()
    for note in [*source.notes, *plan.notes, *looks.notes(source.volume.palette)]:
        print(f"note: {note}")
    tour_id = f"{source.name}-{view.kind}"
    writer = Writer(target, source.volume.block_to_room, source.name, tour_id)
    began = perf_counter()
    with show_progress() as progress, writer.open(view.rate_hz):
        if view.kind == "turntable":
            _draw_turntable(source, view, choice, writer, count, looks, options, progress)
        else:
            _draw_plan(plan, writer, look, looks, options, progress)
    writer.finish(plan.volume_of(plan.shots[0]) if plan.shots else source.volume)
    _print_summary(writer, view, source, (perf_counter() - began) / count)


def _draw_plan(
    plan: Plan, writer: Writer, look: Look, looks: Looks, options: "DrawOptions", progress: Progress
) -> None:
    from world2minecraft.rendering.batch.streaming import SPARE, ordered_map

    total = len(plan.shots) * (look.photo_samples if look.photo else 1)
    done = 0

    def step(count: int) -> None:
        nonlocal done
        done += count
        if done < total:  # The last step is the writing of the last picture.
            progress("render", done, total)

    progress("render", 0, total)
    # Each picture is written while the next ones are drawn; a moving one takes them one by one.
    most = 1 if writer.target.medium == "moving" else MAX_WRITERS
    writers = min(max(look.threads, look.jobs), most)
    with closing(_pictures(plan, look, looks, options, step)) as pictures:
        written = (writer.later(*one) for one in pictures)
        for _ in ordered_map(written, lambda write: write(), writers, writers + SPARE):
            pass
    progress("render", total, total)


def _pictures(
    plan: Plan, look: Look, looks: Looks, options: "DrawOptions", step: Callable[[int], None]
) -> Generator[tuple["Shot", "Picture", "BlockVolume"], None, None]:
    """Take the pictures of a plan; each volume that is seen is made ready once at a time."""
    from world2minecraft.rendering import prepare_scene
    from world2minecraft.rendering.presentation.shot_rendering import with_common_exposure

    exposure = None
    for _, run_of in groupby(plan.shots, key=lambda shot: id(plan.volume_of(shot))):
        shots = list(run_of)
        volume = plan.volume_of(shots[0])
        scene = prepare_scene(volume, looks.source, texture_px=looks.side_px)
        if exposure is None:  # One for all, so that pictures of one plan belong together.
            exposure = with_common_exposure(scene, options.light, shots).exposure
        scene = replace(scene, exposure=exposure)
        pictures = take_pictures(scene, shots, look, options, step)
        for shot, picture in zip(shots, pictures, strict=True):
            yield shot, picture, volume


def _draw_turntable(
    source: Source, view: View, choice: option.CameraChoice, writer: Writer, count: int,
    looks: Looks, options: "DrawOptions", progress: Progress,
) -> None:  # fmt: skip
    from world2minecraft.rendering.presentation.turntable import FOV_DEG, turntable

    if writer.target.layers != ("rgb",):
        raise UsageError("a turntable is colour alone; --orbit has depth and ids too")
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


def _print_summary(writer: Writer, view: View, source: Source, seconds: float) -> None:
    """Say what was written, from where the first picture was taken, and what to try next."""
    target, first, count = writer.target, writer.lines[0], len(writer.lines)
    what = "one picture" if count == 1 else f"{count:,} pictures"
    print(f"{target.path}: {what} of {first['width']}x{first['height']}, {seconds:.2f} s each")
    if count == 1:
        x, y, z, yaw, pitch = (first[key] for key in ("x", "y", "z", "yaw", "pitch"))
        print(f"  pose   --pose {x:.2f},{y:.2f},{z:.2f},{yaw:.1f},{pitch:.1f},eye")
    size = " x ".join(str(side) for side in source.volume.states.shape)
    corner = ",".join(str(value) for value in source.volume.corner)
    print(f"  build  {size} blocks from {corner}")
    print(f"  poses  {target.beside(LINES_FILE)}")
    name = source.name
    following = {
        "tour": f"--tour --outputs rgb,depth,id --out {name}_data     the same walk as a data set",
        "turntable": f"--tour --out {name}_tour.gif     a walk through the rooms",
    }.get(view.kind, f"--tour --out {name}_tour.gif     a walk through the rooms")
    print(f"  next   w2m render {source.path} {following}")
