"""What registration puts right in a scan: the pose and the depth scale of each frame."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from world2minecraft.core.types import checks


@dataclass(frozen=True, eq=False)
class Corrections:
    """One change a frame.

    ``pose_change`` float64 [F, 4, 4] is rigid, scan to scan, applied on the left of a frame's
    pose; ``depth_scale`` float64 [F] is what its depth is multiplied by. ``facts`` are the figures
    for ``scan.json``. A frame that is not among ``names`` stays as it is.
    """

    names: tuple[str, ...]
    pose_change: np.ndarray
    depth_scale: np.ndarray
    facts: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self):
        put = object.__setattr__
        names = tuple(str(name) for name in self.names)
        if len(set(names)) != len(names):
            raise ValueError("names must be distinct")
        change = checks.floats("pose_change", self.pose_change, (len(names), 4, 4))
        scale = checks.floats("depth_scale", self.depth_scale, (len(names),))
        if (scale <= 0).any():
            raise ValueError("depth_scale must be above 0")
        for name, one in zip(names, change, strict=True):
            checks.transform(f"pose_change of {name}", one)
        put(self, "names", names)
        put(self, "pose_change", change)
        put(self, "depth_scale", scale)
