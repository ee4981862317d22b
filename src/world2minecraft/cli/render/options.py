"""Options of ``w2m render``, and parsers for their values."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from world2minecraft.cli.panels import MORE
from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.api.pictures import CameraChoice, GamePose


def _option(*names: str, text: str, metavar: str | None = None, default: str | bool = True) -> Any:
    return typer.Option(*names, help=text, metavar=metavar, show_default=default)


def _more(*names: str, text: str, metavar: str | None = None, default: str | bool = True) -> Any:
    """Return an option in the section "More options"."""
    return typer.Option(
        *names, help=text, metavar=metavar, show_default=default, rich_help_panel=MORE
    )


SourcePath = Annotated[
    Path, typer.Argument(metavar="WORLD_OR_FILE", help="World, run folder, .schem, .nbt ...")
]
Out = Annotated[
    Path | None,
    _option("--out", "-o", metavar="FILE_OR_FOLDER", default="NAME.png, .gif",
            text="Image (.png .jpg .webp .exr .npy), animation (.gif .apng .webp .mp4 .webm), "
                 "or folder of images."),
]  # fmt: skip
Outputs = Annotated[
    str, _option("--outputs", metavar="A,B",
                 text="rgb, depth, range, block, state, class, instance, face, id (state, class "
                      "and instance), all ..."),
]  # fmt: skip
Pose = Annotated[
    list[str] | None,
    _option("--pose", metavar="X,Y,Z,YAW,PITCH",
            text="Feet position, as on the F3 screen, or eye position with ,eye. Repeatable."),
]  # fmt: skip
Poses = Annotated[
    Path | None,
    _option("--poses", metavar="FILE", text="JSON lines or CSV with x, y, z, yaw, pitch ..."),
]
Orbit = Annotated[bool, _option("--orbit", text="Render views on a circle around the build.")]
Tour = Annotated[bool, _option("--tour", text="Render a walk through the rooms at eye height.")]
Turntable = Annotated[
    bool, _option("--turntable", text="Render the build rotating on plain ground.")
]
Frames = Annotated[
    int | None,
    _option("--frames", metavar="N", text="Number of images in an orbit, a tour or a turntable."),
]
Rate = Annotated[float, _more("--fps", text="Frames per second of an animation.")]
Opened = Annotated[
    bool | None,
    _option("--open/--closed", text="Omit ceilings and near walls in views from outside.",
            default="open for rooms with labels"),
]  # fmt: skip
BoxText = Annotated[
    str, _more("--box", metavar="X0,Y0,Z0,X1,Y1,Z1",
                 text="Render only the blocks in this box, with exclusive upper bounds."),
]  # fmt: skip
Size = Annotated[str, _option("--size", metavar="WxH", text="Image size in pixels.")]
VerticalFov = Annotated[
    float | None,
    _more("--vfov", text="Vertical field of view in degrees.", default="70; --orbit 40"),
]
HorizontalFov = Annotated[
    float | None, _more("--hfov", text="Horizontal field of view, instead of --vfov.")
]
ImageFormat = Annotated[
    str, _more("--format", metavar="png|jpg|webp", text="File format of colour images in a folder.")
]
DepthFormat = Annotated[
    str, _more("--depth-format", metavar="png|exr|npy",
               text="png (16 bits), exr or npy (float32 metres)."),
]  # fmt: skip
DepthScale = Annotated[int, _more("--depth-scale", text="Value of one metre in a depth PNG.")]
Quality = Annotated[int, _more("--quality", text="JPEG and WebP quality, 1 to 100.")]
Hour = Annotated[
    float | None,
    _option("--hour", text="Time of day, 0 to 24: 6 dawn, 19 dusk, 0 night.", default="11"),
]
Light = Annotated[
    str | None,
    _option("--light", metavar="shader|game|neutral",
            text="Soft light, the game's light, or even light.", default="shader"),
]  # fmt: skip
Brightness = Annotated[
    float, _more("--brightness", text="Brightness as in the game: 0 moody, 1 bright.")
]
Exposure = Annotated[float | None, _more("--exposure", text="Exposure.", default="automatic")]
SunShadow = Annotated[bool, _more("--sun-shadow/--no-sun-shadow", text="Render sun shadows.")]
Samples = Annotated[
    int | None,
    _more("--samples", text="Rays along each side of a pixel, 1 to 4.", default="2; 1 in a folder"),
]
Textures = Annotated[
    int | None,
    _more("--textures", metavar="16|32|64|128", text="Texture size of a block face in pixels.",
          default="16, or that of --pack"),
]  # fmt: skip
Packs = Annotated[
    list[Path] | None,
    _more("--pack", metavar="PATH",
            text="Resource pack or client jar. Repeatable; later packs take precedence."),
]  # fmt: skip
Photo = Annotated[bool, _option("--photo", text="Use path tracing: slow, with soft shadows.")]
PhotoSamples = Annotated[int, _more("--photo-samples", text="Paths for each pixel of --photo.")]
Device = Annotated[str, _more("--device", metavar="auto|cpu|gpu", text="Where to draw.")]
Jobs = Annotated[
    int, _more("--jobs", metavar="N", text="Processes that draw a folder or an animation.")
]
Threads = Annotated[int | None, _more("--threads", text="Threads.", default="all cores")]
AsJson = Annotated[bool, _option("--json", text="Print the poses and their files as JSON.")]


def view_of(flags: dict[str, bool], pose: list[str] | None, poses: Path | None) -> str:
    """Return the view selected by the options, or ``start`` if none is selected.

    Raises:
        UsageError: they choose several.
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


def size_of(text: str) -> tuple[int, int]:
    """Return the width and height given with ``--size``.

    Raises:
        UsageError: If the text is not a valid size.
    """
    parts = text.lower().split("x")
    if len(parts) != 2 or not all(part.strip().isdigit() for part in parts):
        raise UsageError(f"--size must be WIDTHxHEIGHT in pixels, such as 1280x720, got {text!r}")
    return int(parts[0]), int(parts[1])


def camera_choice(size: str, vfov: float | None, hfov: float | None) -> "CameraChoice":
    """Return the camera settings given with ``--size``, ``--vfov`` and ``--hfov``.

    Raises:
        UsageError: If a value is invalid.
    """
    from world2minecraft.api.pictures import camera_choice as choose

    return choose(size_of(size), vfov, hfov)


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
