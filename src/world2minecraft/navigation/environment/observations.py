"""The observations of the environment: sensors, their spaces and their values."""

import string
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from gymnasium import spaces

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.navigation.moves import wrap_yaw
from world2minecraft.navigation.scene import VlnScene, camera_of
from world2minecraft.navigation.types import Stance
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.shading_parameters import DAY

SENSORS = ("rgb", "depth", "semantic", "instance", "pose", "instruction")
DEFAULT_SENSORS = ("rgb", "pose")  # Stable-Baselines3 does not support text spaces.
FORMER_SENSORS = ("rgb", "pose", "instruction")  # The default of version 0.1.
FAR_M = 1_000.0  # Maximum depth; the depth is 0 if a ray hits nothing.
MIN_TEXT_LENGTH = 512  # Minimum size of the text space, in characters.
MAX_SIDE_PX = 4_096
_RENDERED = {"rgb": "colour", "depth": "depth", "semantic": "semantic", "instance": "instance"}


@dataclass(frozen=True)
class Eyes:
    """The camera settings of an agent.

    Attributes:
        width_px: The image width in pixels.
        height_px: The image height in pixels.
        hfov_deg: The horizontal field of view in degrees, as in Habitat. Pixels are square.
        light: The lighting.
        threads: The number of rendering threads.
    """

    width_px: int = 224
    height_px: int = 224
    hfov_deg: float = 90.0
    light: LightSettings = DAY
    threads: int = 1

    def __post_init__(self):
        if not (1 <= self.width_px <= MAX_SIDE_PX and 1 <= self.height_px <= MAX_SIDE_PX):
            raise UsageError(
                f"image width and height must be 1 to {MAX_SIDE_PX} pixels, got "
                f"{self.width_px}x{self.height_px}"
            )
        if not 10 <= self.hfov_deg <= 150:
            raise UsageError(f"hfov_deg must be 10 to 150 degrees, got {self.hfov_deg:g}")


class SensorSuite:
    """The requested sensors over one scene."""

    def __init__(
        self, scene: VlnScene, names: Collection[str], eyes: Eyes, texts: Iterable[str] = ()
    ):
        for name in names:
            if name not in SENSORS:
                raise UnknownNameError("observation", name, SENSORS)
        if not names:
            raise UsageError(
                f"at least one observation is required; choose from {', '.join(SENSORS)}"
            )
        self.scene, self.eyes = scene, eyes
        self.names = tuple(name for name in SENSORS if name in names)
        self.camera = camera_of(eyes.width_px, eyes.height_px, eyes.hfov_deg)
        self._outputs = tuple(_RENDERED[name] for name in self.names if name in _RENDERED)
        self._texts = tuple(texts)

    @property
    def space(self) -> spaces.Dict:
        """The space of the observations that ``look`` returns."""
        return spaces.Dict({name: self._space(name) for name in self.names})

    def look(self, stance: Stance, instruction: str) -> dict[str, Any]:
        """Return the observation at a stance."""
        seen = self._seen(stance, self._outputs) if self._outputs else {}
        if "pose" in self.names:
            seen["pose"] = self.pose(stance)
        if "instruction" in self.names:
            seen["instruction"] = instruction
        return {name: seen[name] for name in self.names}

    def rgb(self, stance: Stance) -> np.ndarray:
        """Return the colour image at a stance as uint8 [H, W, 3]."""
        return self._seen(stance, ("colour",))["rgb"]

    def pose(self, stance: Stance) -> np.ndarray:
        """Return the pose as float32 [5]: feet in metres of the room, yaw and pitch."""
        x, y, z = self.scene.to_room_m(stance.feet)
        values = (x, y, z, wrap_yaw(stance.yaw_deg), stance.pitch_deg)
        return np.array(values, np.float32)

    def _seen(self, stance: Stance, outputs: tuple[str, ...]) -> dict[str, Any]:
        picture = self.scene.picture(
            stance,
            self.camera,
            outputs=outputs,
            light=self.eyes.light,
            threads=self.eyes.threads,
        )
        seen = {
            "rgb": picture.colour,
            "depth": np.minimum(picture.depth_m, np.float32(FAR_M))[..., None],
            "semantic": picture.semantic,
            "instance": picture.instance,
        }
        return {name: value for name, value in seen.items() if value is not None}

    def _space(self, name: str) -> spaces.Space:
        size = (self.eyes.height_px, self.eyes.width_px)
        if name == "pose":
            return self._pose_space()
        if name == "instruction":
            letters = set(string.printable).union(*self._texts)
            longest = max([MIN_TEXT_LENGTH, *map(len, self._texts)])
            return spaces.Text(longest, min_length=0, charset="".join(sorted(letters)))
        return {
            "rgb": spaces.Box(0, 255, (*size, 3), np.uint8),
            "depth": spaces.Box(0.0, FAR_M, (*size, 1), np.float32),
            "semantic": spaces.Box(0, 255, size, np.uint8),
            "instance": spaces.Box(0, 65_535, size, np.uint16),
        }[name]

    def _pose_space(self) -> spaces.Box:
        """Return the bounds of the pose: the build plus one metre, and all angles."""
        volume = self.scene.volume
        corners = np.array([volume.corner, np.add(volume.corner, volume.states.shape)], float)
        ends = self.scene.to_room_m(corners)
        low = np.concatenate([ends.min(axis=0) - 1, [-180.0, -90.0]]).astype(np.float32)
        high = np.concatenate([ends.max(axis=0) + 1, [180.0, 90.0]]).astype(np.float32)
        return spaces.Box(low, high, (5,), np.float32)
