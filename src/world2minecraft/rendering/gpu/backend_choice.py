"""The choice between the CPU kernel and the GPU shader, behind one interface.

``auto`` uses a GPU if there is one, but never a software adapter, which is slower than the CPU
kernel. wgpu is only imported if a GPU may be present or was requested.
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
    """A renderer of one scene, whose methods accept the arguments of ``render_volume``."""

    @property
    def name(self) -> str:
        """The name of the rendering device."""
        ...

    def render(
        self, camera: Camera, camera_to_room: np.ndarray, *,
        outputs: Collection[str] = DEFAULT_OUTPUTS, light: LightSettings = DAY, samples: int = 1,
        background: Backdrop | None = None,
    ) -> Picture:  # fmt: skip
        """Render an image."""
        ...

    def render_many(
        self, camera: Camera, poses: Iterable[np.ndarray], *,
        outputs: Collection[str] = DEFAULT_OUTPUTS, light: LightSettings = DAY, samples: int = 1,
        background: Backdrop | None = None,
    ) -> Iterator[Picture]:  # fmt: skip
        """Yield an image for each pose, in order."""
        ...

    def render_parallel(
        self, px_per_metre: float, size: tuple[int, int], camera_to_room: np.ndarray, *,
        outputs: Collection[str] = DEFAULT_OUTPUTS, light: LightSettings = DAY, samples: int = 1,
        background: Backdrop | None = None,
    ) -> Picture:  # fmt: skip
        """Render an orthographic image."""
        ...

    def update(self, scene: BlockScene) -> None:
        """Replace the scene to render; also call this after blocks of the scene have changed."""
        ...

    def close(self) -> None:
        """Release the memory of the renderer."""
        ...


class CpuRenderer:
    """A renderer that uses the CPU kernel, with the same methods as ``GpuRenderer``."""

    name = "CPU"

    def __init__(self, scene: BlockScene, threads: int = 1):
        """Create a renderer of a scene that uses a number of threads."""
        self._scene, self._threads = scene, threads

    def render(
        self, camera: Camera, camera_to_room: np.ndarray, *,
        outputs: Collection[str] = DEFAULT_OUTPUTS, light: LightSettings = DAY, samples: int = 1,
        background: Backdrop | None = None,
    ) -> Picture:  # fmt: skip
        """Render an image. See ``render_volume``."""
        return render_volume(
            self._scene, camera, camera_to_room, outputs=outputs, light=light, samples=samples,
            threads=self._threads, background=background,
        )  # fmt: skip

    def render_many(
        self, camera: Camera, poses: Iterable[np.ndarray], *,
        outputs: Collection[str] = DEFAULT_OUTPUTS, light: LightSettings = DAY, samples: int = 1,
        background: Backdrop | None = None,
    ) -> Iterator[Picture]:  # fmt: skip
        """Yield an image for each pose, in order."""
        for pose in poses:
            yield self.render(
                camera, pose, outputs=outputs, light=light, samples=samples, background=background
            )

    def render_parallel(
        self, px_per_metre: float, size: tuple[int, int], camera_to_room: np.ndarray, *,
        outputs: Collection[str] = DEFAULT_OUTPUTS, light: LightSettings = DAY, samples: int = 1,
        background: Backdrop | None = None,
    ) -> Picture:  # fmt: skip
        """Render an orthographic image. See ``rendering.picture.render_parallel``."""
        return render_parallel(
            self._scene, px_per_metre, size, camera_to_room, outputs=outputs, light=light,
            samples=samples, threads=self._threads, background=background,
        )  # fmt: skip

    def update(self, scene: BlockScene) -> None:
        """Switch to another scene."""
        self._scene = scene

    def close(self) -> None:
        """Do nothing, because this renderer has no resources to release."""


def choose_device(name: str = "auto") -> str:
    """Return ``cpu`` or ``gpu`` for a device name from ``DEVICES``.

    Raises:
        UnknownNameError: If the device name is unknown.
        MissingExtraError: If gpu is requested but wgpu is not installed.
        GpuError: If gpu is requested but no GPU is found.
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
    """Return a renderer for a scene.

    Args:
        device: A device name from ``DEVICES``. With ``auto``, a world that is too large for the GPU
            is rendered on the CPU.
        scene: The result of ``prepare_scene`` for a volume.
        threads: Number of CPU threads per image.
        adapter: GPU adapter to use: a part of its name, or ``software``.

    Raises:
        UnknownNameError: If the device name is unknown.
        MissingExtraError: If gpu is requested but wgpu is not installed.
        GpuError: If gpu is requested but cannot be used for this scene.
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
    """Return whether there is a graphics card, and wgpu to use it."""
    if sys.platform == "linux" and not _shows_card(Path("/dev")):
        return False
    try:
        return not info_of(find_adapter()).is_software
    except (MissingExtraError, GpuError):
        return False


def _shows_card(devices: Path) -> bool:
    return any(True for pattern in _CARD_FILES for _ in devices.glob(pattern))
