"""Options of ``w2m render``, and parsers for their values."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.panels import more_option, option
from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.api.pictures import GamePose


SourcePath = Annotated[
    Path, typer.Argument(metavar="WORLD_OR_FILE", help="World, run folder, .schem, .nbt ...")
]
Out = Annotated[
    Path | None,
    option("--out", "-o", metavar="FILE_OR_FOLDER", show_default="NAME.png, .gif",
           text="Image (.png .jpg .webp .exr .npy), animation (.gif .apng .webp .mp4 .webm), "
                "or folder of images."),
]  # fmt: skip
Outputs = Annotated[
    str, option("--outputs", metavar="A,B",
                text="rgb, depth, range, block, state, class, instance, face, id (state, class "
                     "and instance), all ..."),
]  # fmt: skip
Pose = Annotated[
    list[str] | None,
    option("--pose", metavar="X,Y,Z,YAW,PITCH",
           text="Feet position, as on the F3 screen, or eye position with ,eye. Repeatable."),
]  # fmt: skip
Poses = Annotated[
    Path | None,
    option("--poses", metavar="FILE", text="JSON lines or CSV with x, y, z, yaw, pitch ..."),
]
Orbit = Annotated[bool, option("--orbit", text="Render views on a circle around the build.")]
Tour = Annotated[bool, option("--tour", text="Render a walk through the rooms at eye height.")]
Turntable = Annotated[
    bool, option("--turntable", text="Render the build rotating on plain ground.")
]
Frames = Annotated[
    int | None,
    option("--frames", metavar="N", text="Number of images in an orbit, a tour or a turntable."),
]
Rate = Annotated[float, more_option("--fps", help="Frames per second of an animation.")]
Opened = Annotated[
    bool | None,
    option("--open/--closed", text="Omit ceilings and near walls in views from outside.",
           show_default="open for rooms with labels"),
]  # fmt: skip
BoxText = Annotated[
    str, more_option("--box", metavar="X0,Y0,Z0,X1,Y1,Z1",
                     help="Render only the blocks in this box, with exclusive upper bounds."),
]  # fmt: skip
Size = Annotated[str, option("--size", metavar="WxH", text="Image size in pixels.")]
VerticalFov = Annotated[
    float | None,
    more_option("--vfov", help="Vertical field of view in degrees.", show_default="70; --orbit 40"),
]
HorizontalFov = Annotated[
    float | None, more_option("--hfov", help="Horizontal field of view, instead of --vfov.")
]
ImageFormat = Annotated[
    str,
    more_option(
        "--format", metavar="png|jpg|webp", help="File format of colour images in a folder."
    ),
]
DepthFormat = Annotated[
    str, more_option("--depth-format", metavar="png|exr|npy",
                     help="png (16 bits), exr or npy (float32 metres)."),
]  # fmt: skip
DepthScale = Annotated[int, more_option("--depth-scale", help="Value of one metre in a depth PNG.")]
Quality = Annotated[int, more_option("--quality", help="JPEG and WebP quality, 1 to 100.")]
Hour = Annotated[
    float | None,
    option("--hour", text="Time of day, 0 to 24: 6 dawn, 19 dusk, 0 night.", show_default="11"),
]
Light = Annotated[
    str | None,
    option("--light", metavar="shader|game|neutral",
           text="Soft light, the game's light, or even light.", show_default="shader"),
]  # fmt: skip
Brightness = Annotated[
    float, more_option("--brightness", help="Brightness as in the game: 0 moody, 1 bright.")
]
Exposure = Annotated[
    float | None, more_option("--exposure", help="Exposure.", show_default="automatic")
]
SunShadow = Annotated[bool, more_option("--sun-shadow/--no-sun-shadow", help="Render sun shadows.")]
Samples = Annotated[
    int | None,
    more_option(
        "--samples",
        help="Rays along each side of a pixel, 1 to 4.",
        show_default="2; 1 in a folder",
    ),
]
Textures = Annotated[
    int | None,
    more_option("--textures", metavar="16|32|64|128", show_default="16, or that of --pack",
                help="Texture size of a block face in pixels."),
]  # fmt: skip
Packs = Annotated[
    list[Path] | None,
    more_option("--pack", metavar="PATH",
                help="Resource pack or client jar. Repeatable; later packs take precedence."),
]  # fmt: skip
Photo = Annotated[bool, option("--photo", text="Use path tracing: slow, with soft shadows.")]
PhotoSamples = Annotated[
    int, more_option("--photo-samples", help="Paths for each pixel of --photo.")
]
Device = Annotated[str, more_option("--device", metavar="auto|cpu|gpu", help="Where to draw.")]
Jobs = Annotated[
    int, more_option("--jobs", metavar="N", help="Processes that draw a folder or an animation.")
]
Threads = Annotated[int | None, more_option("--threads", help="Threads.", show_default="all cores")]
AsJson = Annotated[bool, option("--json", text="Print the poses and their files as JSON.")]


def view_of(flags: dict[str, bool], pose: list[str] | None, poses: Path | None) -> str:
    """Return the view selected by the options, or ``start`` if none is selected.

    Raises:
        UsageError: If several options select a view.
    """
    given = {"pose": bool(pose), "poses": poses is not None, **flags}
    chosen = sorted(name for name, is_given in given.items() if is_given)
    if len(chosen) > 1:
        listed = " and ".join(f"--{name}" for name in chosen)
        raise UsageError(f"{listed} exclude each other; use only one of them")
    return next((name for name in chosen if name in flags), "start")


def poses_of(pose: list[str] | None, poses: Path | None) -> "list[GamePose] | Path | None":
    """Return the poses given with ``--pose``, or the file given with ``--poses``.

    Raises:
        UsageError: If a pose is invalid.
    """
    return [pose_of(text) for text in pose] if pose else poses


def pose_of(text: str) -> "GamePose":
    """Parse a camera pose such as ``4,64,-3,90,10``.

    Raises:
        UsageError: If the text is not a valid pose.
    """
    from world2minecraft.api.pictures import game_pose

    words = [word.strip() for word in text.split(",")]
    at = words.pop().lower() if words and words[-1].lower() in ("feet", "eye") else "feet"
    try:
        x, y, z, yaw_deg, pitch_deg = (float(word) for word in words)
    except ValueError:
        raise UsageError(
            f"--pose must be x,y,z,yaw,pitch or x,y,z,yaw,pitch,eye, got {text!r}"
        ) from None
    return game_pose((x, y, z, yaw_deg, pitch_deg), at)


def box_of(text: str) -> tuple[int, int, int, int, int, int] | None:
    """Parse a box of six integers, or return None for an empty text.

    Raises:
        UsageError: If the text is not a valid box.
    """
    if not text:
        return None
    try:
        x0, y0, z0, x1, y1, z1 = (int(word) for word in text.split(","))
    except ValueError:
        raise UsageError(f"--box must be six integers x0,y0,z0,x1,y1,z1, got {text!r}") from None
    if x0 >= x1 or y0 >= y1 or z0 >= z1:
        raise UsageError(f"--box must have x0 < x1, y0 < y1 and z0 < z1, got {text!r}")
    return x0, y0, z0, x1, y1, z1
