"""Rendering settings: light, textures, path tracing and device."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from world2minecraft.core.errors import UsageError
from world2minecraft.rendering import DAY, BlockScene, LightSettings, Picture
from world2minecraft.rendering.block_elements import ModelSource, ModelSourceStack
from world2minecraft.rendering.block_models import BuiltinModels, stand_ins
from world2minecraft.rendering.path_tracing import emitters_of, render_photo
from world2minecraft.rendering.path_tracing.photo import MAX_SAMPLES as MAX_PHOTO_SAMPLES
from world2minecraft.rendering.picture_files.shot_selection import Kind, Medium
from world2minecraft.rendering.presentation.shot_rendering import DrawOptions, draw_shots
from world2minecraft.rendering.resource_packs import ResourcePackModels
from world2minecraft.rendering.shading_parameters import BACKDROP
from world2minecraft.rendering.texture import SIZES_PX
from world2minecraft.rendering.views import Shot

MAX_SAMPLES = 4
MAX_JOBS = 256
DEVICES = ("auto", "cpu", "gpu")
STILL_SAMPLES = 2
OWN_PX = 16  # As in the game.


@dataclass(frozen=True, eq=False)
class Looks:
    """A source of models and textures, with the texture size in pixels."""

    source: ModelSource
    side_px: int
    packs: ResourcePackModels | None = None

    def notes(self, palette: Sequence[str]) -> list[str]:
        """Return notes on block states without a model and on files that cannot be read."""
        drawn = palette
        if self.packs is not None:
            drawn = [state for state in palette if self.packs.model(state) is None]
        marked, notes = stand_ins(drawn), []
        if marked:
            share = len(marked) / len(palette)
            names = ", ".join(state.partition("[")[0] for state in marked[:3])
            more = " ..." if len(marked) > 3 else ""
            notes.append(
                f"{len(marked)} of {len(palette)} block states ({share:.1%}) have no model "
                f"and are rendered as plain boxes: {names}{more}"
            )
        if self.packs is not None and self.packs.summary:
            notes.append(self.packs.summary)
        return notes


@dataclass(frozen=True)
class DrawSettings:
    """The rendering settings. None leaves a choice to the view.

    Raises:
        UsageError: If a value is out of range, or if two settings cannot be combined.
    """

    light: str | None = None
    hour: float | None = None
    brightness: float = 0.5
    exposure: float | None = None
    sun_shadow: bool = False
    samples: int | None = None
    texture_px: int | None = None
    packs: tuple[Path, ...] = ()
    photo: bool = False
    photo_samples: int = 16
    device: str = "auto"
    threads: int = 1
    jobs: int = 1

    def __post_init__(self):
        if self.samples is not None and not 1 <= self.samples <= MAX_SAMPLES:
            raise UsageError(f"samples must be 1 to {MAX_SAMPLES}, got {self.samples}")
        if self.texture_px is not None and self.texture_px not in SIZES_PX:
            raise UsageError(f"the texture size must be 16, 32, 64 or 128, got {self.texture_px}")
        if not 1 <= self.photo_samples <= MAX_PHOTO_SAMPLES:
            raise UsageError(
                f"photo samples must be 1 to {MAX_PHOTO_SAMPLES:,}, got {self.photo_samples}"
            )
        if self.device not in DEVICES:
            raise UsageError(f"device must be auto, cpu or gpu, got {self.device!r}")
        if not 1 <= self.jobs <= MAX_JOBS:
            raise UsageError(f"jobs must be 1 to {MAX_JOBS}, got {self.jobs}")
        if self.jobs > 1 and (self.photo or self.device == "gpu"):
            other = "photo" if self.photo else "the device gpu"
            raise UsageError(f"jobs cannot be combined with {other}; remove one of them")

    def light_of(self, kind: Kind) -> LightSettings:
        """Return the light for a kind of view, which is neutral by default for a turntable.

        Raises:
            UsageError: If a number is out of range, or if the light preset is unknown.
        """
        asked = self.hour is not None or self.sun_shadow or self.exposure is not None
        usual = "neutral" if kind == "turntable" and not asked else DAY.preset
        try:
            return LightSettings(
                preset=self.light or usual,
                hour=DAY.hour if self.hour is None else self.hour % 24.0,
                exposure=self.exposure,
                brightness=self.brightness,
                sun_shadow=self.sun_shadow,
            )
        except ValueError as error:
            raise UsageError(f"light: {error}") from error

    def options_of(self, kind: Kind, medium: Medium, outputs: tuple[str, ...]) -> DrawOptions:
        """Return the rendering options. Single images use more rays than data sets."""
        usual = 1 if medium == "folder" and kind != "turntable" else STILL_SAMPLES
        # From above no sky is seen: the backdrop is plain, except where an hour is given.
        paper = BACKDROP if kind in ("orbit", "turntable") and self.hour is None else None
        light, samples = self.light_of(kind), self.samples or usual
        return DrawOptions(outputs, light, samples, self.threads, paper, self.device, self.jobs)

    def looks(self) -> Looks:
        """Return the resource packs, last one first, followed by the built-in models.

        Raises:
            InputError: If a resource pack cannot be read.
        """
        if not self.packs:
            side_px = self.texture_px or OWN_PX
            return Looks(BuiltinModels(side_px), side_px)

        packs = ResourcePackModels(self.packs)
        side_px = self.texture_px or packs.texture_px
        return Looks(ModelSourceStack((packs, BuiltinModels(side_px))), side_px, packs)


def take_pictures(
    scene: BlockScene,
    shots: Sequence[Shot],
    settings: DrawSettings,
    options: DrawOptions,
    step: Callable[[int], None],
) -> Iterator[Picture]:
    """Render the images of shots by ray casting or path tracing.

    Args:
        scene: The scene to render.
        shots: The shots.
        settings: The settings, which choose between ray casting and path tracing.
        options: Rendering options.
        step: Callback that receives 1 for each image, or for each sample per pixel of a path-traced
            image.

    Raises:
        UsageError: If the device is not available, or if the path tracer does not support an
            option.
    """
    if settings.photo:
        yield from _photos(scene, shots, settings, options, step)
        return
    for picture in draw_shots(scene, shots, options):
        step(1)
        yield picture


def _photos(
    scene: BlockScene, shots: Sequence[Shot], settings: DrawSettings, options: DrawOptions,
    step: Callable[[int], None],
) -> Iterator[Picture]:  # fmt: skip
    """Trace photos; the first one's exposure is that of all."""
    lamps, light = emitters_of(scene), options.light
    for shot in shots:
        reported = 0

        def report(stage: str, done: int, total: int, note: str = "") -> None:
            nonlocal reported
            step(done - reported)
            reported = done

        try:
            picture = render_photo(
                scene, shot.camera, shot.camera_to_room, light=light, emitters=lamps,
                samples=settings.photo_samples, threads=settings.threads, progress=report,
            )  # fmt: skip
        except ValueError as error:
            raise UsageError(f"photo: {error}") from error
        step(settings.photo_samples - reported)
        light = replace(light, exposure=min(max(picture.exposure, 0.01), 100.0))
        yield picture
