"""A box room that is rendered exactly, to be written as captures and aligned."""

from dataclasses import dataclass, field

import numpy as np
import pytest

from world2minecraft.core.coordinates import look_at
from world2minecraft.core.types import Camera, View

CAMERA = Camera(160, 120, 130.0, 130.0, 80.0, 60.0)


@dataclass
class BoxRoom:
    """An empty box with solid boxes in it (x0 y0 z0 x1 y1 z1), in metres."""

    size_m: tuple[float, float, float] = (4.2, 3.1, 2.6)
    boxes: list[tuple[float, ...]] = field(
        default_factory=lambda: [
            (1.4, 1.2, 0.68, 2.6, 2.0, 0.72),  # A table's top,
            (1.4, 1.2, 0.0, 1.46, 1.26, 0.68),  # its legs,
            (2.54, 1.94, 0.0, 2.6, 2.0, 0.68),
            (0.0, 0.6, 0.0, 0.6, 2.2, 0.9),  # a counter,
            (3.7, 0.0, 0.0, 4.2, 1.0, 2.0),  # and a wardrobe.
        ]
    )

    def render(self, camera_to_room: np.ndarray, camera: Camera = CAMERA):
        """Return z-depth float32 [H, W] and colour uint8 [H, W, 3], by one ray a pixel."""
        v, u = np.mgrid[: camera.height_px, : camera.width_px]
        rays = np.stack(
            [
                (u + 0.5 - camera.cx_px) / camera.fx_px,
                (v + 0.5 - camera.cy_px) / camera.fy_px,
                np.ones(u.shape),
            ],
            axis=-1,
        ).reshape(-1, 3)
        directions = rays @ camera_to_room[:3, :3].T
        eye = camera_to_room[:3, 3]
        with np.errstate(divide="ignore", invalid="ignore"):
            sides = [(np.zeros(3), np.array(self.size_m))]
            sides += [(np.array(box[:3]), np.array(box[3:])) for box in self.boxes]
            depth = np.full(len(rays), np.inf)
            which = np.zeros(len(rays), np.int64)
            for index, (low, high) in enumerate(sides):
                to_low, to_high = (low - eye) / directions, (high - eye) / directions
                enter = np.minimum(to_low, to_high)
                leave = np.maximum(to_low, to_high)
                if index == 0:
                    hit, face = leave.min(axis=1), leave.argmin(axis=1)
                else:
                    hit, face = enter.max(axis=1), enter.argmax(axis=1)
                    hit = np.where((hit < leave.min(axis=1)) & (hit > 1e-6), hit, np.inf)
                nearer = hit < depth
                depth[nearer] = hit[nearer]
                which[nearer] = (index * 3 + face)[nearer]
        palette = np.random.default_rng(5).integers(30, 226, (100, 3)).astype(np.uint8)
        shape = (camera.height_px, camera.width_px)
        return depth.reshape(shape).astype(np.float32), palette[which].reshape(*shape, 3)

    def poses(self, count: int = 12) -> list[np.ndarray]:
        """Return camera_to_room of a walk that looks at every wall, floor and ceiling."""
        middle = np.array(self.size_m) / 2
        found = []
        for index in range(count):
            angle = 2 * np.pi * index / count
            away = np.array([np.cos(angle), np.sin(angle), 0.0])
            eye = np.array([*middle[:2], 1.5]) - 0.25 * middle * away
            down = (-0.9, -0.3, 0.45)[index % 3]
            found.append(look_at(eye, eye + away + [0, 0, down]))
        return found

    def views(
        self,
        count: int = 12,
        room_to_scan: np.ndarray | None = None,
        noise_seed: int | None = None,
    ) -> list[View]:
        """Return views in a scan frame; with a seed, with the noise of a depth camera."""
        room_to_scan = np.eye(4) if room_to_scan is None else room_to_scan
        rng = np.random.default_rng(noise_seed)
        views = []
        for index, pose in enumerate(self.poses(count)):
            depth, colour = self.render(pose)
            if noise_seed is not None:
                sigma = 0.0012 + 0.0019 * (depth - 0.4) ** 2
                depth = depth + (rng.standard_normal(depth.shape) * sigma).astype(np.float32)
                depth[rng.random(depth.shape) < 0.02] = 0
            views.append(View(f"{index:06d}", room_to_scan @ pose, colour, CAMERA, depth, CAMERA))
        return views


@pytest.fixture(scope="session")
def box_room() -> BoxRoom:
    return BoxRoom()
