"""The paper's figures for a run: photos beside the reconstruction, and a walk.

Each row shows a photo, the world from the same pose, the predicted cells in class colours, and the
construction, the latter two from outside without the ceiling and near walls. If a walk is given, a
strip below shows the views of its agent.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from world2minecraft.capture.images import read_colour
from world2minecraft.core.classes import CLASS_COLOURS, OBJECT_CLASSES, UNKNOWN
from world2minecraft.core.coordinates import grid_to_block_axes
from world2minecraft.core.errors import CaptureError, InputError
from world2minecraft.core.types import AIR, BlockVolume, Camera, OccupancyGrid
from world2minecraft.evaluation.report.finished_run import read_built
from world2minecraft.evaluation.report.placed_frames import (
    PlacedFrame,
    judge_capture_of,
    placed_frames,
    used_by,
)
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.geometry.undistort import pinhole_camera, undistort_image
from world2minecraft.navigation.running.simulator import SceneSimulator
from world2minecraft.navigation.running.trace import (
    TRACE_FILE,
    VIEWS_FOLDER,
    read_trace,
    stances_of,
    traces_in,
)
from world2minecraft.navigation.scene import open_scene
from world2minecraft.rendering.picture import render_volume
from world2minecraft.rendering.presentation.opened_room import OpenedBuild
from world2minecraft.rendering.presentation.shot_rendering import DrawOptions, draw_shots
from world2minecraft.rendering.presentation.turntable import OPEN_ELEVATION_DEG
from world2minecraft.rendering.scene import BlockScene, prepare_scene
from world2minecraft.rendering.shading_parameters import BACKDROP, NEUTRAL
from world2minecraft.rendering.views.cameras import camera_of
from world2minecraft.rendering.views.orbit import orbit_shots

VIEWS, STEPS = 3, 6  # Rows, and pictures of a walk.
CELL_PX = (480, 360)
HEAD_PX, GAP_PX = 34, 8
SCOUT_PX = (64, 48)
FOV_DEG = 30.0
HEADS = ("Reality", "Minecraft", "Prediction", "Construction")
MATTER = "minecraft:white_concrete"  # Takes the light; its colour comes from the class.


def views_of_walk(run: Path, walk: Path, most: int) -> list[np.ndarray]:
    """Return the views of an agent's walk, including the first and the last.

    Recorded views are used if the agent had any. Otherwise, as for the oracle, the views are
    rendered from the recorded positions.

    Args:
        run: The reconstruction in which the agent walked.
        walk: The folder of a single walk of ``w2m vln run``.
        most: The maximum number of views.

    Returns:
        The views as uint8 [H, W, 3].

    Raises:
        InputError: If the folder contains no walk, or several.
        DamagedFileError: If the trace is invalid.
    """
    kept = sorted((walk / VIEWS_FOLDER).glob("*.jpg"))
    if kept:
        return [read_colour(kept[n]) for n in spread(len(kept), most)]
    traces = traces_in(walk)
    if not traces[0].is_file():
        raise InputError(walk, "no recorded walk found; give a folder written by w2m vln run")
    if traces[0].parent != walk:
        raise InputError(
            walk,
            f"the folder contains {len(traces)} walks; give one of them, such as "
            f"{traces[0].parent}",
        )
    stances = stances_of(read_trace(walk / TRACE_FILE), walk / TRACE_FILE)
    ground = SceneSimulator(open_scene(run))
    return [ground.view(stances[n]) for n in spread(len(stances), most)]


def spread(count: int, most: int) -> Sequence[int]:
    """Return up to ``most`` evenly spaced indices below ``count``, with the first and last.

    Example:
        >>> spread(10, 4)
        [0, 3, 6, 9]
        >>> spread(2, 4)
        [0, 1]
    """
    taken = min(count, most)
    return [n * (count - 1) // max(taken - 1, 1) for n in range(taken)]


Pixels = np.ndarray  # uint8 [H, W, 3]


def reconstruction_figure(run: Path, capture: Path, walk: Path | None = None) -> Pixels:
    """Return the figure of a reconstruction as uint8 [H, W, 3].

    Args:
        run: The folder of a finished reconstruction.
        capture: The capture that was reconstructed.
        walk: The folder of a ``w2m vln run``, whose views are shown below.

    Raises:
        CaptureError: If the capture has no posed photo that the run used.
        InputError: If a file is missing or damaged.
    """
    grid, scan_to_room = read_room(run / "room.npz")
    built = read_built(run / "build")
    scene = prepare_scene(built)
    photos = _photos(run, capture, scan_to_room, scene)
    start_deg = OpenedBuild(built).best_start_deg(OPEN_ELEVATION_DEG)
    columns = [
        [photo for photo, _, _ in photos],
        [_drawn(scene, camera, pose) for _, camera, pose in photos],
        [_coloured(*pair) for pair in _outside(volume_of_cells(grid), start_deg)],
        [colour for colour, _ in _outside(built, start_deg)],
    ]
    rows = [[_fitted(column[n], CELL_PX) for column in columns] for n in range(len(photos))]
    strip = _strip(run, walk, len(HEADS)) if walk is not None else []
    return _page(rows, strip)


def volume_of_cells(grid: OccupancyGrid) -> BlockVolume:
    """Convert occupied cells to white blocks with their classes, for rendering."""
    occupied = (grid.labels != 0) & (grid.labels != UNKNOWN)
    labels = np.where(occupied, grid.labels, 0).astype(np.uint8)
    turned = [grid_to_block_axes(one) for one in (labels, grid.instance)]
    side, deep = grid.voxel_m, grid.labels.shape[1]
    block_to_room = np.eye(4)
    block_to_room[:3, :3] = [[side, 0, 0], [0, 0, -side], [0, side, 0]]
    block_to_room[:3, 3] = grid.origin_m + np.array([0, deep * side, 0])
    states = (turned[0] != 0).astype(np.uint16)
    return BlockVolume(states, (AIR, MATTER), turned[0], turned[1], (0, 0, 0), block_to_room)


def _photos(
    run: Path, capture: Path, scan_to_room: np.ndarray, scene: BlockScene
) -> list[tuple[Pixels, Camera, np.ndarray]]:
    """Return the photo that shows the most objects in each third of the frames."""
    frames = placed_frames(run, judge_capture_of(run, capture), scan_to_room)
    is_told = bool(used_by(run))
    placed = [(path, one) for one in frames if is_told and (path := one.frame.colour_path)]
    if not placed:
        raise CaptureError(
            capture, f"no posed photo found among those that {run.name} was reconstructed from"
        )
    count = min(VIEWS, len(placed))
    edges = [n * len(placed) // count for n in range(count + 1)]
    found = []
    for start, end in pairwise(edges):
        path, best = max(placed[start:end], key=lambda one: _shown(scene, one[1]))
        small = pinhole_camera(best.camera, CELL_PX[0])
        colour = undistort_image(read_colour(path), best.camera, small)
        found.append((colour, small, best.camera_to_room))
    return found


def _shown(scene: BlockScene, one: PlacedFrame) -> int:
    """Return the number of object pixels in a small rendering from a frame's pose."""
    tiny = one.camera.resized(SCOUT_PX[0], SCOUT_PX[1])
    picture = render_volume(scene, tiny, one.camera_to_room, outputs=("semantic",))
    semantic = _present(picture.semantic)
    return int(np.isin(semantic, OBJECT_CLASSES).sum())


