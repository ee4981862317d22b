"""Choose the renderer: the CPU kernel or the GPU shader, behind one interface.

``auto`` takes a graphics card where there is one, and never a software adapter, which is slower
than the kernel. wgpu is imported only where there may be a GPU, or one was requested.
"""

import sys
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path
from typing import Protocol

import numpy as np

from world2minecraft.core.errors import MissingExtraError, UnknownNameError
from world2minecraft.core.types import Camera
from world2minecraft.rendering.gpu.device import GpuError, find_adapter, info_of
from world2minecraft.rendering.gpu.renderer import GpuRenderer
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.picture import (
    DEFAULT_OUTPUTS,
    Picture,
    render_parallel,
    render_volume,
)
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.shading_parameters import DAY, Backdrop

DEVICES = ("auto", "cpu", "gpu")
# On Linux a card shows itself as one of these files; the last is Windows' card within WSL.
_CARD_FILES = ("dri/render*", "nvidia[0-9]*", "nvidiactl", "kfd", "mali*", "dxg")


class Renderer(Protocol):
    """Takes pictures of one scene; the arguments are those of ``render_volume``."""

    @property
    def name(self) -> str:
        """What draws."""
        ...

    def render(
        self, camera: Camera, camera_to_room: np.ndarray, *,
        outputs: Collection[str] = DEFAULT_OUTPUTS, light: LightSettings = DAY, samples: int = 1,
        background: Backdrop | None = None,
    ) -> Picture:  # fmt: skip
        """Take a picture."""
        ...

    def render_many(
        self, camera: Camera, poses: Iterable[np.ndarray], *,
        outputs: Collection[str] = DEFAULT_OUTPUTS, light: LightSettings = DAY, samples: int = 1,
        background: Backdrop | None = None,
    ) -> Iterator[Picture]:  # fmt: skip
        """Take a picture from each pose, in their order."""
        ...

    def render_parallel(
        self, px_per_metre: float, size: tuple[int, int], camera_to_room: np.ndarray, *,
        outputs: Collection[str] = DEFAULT_OUTPUTS, light: LightSettings = DAY, samples: int = 1,
        background: Backdrop | None = None,
    ) -> Picture:  # fmt: skip
        """Take a picture by parallel rays."""
        ...

    def update(self, scene: BlockScene) -> None:
        """Draw another scene from now on, or the same after its blocks were changed."""
        ...

    def close(self) -> None:
        """Free what it holds."""
        ...


class CpuRenderer:
    """Draws one scene by the kernel; the methods are those of ``GpuRenderer``."""

    name = "CPU"

    def __init__(self, scene: BlockScene, threads: int = 1):
        """Draw a scene on some threads."""
        self._scene, self._threads = scene, threads

    def render(
        self, camera: Camera, camera_to_room: np.ndarray, *,
        outputs: Collection[str] = DEFAULT_OUTPUTS, light: LightSettings = DAY, samples: int = 1,
        background: Backdrop | None = None,
    ) -> Picture:  # fmt: skip
        """Take a picture; see ``render_volume``."""
        return render_volume(
            self._scene, camera, camera_to_room, outputs=outputs, light=light, samples=samples,
            threads=self._threads, background=background,
        )  # fmt: skip

    def render_many(
        self, camera: Camera, poses: Iterable[np.ndarray], *,
        outputs: Collection[str] = DEFAULT_OUTPUTS, light: LightSettings = DAY, samples: int = 1,
        background: Backdrop | None = None,
    ) -> Iterator[Picture]:  # fmt: skip
        """Take a picture from each pose, in their order."""
        for pose in poses:
            yield self.render(
                camera, pose, outputs=outputs, light=light, samples=samples, background=background
            )

    def render_parallel(
        self, px_per_metre: float, size: tuple[int, int], camera_to_room: np.ndarray, *,
        outputs: Collection[str] = DEFAULT_OUTPUTS, light: LightSettings = DAY, samples: int = 1,
        background: Backdrop | None = None,
    ) -> Picture:  # fmt: skip
        """Take a picture by parallel rays; see the function of that name."""
        return render_parallel(
            self._scene, px_per_metre, size, camera_to_room, outputs=outputs, light=light,
            samples=samples, threads=self._threads, background=background,
        )  # fmt: skip

    def update(self, scene: BlockScene) -> None:
        """Draw another scene from now on."""
        self._scene = scene

    def close(self) -> None:
        """Hold nothing."""


def choose_device(name: str = "auto") -> str:
    """Return ``cpu`` or ``gpu`` for a name of ``DEVICES``.

    Raises:
        UnknownNameError: there is no such name.
        MissingExtraError: gpu was requested and wgpu is not installed.
        GpuError: gpu was requested and no graphics card is found.
    """
    if name not in DEVICES:
        raise UnknownNameError("device", name, DEVICES)
    if name == "gpu":
        find_adapter()
        return "gpu"
    return "gpu" if name == "auto" and _has_card() else "cpu"


def renderer_for(
    device: str, scene: BlockScene, *, threads: int = 1, adapter: str | None = None
) -> Renderer:
    """Return what draws a scene.

    Args:
        device: a name of ``DEVICES``; with ``auto`` a world that is too large for the graphics
            card is drawn on the CPU.
        scene: ``prepare_scene`` of a volume.
        threads: of the CPU, for one picture.
        adapter: which graphics card: a part of its name, or ``software``.

    Raises: what ``choose_device`` and, with ``gpu``, ``GpuRenderer`` raise.
    """
    if device not in DEVICES:
        raise UnknownNameError("device", device, DEVICES)
    if device == "gpu":
        return GpuRenderer(scene, adapter=adapter)
    if choose_device(device) == "gpu":
        try:
            return GpuRenderer(scene)
        except GpuError:  # It does not fit.
            pass
    return CpuRenderer(scene, threads)


def _has_card() -> bool:
    """Tell whether there is a graphics card, and wgpu to use it."""
    if sys.platform == "linux" and not _shows_card(Path("/dev")):
        return False
    try:
        return not info_of(find_adapter()).is_software
    except (MissingExtraError, GpuError):
        return False


def _shows_card(devices: Path) -> bool:
    return any(True for pattern in _CARD_FILES for _ in devices.glob(pattern))
