"""The options of ``w2m render``, and the values that their words become."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from world2minecraft.core.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.core.types import Camera
    from world2minecraft.rendering.output import FileFormats
    from world2minecraft.rendering.views import GamePose

MAX_FRAMES = 1_000_000


def _option(*names: str, text: str, metavar: str | None = None) -> Any:
    return typer.Option(*names, help=text, metavar=metavar)


SourcePath = Annotated[
    Path, typer.Argument(metavar="WORLD_OR_FILE", help="A world, a run's folder, .schem, .nbt ...")
]
Out = Annotated[
    Path | None,
    _option("--out", "-o", metavar="FILE_OR_FOLDER",
            text="A picture (.png .jpg .webp .exr .npy), a moving one (.gif .apng .webp .mp4 "
                 ".webm), or a folder of pictures; NAME.png beside you."),
]  # fmt: skip
Outputs = Annotated[
    str, _option("--outputs", metavar="A,B",
                 text="rgb, depth, range, block, state, class, instance, face; id is state, class "
                      "and instance, all is all."),
]  # fmt: skip
Pose = Annotated[
    list[str] | None,
    _option("--pose", metavar="X,Y,Z,YAW,PITCH",
            text="As the game's F3 screen says, at the feet; add ,eye for a camera there. "
                 "May be given often."),
]  # fmt: skip
Poses = Annotated[
    Path | None,
    _option("--poses", metavar="FILE",
            text="A tour: JSON lines or CSV with x, y, z, yaw, pitch ..."),
]  # fmt: skip
Orbit = Annotated[bool, _option("--orbit", text="From outside, on a circle around the build.")]
Tour = Annotated[bool, _option("--tour", text="A walk through the rooms at eye height.")]
Turntable = Annotated[bool, _option("--turntable", text="The build on a plain ground, turning.")]
Frames = Annotated[
    int | None,
    _option("--frames", metavar="N",
            text="How many pictures of an orbit, a tour or a turntable."),
]  # fmt: skip
Rate = Annotated[float, _option("--fps", text="Pictures a second of a moving picture.")]
Opened = Annotated[
    bool | None,
    _option(
        "--open/--closed",
        text="From outside, leave ceilings and near walls out; usual for labelled rooms.",
    ),
]
BoxText = Annotated[
    str, _option("--box", metavar="X0,Y0,Z0,X1,Y1,Z1",
                 text="Draw these blocks alone; the last ones are not included."),
]  # fmt: skip
Size = Annotated[str, _option("--size", metavar="WxH", text="In pixels.")]
VerticalFov = Annotated[
    float | None,
    _option("--vfov", text="Vertical field of view in degrees, as the game's; 70."),
]
HorizontalFov = Annotated[float | None, _option("--hfov", text="The horizontal one in its place.")]
ImageFormat = Annotated[
    str, _option("--format", metavar="png|jpg|webp", text="Of colour in a folder.")
]
DepthFormat = Annotated[
    str, _option("--depth-format", metavar="png|exr|npy",
                 text="png: 16 bits; exr and npy: 32-bit metres."),
]  # fmt: skip
DepthScale = Annotated[int, _option("--depth-scale", text="What a metre is in a depth PNG.")]
Quality = Annotated[int, _option("--quality", text="Of JPEG and WebP, 1 to 100.")]
Hour = Annotated[
    float | None, _option("--hour", text="Of the day, 0 to 24: 6 dawn, 11 usual, 19 dusk, 0 night.")
]
Light = Annotated[
    str | None,
    _option("--light", metavar="shader|game|neutral",
            text="Soft light, the game's own, or even light at the camera."),
]  # fmt: skip
Brightness = Annotated[
    float, _option("--brightness", text="As in the game: 0 moody, 1 bright; lifts the dark.")
]
Exposure = Annotated[
    float | None, _option("--exposure", text="Light of the whole; by itself where left out.")
]
SunShadow = Annotated[
    bool, _option("--sun-shadow/--no-sun-shadow", text="Whether things shade the sun.")
]
Samples = Annotated[
    int | None, _option("--samples", text="1 to 4 rays across each pixel; stills have 2.")
]
Textures = Annotated[
    int | None,
    _option("--textures", metavar="16|32|64|128",
            text="Pixels a block; 16, or what a --pack has."),
]  # fmt: skip
Packs = Annotated[
    list[Path] | None,
    _option("--pack", metavar="PATH",
            text="A resource pack or client jar of yours; given often, the last wins."),
]  # fmt: skip
Photo = Annotated[
    bool, _option("--photo", text="Trace the paths of light: slow, soft, real shadows.")
]
PhotoSamples = Annotated[int, _option("--photo-samples", text="Paths a pixel of --photo.")]
Device = Annotated[str, _option("--device", metavar="auto|cpu|gpu", text="What draws.")]
Jobs = Annotated[
    int, _option("--jobs", metavar="N", text="Processes that draw a folder or a video; 1.")
]
Threads = Annotated[int | None, _option("--threads", text="How many; as many as there are cores.")]


@dataclass(frozen=True)
class CameraChoice:
    """The size and the field of view; ``fov_given`` tells them from the usual ones."""

    width_px: int
    height_px: int
    vertical_fov_deg: float | None
    horizontal_fov_deg: float | None

    @property
    def fov_given(self) -> bool:
        """Whether the user chose a field of view."""
        return self.vertical_fov_deg is not None or self.horizontal_fov_deg is not None

    def camera(self, usual_fov_deg: float) -> "Camera":
        """Return the camera, with a vertical field of view where none was chosen."""
        from world2minecraft.rendering.views import camera_of

        vertical = self.vertical_fov_deg if self.fov_given else usual_fov_deg
        return camera_of(
            self.width_px,
            self.height_px,
            vertical_fov_deg=vertical,
            horizontal_fov_deg=self.horizontal_fov_deg,
        )


def camera_choice(size: str, vfov: float | None, hfov: float | None) -> CameraChoice:
    """Read ``--size``, ``--vfov`` and ``--hfov``. Raises UsageError."""
    if vfov is not None and hfov is not None:
        raise UsageError("--vfov and --hfov are two words for one thing; give one of them")
    parts = size.lower().split("x")
    if len(parts) != 2 or not all(part.strip().isdigit() for part in parts):
        raise UsageError(f"--size is width and height in pixels, such as 1280x720, not {size!r}")
    choice = CameraChoice(int(parts[0]), int(parts[1]), vfov, hfov)
    choice.camera(70.0)  # What is out of range is said now, before any work.
    return choice


def pose_of(text: str) -> "GamePose":
    """Read a pose. Raises UsageError."""
    from world2minecraft.rendering.views import GamePose

    words = [word.strip() for word in text.split(",")]
    at = words.pop().lower() if words and words[-1].lower() in ("feet", "eye") else "feet"
    try:
        x, y, z, yaw_deg, pitch_deg = (float(word) for word in words)
    except ValueError:
        raise UsageError(
            f"--pose is x,y,z,yaw,pitch and perhaps ,eye, such as 4,64,-3,90,10; not {text!r}"
        ) from None
    return GamePose(x, y, z, yaw_deg, pitch_deg, at)  # type: ignore[arg-type]


def box_of(text: str) -> tuple[int, int, int, int, int, int] | None:
    """Read a box; none for an empty text. Raises UsageError."""
    if not text:
        return None
    try:
        x0, y0, z0, x1, y1, z1 = (int(word) for word in text.split(","))
    except ValueError:
        raise UsageError(f"--box is six whole numbers x0,y0,z0,x1,y1,z1, not {text!r}") from None
    if x0 >= x1 or y0 >= y1 or z0 >= z1:
        raise UsageError(f"--box ends after it begins on each axis; {text!r} does not")
    return x0, y0, z0, x1, y1, z1


def file_choice(image: str, depth: str, quality: int, per_metre: int) -> "FileFormats":
    """Read how layers become files. Raises UsageError."""
    from world2minecraft.rendering.output import FileFormats

    if image not in ("png", "jpg", "jpeg", "webp"):
        raise UsageError(f"--format is png, jpg or webp, not {image!r}")
    if depth not in ("png", "exr", "npy"):
        raise UsageError(f"--depth-format is png, exr or npy, not {depth!r}")
    if not 1 <= quality <= 100:
        raise UsageError(f"--quality is 1 to 100, not {quality}")
    if not 1 <= per_metre <= 65535:
        raise UsageError(f"--depth-scale is 1 to 65535, not {per_metre}")
    return FileFormats(f".{image}", f".{depth}", quality, per_metre)


def check_count(frames: int | None, rate_hz: float) -> None:
    """Check ``--frames`` and ``--fps``. Raises UsageError."""
    if frames is not None and not 1 <= frames <= MAX_FRAMES:
        raise UsageError(f"--frames is 1 to {MAX_FRAMES:,}, not {frames}")
    if not 1 <= rate_hz <= 240:
        raise UsageError(f"--fps is 1 to 240, not {rate_hz:g}")


def threads_of(asked: int | None) -> int:
    """Return how many threads to use. Raises UsageError."""
    from world2minecraft.core.machine import usable_cores

    if asked is None:
        return usable_cores()
    if not 1 <= asked <= 512:
        raise UsageError(f"--threads is 1 to 512, not {asked}")
    return asked
