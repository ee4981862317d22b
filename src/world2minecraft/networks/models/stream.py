"""A stream of frames into one scene's grid, by the embodied network.

The box of cells that a frame is looked at lies before its camera, turned to it by quarter turns, on
the scene's own cells: so nothing is resampled when its evidence is added.
"""

import math
from dataclasses import dataclass
from itertools import product

import torch
from torch import Tensor, nn

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.networks.batch import OccInput
from world2minecraft.networks.models.embodied import Embodied
from world2minecraft.networks.models.evidence import FEATURES_AT, SceneEvidence

BELOW_M = 1.6  # How far under a camera its box begins: the floor under a person's eyes.


@dataclass(frozen=True)
class Window:
    """The box of cells before a camera: quarter turns, and where its lowest cell lies."""

    quarters: int  # counter-clockwise from above; 0 looks along the scene's y
    low: tuple[int, int, int]  # cells of the scene: the corner of the turned box
    shape: tuple[int, int, int]  # in the frame's own order: right, forward, up

    def box_to_scene(self, voxel_m: float) -> Tensor:
        """Return 4x4: metres from the box's own minimum corner to metres of the scene."""
        right, ahead, _ = self.shape
        matrix = torch.eye(4, dtype=torch.float64)
        cosine, sine = ((1, 0), (0, 1), (-1, 0), (0, -1))[self.quarters]
        matrix[0, :2] = torch.tensor([cosine, -sine])
        matrix[1, :2] = torch.tensor([sine, cosine])
        moved = ((0, 0), (ahead, 0), (right, ahead), (0, right))[self.quarters]
        for axis in range(3):
            cells = self.low[axis] + (moved[axis] if axis < 2 else 0)
            matrix[axis, 3] = cells * voxel_m
        return matrix


def window_before(camera_to_scene: Tensor, shape: tuple[int, int, int], voxel_m: float) -> Window:
    """Return the box before a camera [4, 4], metres from the minimum corner of the scene's grid."""
    ahead_x, ahead_y = (float(value) for value in camera_to_scene[:2, 2])
    quarters = round(math.atan2(-ahead_x, ahead_y) / (math.pi / 2)) % 4
    right, ahead, _ = shape
    x, y, z = (float(value) / voxel_m for value in camera_to_scene[:3, 3])
    low = (
        (x - right / 2, y),
        (x - ahead, y - right / 2),
        (x - right / 2, y - ahead),
        (x, y - right / 2),
    )[quarters]
    floor = round(z - BELOW_M / voxel_m)
    return Window(quarters, (round(low[0]), round(low[1]), floor), shape)


class SceneStream:
    """Adds frames to the evidence of one scene, and reads it.

    Args:
        network: an embodied network; it is put into evaluation.
        scene_shape: X, Y, Z of the scene.
        box_shape: of the box before each camera: cells to the right, forward and up.
        voxel_m: the cells' side, metres.
    """

    def __init__(
        self,
        network: Embodied,
        scene_shape: tuple[int, int, int],
        box_shape: tuple[int, int, int],
        voxel_m: float,
    ):
        self.network = network.eval()
        self.box_shape, self.voxel_m = box_shape, voxel_m
        where = next(network.parameters()).device
        self._values = torch.zeros(1, FEATURES_AT + network.features, *scene_shape, device=where)

    @property
    def evidence(self) -> SceneEvidence:
        """All that was said so far."""
        return SceneEvidence(self._values)

    @torch.no_grad()
    def add(
        self,
        image: Tensor,
        intrinsics: Tensor,
        camera_to_scene: Tensor,
        depth_m: Tensor | None = None,
    ) -> None:
        """Look at a frame.

        Args:
            image: float32 [3, H, W], 0 to 1.
            intrinsics: [3, 3].
            camera_to_scene: [4, 4], metres from the minimum corner of the scene's grid.
            depth_m: float32 [H, W], 0 where there is none.
        """
        window = window_before(camera_to_scene, self.box_shape, self.voxel_m)
        scene_to_box = torch.linalg.inv(window.box_to_scene(self.voxel_m))
        camera_to_box = (scene_to_box @ camera_to_scene.double().cpu()).float()
        inputs = OccInput(
            image[None],
            intrinsics[None].float(),
            camera_to_box[None],
            self.box_shape,
            self.voxel_m,
            None if depth_m is None else depth_m[None],
        ).to(self._values.device)
        told, _ = self.network.observe(inputs)
        self._put(torch.rot90(told.values, window.quarters, (2, 3)), window.low)

    @torch.no_grad()
    def logits(self) -> Tensor:
        """Return float32 [12, X, Y, Z] of the whole scene.

        It is read in boxes as large as those of the frames, which is what the network knows, each
        overlapping the next by half; the nearer to a middle, the more it counts.
        """
        sides = [max(w, b) for w, b in zip(self._values.shape[2:], self.box_shape, strict=True)]
        missing = [side - have for side, have in zip(sides, self._values.shape[2:], strict=True)]
        values = nn.functional.pad(self._values, (0, missing[2], 0, missing[1], 0, missing[0]))
        said = values.new_zeros(CLASS_COUNT, *sides)
        weights = values.new_zeros(sides)
        near = _nearness(self.box_shape).to(values)
        starts = (_starts(side, box) for side, box in zip(sides, self.box_shape, strict=True))
        for low in product(*starts):
            box = tuple(slice(a, a + n) for a, n in zip(low, self.box_shape, strict=True))
            here = SceneEvidence(values[(slice(None), slice(None), *box)])
            said[(slice(None), *box)] += self.network.read(here)[0] * near
            weights[box] += near
        x, y, z = self._values.shape[2:]
        return (said / weights)[:, :x, :y, :z]

    def _put(self, told: Tensor, low: tuple[int, int, int]) -> None:
        scene, box = [], []
        for start, side, whole in zip(low, told.shape[2:], self._values.shape[2:], strict=True):
            first, last = max(start, 0), max(min(start + side, whole), start, 0)
            scene.append(slice(first, last))
            box.append(slice(first - start, last - start))
        self._values[(slice(None), slice(None), *scene)] += told[(slice(None), slice(None), *box)]


def _starts(whole: int, side: int) -> list[int]:
    """Return where boxes begin along an axis, so that each overlaps the next by half or more.

    >>> _starts(30, 30), _starts(50, 20)
    ([0], [0, 10, 20, 30])
    """
    return sorted({min(start, whole - side) for start in range(0, whole, max(side // 2, 1))})


def _nearness(shape: tuple[int, int, int]) -> Tensor:
    """Return how near each cell of a box is to its middle, 1 to almost 0 at the rim."""
    along = [1 - (torch.arange(side) + 0.5 - side / 2).abs() / (side / 2 + 0.5) for side in shape]
    return along[0][:, None, None] * along[1][:, None] * along[2]
