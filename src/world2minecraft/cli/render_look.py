"""How ``w2m render`` draws: the light, the textures, the tier and the device that words choose."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.errors import UsageError

if TYPE_CHECKING:
    from world2minecraft.cli.render_shots import Kind, Medium
    from world2minecraft.render import BlockScene, LookLight, Picture
    from world2minecraft.render.elements import LookSource
    from world2minecraft.render.views import DrawOptions, Shot
    from world2minecraft.types import BlockVolume

TEXTURES_PX = (16, 32, 64, 128)
MOST_SAMPLES = 4
DEVICES = ("auto", "cpu", "gpu")
MOST_PHOTO_SAMPLES = 65_536
PHOTO = "world2minecraft.render.photo"  # Loaded late: it compiles kernels of its own.
STILL_SAMPLES = 2


@dataclass(frozen=True)
class Look:
    """What the words choose; None where they leave it to the view."""

    light: str | None = None
    hour: float | None = None
    brightness: float = 0.5
    exposure: float | None = None
    sun_shadow: bool = False
    samples: int | None = None
    texture_px: int = 16
    packs: tuple[Path, ...] = ()
    photo: bool = False
    photo_samples: int = 16
    device: str = "auto"
    threads: int = 1

    def __post_init__(self):
        if self.samples is not None and not 1 <= self.samples <= MOST_SAMPLES:
            raise UsageError(f"--samples is 1 to {MOST_SAMPLES}, not {self.samples}")
        if self.texture_px not in TEXTURES_PX:
            raise UsageError(f"--textures is 16, 32, 64 or 128, not {self.texture_px}")
        if not 1 <= self.photo_samples <= MOST_PHOTO_SAMPLES:
            raise UsageError(
                f"--photo-samples is 1 to {MOST_PHOTO_SAMPLES:,}, not {self.photo_samples}"
            )
        if self.device not in DEVICES:
            raise UsageError(f"--device is auto, cpu or gpu, not {self.device!r}")
        if self.device == "gpu":
            raise UsageError("--device gpu is not in this version; leave it out to use the CPU")

    def light_of(self, kind: "Kind") -> "LookLight":
        """Return the light of a kind of view: a turntable stands in an even light of its own.

        Raises:
            UsageError: a number is out of range, or there is no such light.
        """
        from world2minecraft.render import DAY, LookLight

        asked = self.hour is not None or self.sun_shadow or self.exposure is not None
        usual = "neutral" if kind == "turntable" and not asked else DAY.preset
        try:
            return LookLight(
                preset=self.light or usual,
                hour=DAY.hour if self.hour is None else self.hour % 24.0,
                exposure=self.exposure,
                brightness=self.brightness,
                sun_shadow=self.sun_shadow,
            )
        except ValueError as error:
            raise UsageError(f"no such light: {error}") from error

    def options_of(self, kind: "Kind", medium: "Medium", outputs: tuple[str, ...]) -> "DrawOptions":
        """Return how pictures are drawn; lone pictures get more rays than those of a data set."""
        from world2minecraft.render.lamps import PAPER
        from world2minecraft.render.views import DrawOptions

        usual = 1 if medium == "folder" and kind != "turntable" else STILL_SAMPLES
        # From above one sees no sky; a build stands out best on paper, but not at night.
        paper = PAPER if kind == "orbit" and self.hour is None else None
        light, samples = self.light_of(kind), self.samples or usual
        return DrawOptions(outputs, light, samples, self.threads, paper)

    def looks(self) -> "LookSource | None":
        """Return the user's packs before our own looks; None for our own alone.

        Raises:
            InputError: a pack cannot be read.
        """
        if not self.packs:
            return None
        from world2minecraft.render.elements import LookStack
        from world2minecraft.render.packs import PackLooks
        from world2minecraft.render.plain_looks import PlainLooks

        return LookStack((PackLooks(self.packs), PlainLooks()))


def take(
    scene: "BlockScene",
    volume: "BlockVolume",
    shots: "Sequence[Shot]",
    look: Look,
    options: "DrawOptions",
) -> "Iterator[Picture]":
    """Take the pictures of shots, by the tier that the look names.

    Raises:
        UsageError: this version has no such tier.
    """
    from world2minecraft.render.views import frames_of

    if not look.photo:
        return frames_of(scene, shots, options)
    try:
        render_photo = import_module(PHOTO).render_photo
    except ImportError:
        raise UsageError("--photo is not in this version; leave it out") from None
    return render_photo(scene, volume, shots, samples=look.photo_samples, options=options)
