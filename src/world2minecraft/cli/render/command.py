"""Render a build from game poses, from outside or on a walk: ``w2m render``."""

import json
from typing import TYPE_CHECKING

from world2minecraft.cli.panels import Force
from world2minecraft.cli.render import options as option

if TYPE_CHECKING:
    from pathlib import Path

    from world2minecraft.api.pictures import DrawnFiles

EXAMPLES = """\
w2m render OUT                                       view from the player's spawn point
w2m render house.schem -o house.png                  a schematic, from outside
w2m render OUT --pose 4,64,-3,90,10 -o here.jpg      the pose of the game's F3 screen
w2m render OUT --tour -o walk.mp4                    a walk through the rooms
w2m render OUT --turntable -o room.gif               the room rotating on plain ground
w2m render OUT --tour --frames 200 --outputs rgb,depth,id -o DATA
w2m render OUT --poses DATA/poses.jsonl -o AGAIN     render the same views again
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
    force: Force = False,
    as_json: option.AsJson = False,
) -> None:
    """Render a build without the game, a display or a graphics card.

    Choose one view: --pose, --poses, --orbit, --tour or --turntable. By default, the view is from
    the player's spawn point, or from outside. The pose, intrinsics and files of each image are
    written to NAME.poses.jsonl (poses.jsonl in a folder), which --poses accepts. names.json lists
    the names of ids.

    Raises:
        UsageError: If options contradict each other or a value is out of range.
        InputError: If the build or the poses cannot be read, or if the output cannot be written.
    """
    from world2minecraft.api import render_files
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.arguments import parse_size
    from world2minecraft.core.precompile import compile_first

    flags = {"orbit": orbit, "tour": tour, "turntable": turntable}
    view = option.view_of(flags, pose, poses)
    with show_progress() as progress:
        drawn = render_files(
            source, out, view=view, poses=option.poses_of(pose, poses), frames=frames,
            opened=opened, box=option.box_of(box), size=parse_size(size, example="1280x720"),
            vertical_fov_deg=vfov, horizontal_fov_deg=hfov, outputs=outputs.split(","),
            image_format=image_format, depth_format=depth_format, depth_scale=depth_scale,
            quality=quality, fps=fps, light=light, hour=hour, brightness=brightness,
            exposure=exposure, sun_shadow=sun_shadow, samples=samples, texture_px=textures,
            packs=pack or (), photo=photo, photo_samples=photo_samples, device=device,
            threads=threads, jobs=jobs, force=force,
            progress=compile_first(progress, "pictures"),
        )  # fmt: skip
    if as_json:
        print(json.dumps(drawn.poses, indent=1))
    else:
        _print_summary(drawn, view, source)


def _print_summary(drawn: "DrawnFiles", view: str, source: "Path") -> None:
    """Print the output, the pose of the first image, and a next command."""
    for note in drawn.notes:
        print(f"note: {note}")
    first, count = drawn.poses[0], len(drawn)
    what = "1 image" if count == 1 else f"{count:,} images"
    print(f"{drawn.path}: {what} of {first['width']}x{first['height']}, {drawn.seconds:.2f} s each")
    if count == 1:
        x, y, z, yaw, pitch = (first[key] for key in ("x", "y", "z", "yaw", "pitch"))
        print(f"  pose   --pose {x:.2f},{y:.2f},{z:.2f},{yaw:.1f},{pitch:.1f},eye")
    size = " x ".join(str(side) for side in drawn.size_blocks)
    print(f"  build  {size} blocks from {','.join(str(value) for value in drawn.corner)}")
    print(f"  poses  {drawn.poses_file}")
    name = first["scene_id"]
    following = f"--tour --out {name}_tour.gif     a walk through the rooms"
    if view == "tour":
        following = (
            f"--tour --outputs rgb,depth,id --out {name}_data     render the walk as a data set"
        )
    print(f"  next   w2m render {source} {following}")