def _drawn(scene: BlockScene, camera: Camera, pose: np.ndarray) -> Pixels:
    picture = render_volume(scene, camera, pose, light=NEUTRAL, samples=2)
    return _present(picture.colour)


def _outside(volume: BlockVolume, start_deg: float) -> Iterator[tuple[Pixels, np.ndarray]]:
    """Render the volume from several sides at double size, with the class of each pixel."""
    build = OpenedBuild(volume)
    camera = camera_of(2 * CELL_PX[0], 2 * CELL_PX[1], vertical_fov_deg=FOV_DEG)
    shots = orbit_shots(
        build.whole, camera, VIEWS, elevation_deg=OPEN_ELEVATION_DEG, start_deg=start_deg
    )
    how = DrawOptions(outputs=("colour", "semantic"), light=NEUTRAL, background=BACKDROP)
    for shot in shots:
        scene = prepare_scene(build.seen_by(shot.camera_to_room))
        picture = next(iter(draw_shots(scene, [shot], how)))
        yield _present(picture.colour), _present(picture.semantic)


def _coloured(colour: Pixels, semantic: np.ndarray) -> Pixels:
    """Tint white blocks with their class colours, preserving light and shade."""
    table = np.array(CLASS_COLOURS, np.float32) / 255
    known = np.where(semantic < len(table), semantic, 0)
    return np.rint(colour * table[known]).astype(np.uint8)


def _present(pixels: np.ndarray | None) -> np.ndarray:
    if pixels is None:
        raise RuntimeError("the renderer returned no image")
    return pixels


def _strip(run: Path, walk: Path, across: int) -> list[Pixels]:
    """Return the views of a walk, scaled to fill the width of the page."""
    width = (across * (CELL_PX[0] + GAP_PX) - GAP_PX * STEPS) // STEPS
    size = (width, width * CELL_PX[1] // CELL_PX[0])
    return [_fitted(view, size) for view in views_of_walk(run, walk, STEPS)]


def _fitted(pixels: Pixels, size: tuple[int, int]) -> Pixels:
    """Return an image resized to a size, cropped around its centre if the aspect ratios differ."""
    height, width = pixels.shape[:2]
    scale = max(size[0] / width, size[1] / height)
    wide, tall = (
        min(round(one / scale), most) for one, most in zip(size, (width, height), strict=True)
    )
    left, top = (width - wide) // 2, (height - tall) // 2
    cut = Image.fromarray(pixels[top : top + tall, left : left + wide])
    return np.asarray(cut.resize(size, Image.Resampling.LANCZOS))


def _page(rows: Sequence[Sequence[Pixels]], strip: Sequence[Pixels]) -> Pixels:
    """Arrange images in rows under column headings, with the strip below."""
    width = len(HEADS) * (CELL_PX[0] + GAP_PX) + GAP_PX
    tall = HEAD_PX + len(rows) * (CELL_PX[1] + GAP_PX)
    extra = HEAD_PX + strip[0].shape[0] + GAP_PX if strip else 0
    page = Image.new("RGB", (width, tall + extra), "white")
    pen, font = ImageDraw.Draw(page), ImageFont.load_default(20)
    for n, head in enumerate(HEADS):
        middle = GAP_PX + n * (CELL_PX[0] + GAP_PX) + CELL_PX[0] // 2
        pen.text((middle, HEAD_PX // 2), head, "black", font, anchor="mm")
        for row, pictures in enumerate(rows):
            place = (GAP_PX + n * (CELL_PX[0] + GAP_PX), HEAD_PX + row * (CELL_PX[1] + GAP_PX))
            page.paste(Image.fromarray(pictures[n]), place)
    step = strip[0].shape[1] + GAP_PX if strip else 0
    margin = (width - len(strip) * step + GAP_PX) // 2  # The pictures of a short walk are centred.
    for n, picture in enumerate(strip):
        left = margin + n * step
        page.paste(Image.fromarray(picture), (left, tall + HEAD_PX))
    if strip:
        pen.text((width // 2, tall + HEAD_PX // 2), "The agent's path", "black", font, anchor="mm")
    return np.asarray(page)
