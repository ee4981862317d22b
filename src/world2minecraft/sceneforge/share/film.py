"""The film of a room that comes together: points, cells, things, blocks, and a look around.

The camera stands still until all blocks are there. Points are samples of the surface cells of the
reconstruction, in the colours that the photos gave them.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from world2minecraft.core.classes import CLASS_COLOURS, CLASS_COUNT, SemanticClass
from world2minecraft.core.coordinates import apply, cell_centers_m, invert_rigid
from world2minecraft.core.errors import InputError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Camera, ObjectInstance
from world2minecraft.core.vocabulary import object_title
from world2minecraft.evaluation.report.finished_run import read_built
from world2minecraft.formats.objects_and_placements import read_objects
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.geometry.morphology import erode_faces
from world2minecraft.rendering.output.animation import animation_writer
from world2minecraft.rendering.presentation.film import PAPER, RoomStage, with_caption
from world2minecraft.rendering.presentation.opened_room import OpenedBuild

SIZE_PX, RATE_HZ = (640, 400), 10
FIRST_S, POINTS_S, CELLS_S, BLOCKS_S, TURN_S, HOLD_S = 0.8, 1.6, 1.4, 1.6, 2.4, 0.8
THING_S, MIN_THINGS_S, MAX_THINGS_S = 0.3, 1.2, 4.0
TURN_DEG = 34.0
POINTS_PER_CELL, POINT_PX = 5, 2
# Cells that no thing has claimed yet, by class: warm floors, light walls, grey for the rest.
PALE = np.full((CLASS_COUNT, 3), (204, 207, 212), np.uint8)
PALE[SemanticClass.FLOOR] = (203, 190, 172)
PALE[SemanticClass.WALL] = (226, 224, 218)
PALE[SemanticClass.WINDOW] = (205, 222, 235)
VIVID = np.array(
    [
        (230, 111, 81), (42, 157, 143), (233, 196, 106), (69, 123, 157), (181, 101, 167),
        (96, 170, 86), (214, 84, 112), (84, 110, 200), (244, 162, 97), (72, 181, 205),
    ],
    np.uint8,
)  # fmt: skip


def write_film(run: Path, out: Path, progress: Progress = no_progress) -> int:
    """Write the film of a run, and return its number of frames.

    Args:
        run: Run folder.
        out: File to write, with a suffix of ``animation_writer``.
        progress: Callback that reports the frames.

    Raises:
        InputError: If the folder is not a run with a build.
        MissingExtraError: If ffmpeg is needed and not installed.
        OutputError: If the file cannot be written.
    """
    if not (run / "room.npz").is_file():
        raise InputError(run, "has no room.npz; a film needs a reconstruction, a page does not")
    film = RoomFilm.read(run)
    progress("film", 0, film.length)
    count = 0
    with animation_writer(out, RATE_HZ) as write:
        for frame in film.frames():
            write(frame)
            count += 1
            progress("film", count, film.length)
    return count


@dataclass(frozen=True, eq=False)
class RoomFilm:
    """The film of one room."""

    stage: RoomStage
    objects: tuple[ObjectInstance, ...]

    @classmethod
    def read(cls, run: Path, size_px: tuple[int, int] = SIZE_PX) -> "RoomFilm":
        """Read a run.

        Raises:
            InputError: If a file of the run is missing or damaged.
        """
        grid, _ = read_room(run / "room.npz")
        place = run / "objects.json"
        objects = read_objects(place, grid) if place.is_file() else ()
        return cls(RoomStage(OpenedBuild(read_built(run / "build")), grid, size_px), objects)

    @property
    def length(self) -> int:
        """The number of frames."""
        parts_s = (FIRST_S, POINTS_S, CELLS_S, self._things_s, BLOCKS_S, TURN_S, HOLD_S)
        return sum(map(_frames_of, parts_s))

    def frames(self) -> Iterator[np.ndarray]:
        """Yield the frames, uint8 [H, W, 3]."""
        finished = self._blocks[0]
        for _ in range(_frames_of(FIRST_S)):
            yield finished  # Where only the first frame is shown, it is the room.
        yield from self._point_frames()
        yield from self._cell_frames()
        yield from self._thing_frames()
        yield from self._block_frames()
        last = finished
        for pose in self._poses[1:]:
            last = self.stage.blocks(pose)[0]
            yield last
        for _ in range(_frames_of(HOLD_S) + 1):
            yield last

    @cached_property
    def _poses(self) -> list[np.ndarray]:
        return self.stage.turning_poses(_frames_of(TURN_S), TURN_DEG)

    @property
    def _pose(self) -> np.ndarray:
        return self._poses[0]

    @cached_property
    def _labels(self) -> np.ndarray:
        return self.stage.opened_labels(self._pose)

    @cached_property
    def _blocks(self) -> tuple[np.ndarray, np.ndarray]:
        return self.stage.blocks(self._pose)

    @property
    def _things_s(self) -> float:
        return min(max(THING_S * len(self.objects), MIN_THINGS_S), MAX_THINGS_S)

    @cached_property
    def _points(self) -> tuple[np.ndarray, np.ndarray]:
        """The points in metres, float64 [N, 3], with their colours, uint8 [N, 3], as they appear.

        A sweep around the middle of the room, as of someone who turns with a phone.
        """
        grid, rng = self.stage.grid, np.random.default_rng(0)
        filled = self._labels > 0
        cells = np.argwhere(filled & ~erode_faces(filled))
        cells = np.repeat(cells, POINTS_PER_CELL, axis=0)
        points = cell_centers_m(cells, grid.origin_m, grid.voxel_m)
        points += rng.uniform(-0.5, 0.5, points.shape) * grid.voxel_m
        at = tuple(cells.T)
        colours = grid.colour[at].reshape(-1, 3)
        seen = colours.max(axis=1, keepdims=True, initial=0) > 0
        colours = np.where(seen, colours, np.array(CLASS_COLOURS)[self._labels[at]])
        away = points - points.mean(axis=0) if len(points) else points
        angle = np.arctan2(away[:, 1], away[:, 0]) + rng.normal(0, 0.25, len(points))
        order = np.argsort(angle)
        return points[order], colours[order].astype(np.uint8)

    def _point_frames(self) -> Iterator[np.ndarray]:
        points, colours = self._points
        for share in _shares(POINTS_S):
            count = round(len(points) * share)
            frame = splat(points[:count], colours[:count], self.stage.camera, self._pose)
            yield with_caption(frame, "points")

    def _cell_frames(self) -> Iterator[np.ndarray]:
        points = splat(*self._points, self.stage.camera, self._pose)
        filled = np.flatnonzero((self._labels > 0).any(axis=(0, 1)))
        low, high = (int(filled[0]), int(filled[-1])) if len(filled) else (0, 0)
        for share in _shares(CELLS_S):
            labels = self._labels.copy()
            labels[:, :, round(low + share * (high + 1 - low)) :] = 0
            frame, depth_m = self.stage.cells(self._pose, labels)
            yield with_caption(np.where(depth_m[..., None] > 0, frame, points), "cells")

    @cached_property
    def _things(self) -> list[ObjectInstance]:
        """The things, the largest first."""
        return sorted(self.objects, key=lambda one: -float(np.prod(one.size_m)))

    def _colours(self, count: int) -> np.ndarray:
        """Return the colour of each cell when so many things have appeared, uint8 [X, Y, Z, 3]."""
        colours = PALE[self._labels]
        for number, thing in enumerate(self._things[:count]):
            colours[self.stage.grid.instance == thing.id] = VIVID[number % len(VIVID)]
        return colours

    def _thing_frames(self) -> Iterator[np.ndarray]:
        for share in _shares(self._things_s):
            count = round(share * len(self._things))
            last = self._things[count - 1] if count else None
            text = object_title(last.name, last.class_id) if last else "things"
            frame, _ = self.stage.cells(self._pose, self._labels, self._colours(count))
            yield with_caption(frame, text)

    def _block_frames(self) -> Iterator[np.ndarray]:
        """Let the blocks take the place of the cells, from the floor up."""
        colours = self._colours(len(self._things))
        cells, cell_depth_m = self.stage.cells(self._pose, self._labels, colours)
        blocks, block_depth_m = self._blocks
        depth_m = np.where(block_depth_m > 0, block_depth_m, cell_depth_m)
        height_m = heights_m(depth_m, self.stage.camera, self._pose)
        seen = height_m[depth_m > 0]
        low, high = (float(seen.min()), float(seen.max())) if len(seen) else (0.0, 1.0)
        for share in _shares(BLOCKS_S):
            built = height_m <= low + share * (high - low) + 1e-6
            yield with_caption(np.where(built[..., None], blocks, cells), "blocks")


def splat(
    points_m: np.ndarray, colours: np.ndarray, camera: Camera, pose: np.ndarray
) -> np.ndarray:
    """Return a frame of points, each a small square, the nearer ones in front.

    Args:
        points_m: Points in the room frame, float64 [N, 3].
        colours: Their colours, uint8 [N, 3].
        camera: Camera of the frame.
        pose: Camera-to-room transform.
    """
    frame = np.full((camera.height_px, camera.width_px, 3), PAPER, np.uint8)
    seen = apply(invert_rigid(pose), points_m)
    ahead = seen[:, 2] > 1e-3
    seen, painted = seen[ahead], colours[ahead]
    order = np.argsort(-seen[:, 2])
    seen, painted = seen[order], painted[order]
    across = camera.fx_px * seen[:, 0] / seen[:, 2] + camera.cx_px
    down = camera.fy_px * seen[:, 1] / seen[:, 2] + camera.cy_px
    for right in range(POINT_PX):
        for under in range(POINT_PX):
            x = np.floor(across).astype(np.int64) + right
            y = np.floor(down).astype(np.int64) + under
            inside = (x >= 0) & (x < camera.width_px) & (y >= 0) & (y < camera.height_px)
            frame[y[inside], x[inside]] = painted[inside]
    return frame


def heights_m(depth_m: np.ndarray, camera: Camera, pose: np.ndarray) -> np.ndarray:
    """Return the height of what each pixel shows in the room frame, float64 [H, W].

    Args:
        depth_m: z-depth, [H, W].
        camera: Camera of the frame.
        pose: Camera-to-room transform.
    """
    rows, columns = np.mgrid[: camera.height_px, : camera.width_px]
    across = (columns + 0.5 - camera.cx_px) / camera.fx_px
    down = (rows + 0.5 - camera.cy_px) / camera.fy_px
    return (pose[2, 0] * across + pose[2, 1] * down + pose[2, 2]) * depth_m + pose[2, 3]


def _frames_of(seconds: float) -> int:
    return max(round(seconds * RATE_HZ), 2)


def _shares(seconds: float) -> np.ndarray:
    """Return the shares of a part that each of its frames shows, the last one all of it."""
    count = _frames_of(seconds)
    return np.arange(1, count + 1) / count
