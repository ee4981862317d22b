"""Contact sheets: many images side by side with captions."""

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.types import Camera
from world2minecraft.geometry.undistort import pinhole_camera
from world2minecraft.minecraftocc.sample_figure import overlay_labels
from world2minecraft.minecraftocc.scene_sources import open_scene_source
from world2minecraft.minecraftocc.store import open_store
from world2minecraft.minecraftocc.tours import read_views
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.presentation.shot_rendering import DrawOptions, draw_frames
from world2minecraft.rendering.scene import BlockScene, prepare_scene
from world2minecraft.rendering.shading_parameters import DAY

GAP_PX, LINE_PX = 6, 16
PAPER, INK = (250, 250, 248), (40, 42, 46)
MAX_PX = 60_000_000  # Of a sheet.


def make_contact_sheet(
    pictures: Iterable[tuple[np.ndarray, str]], columns: int = 6, tile_px: int = 240
) -> np.ndarray:
    """Compose images with captions into a contact sheet, uint8 [H, W, 3].

    Args:
        pictures: Images, uint8 [h, w, 3] of any size, with their captions.
        columns: Number of images per row.
        tile_px: Width of each image on the sheet in pixels.

    Raises:
        UsageError: If there are no images, or if the sheet would be too large.
    """
    tiles = [(_thumbnail(colour, tile_px), caption) for colour, caption in pictures]
    if not tiles:
        raise UsageError("a contact sheet needs at least one image")
    tall = max(tile.height for tile, _ in tiles) + LINE_PX + GAP_PX
    columns = min(columns, len(tiles))
    size = (columns * (tile_px + GAP_PX) + GAP_PX, -(-len(tiles) // columns) * tall + GAP_PX)
    if size[0] * size[1] > MAX_PX:
        raise UsageError(
            f"a contact sheet of {size[0]}x{size[1]} pixels is too large; use fewer images"
        )
    page = Image.new("RGB", size, PAPER)
    drawn, font = ImageDraw.Draw(page), ImageFont.load_default(12)
    for number, (tile, caption) in enumerate(tiles):
        row, column = divmod(number, columns)
        x, y = GAP_PX + column * (tile_px + GAP_PX), GAP_PX + row * tall
        page.paste(tile, (x, y))
        drawn.text((x, y + tile.height + 1), caption, INK, font)
    return np.asarray(page)


def spread_indices(count: int, limit: int) -> list[int]:
    """Return up to ``limit`` evenly spaced indices below ``count``.

    Example:
        >>> spread_indices(10, 4)
        [0, 3, 6, 9]
    """
    if count <= limit:
        return list(range(count))
    return [int(n) for n in np.round(np.linspace(0, count - 1, limit))]


def select_indices(count: int, limit: int, first: bool) -> list[int]:
    """Return up to ``limit`` indices below ``count``: the first ones or evenly spaced ones."""
    return list(range(min(count, limit))) if first else spread_indices(count, limit)


def pictures_of_dataset(
    folder: Path, limit: int, *, first: bool = False, split: str = "", labels: bool = False
) -> Iterable[tuple[np.ndarray, str]]:
    """Yield images of a data set with their captions.

    Args:
        folder: Folder of the data set.
        limit: Maximum number of samples.
        first: Whether to use the first samples instead of evenly spaced ones.
        split: Split to use, ``train`` or ``test``. An empty string uses all samples.
        labels: Whether to yield each image again with its labels overlaid.

    Raises:
        InputError: If the data set contains no images and ``labels`` is False.
    """
    store = open_store(folder)
    keys = store.keys(split or None)
    for number in select_indices(len(keys), limit, first):
        sample = store[keys[number]]
        if sample.colour is not None:
            yield sample.colour, keys[number]
        elif not labels:
            raise InputError(
                folder, "contains labels but no images; add --labels to show the labels"
            )
        if labels:
            yield overlay_labels(sample), f"{keys[number]} labels"


def pictures_of_tour(
    tour: Path,
    world: Path,
    limit: int,
    *,
    width_px: int,
    first: bool = False,
    hour: float | None = None,
) -> Iterable[tuple[np.ndarray, str]]:
    """Render views of a tour file in its world and yield them with their captions.

    Args:
        tour: Tour file.
        world: World that the tour was made for.
        limit: Maximum number of views.
        width_px: Width of each image in pixels.
        first: Whether to use the first views instead of evenly spaced ones.
        hour: Time of day for the light, from 0 to 24. Defaults to that of ``LightSettings``.
    """
    volume = open_scene_source(world).volume()
    views = read_views(tour, volume.block_to_room)
    chosen = [views[number] for number in select_indices(len(views), limit, first)]
    light = LightSettings() if hour is None else LightSettings(hour=hour)
    shots = [(view.camera, view.camera_to_room) for view in chosen]
    pictures = draw_views(prepare_scene(volume), shots, width_px, light)
    for view, colour in zip(chosen, pictures, strict=True):
        yaw, pitch = f"{view.pose.yaw_deg:.0f}", f"{view.pose.pitch_deg:.0f}"
        yield colour, f"{view.tour_id} {view.frame}  {view.kind} {yaw} {pitch}"


def draw_views(
    scene: BlockScene,
    views: Sequence[tuple[Camera, np.ndarray]],
    width_px: int,
    light: LightSettings = DAY,
) -> Iterable[np.ndarray]:
    """Render small images of views, uint8 [h, width_px, 3] each.

    Args:
        scene: Scene prepared with ``prepare_scene``.
        views: Cameras with their poses in the room, float64 [4, 4].
        width_px: Width of each image in pixels.
        light: Light settings.
    """
    cameras = [pinhole_camera(camera, width_px) for camera, _ in views]
    options = DrawOptions(outputs=("colour",), light=light, samples=2)
    for picture in draw_frames(scene, cameras, [pose for _, pose in views], options):
        yield np.asarray(picture.colour)


def _thumbnail(colour: np.ndarray, width_px: int) -> Image.Image:
    picture = Image.fromarray(colour)
    height_px = max(1, round(picture.height * width_px / picture.width))
    return picture.resize((width_px, height_px), Image.Resampling.BOX)
