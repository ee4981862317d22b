"""Label images: the NYU40 class of each pixel of an image, and overlays that show them.

The network predicts at a small size. Its probabilities, not its classes, are interpolated to the
size of the image, so that outlines are smooth.
"""

from functools import lru_cache
from typing import Protocol

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from world2minecraft.core.types import Camera, View
from world2minecraft.core.vocabulary import NYU40_COUNT, nyu40_names
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.geometry.unprojection import project, unproject_depth
from world2minecraft.reconstruction.recognition.segmentation import splat_depth
from world2minecraft.reconstruction.recognition.segmentation_channels import (
    geometry_size,
    network_size,
)

UNKNOWN_ID = 0
SAME_LENS = 5e-3  # Largest difference of intrinsics, relative to the image, of one camera.
MAX_OVERLAY_PX = 1280
OVERLAY_SHARE = 0.55  # Share of the class colour in the overlay.
NAMED_SHARE = 0.002  # Classes with a smaller share of the image are not in the legend.
WRITTEN_SHARE = 0.01  # The names of classes with a smaller share are not written into the image.
SPARSE_PX = 4  # Distance of the pixels that are searched for the place of a name.
LEGEND_PX, LINE_PX, SWATCH_PX = 150, 18, 12
WALL_COLOUR, MIN_LIGHTNESS, MAX_LIGHTNESS = (175, 175, 175), 0.45, 0.9  # In Oklab.
INK, PAPER = (20, 20, 20), (255, 255, 255)


class PixelClassifier(Protocol):
    """A network such as ``SegmentationModel``."""

    def predict(
        self,
        colour: np.ndarray | None,
        depth_m: np.ndarray | None,
        camera: Camera,
        up: np.ndarray | None = None,
        camera_height_m: float | None = None,
    ) -> np.ndarray:
        """Predict the probabilities of the ids 1 to 40, float32 [h, w, 40]."""
        ...


def segment_view(
    model: PixelClassifier,
    view: View,
    *,
    up: np.ndarray | None = None,
    camera_height_m: float | None = None,
    min_probability: float = 0.0,
) -> np.ndarray:
    """Predict the NYU40 class of each pixel of a colour image.

    Args:
        model: The network.
        view: A view with colour. Depth is used if there is any; the pose is not used.
        up: Direction of up in the frame of the colour camera, float64 [3], or None if unknown.
        camera_height_m: Height of the camera above the floor in metres, or None if unknown.
        min_probability: Pixels whose most likely class is less likely than this are unknown.

    Returns:
        NYU40 ids 1 to 40, or 0 for unknown, uint8 [H, W] at the size of the colour image.

    Raises:
        ValueError: If the view has no colour.
    """
    if view.colour is None or view.colour_camera is None:
        raise ValueError(f"view {view.name} has no colour")
    depth_m = depth_of_colour_camera(view)
    probability = model.predict(view.colour, depth_m, view.colour_camera, up, camera_height_m)
    height, width = view.colour.shape[:2]
    return most_likely_ids(probability, width, height, min_probability)


def most_likely_ids(
    probability: np.ndarray, width_px: int, height_px: int, min_probability: float = 0.0
) -> np.ndarray:
    """Interpolate probabilities bilinearly, and return the id of the most likely class.

    Args:
        probability: Probabilities of the ids 1 to C, float32 [h, w, C].
        width_px: Width of the result.
        height_px: Height of the result.
        min_probability: Pixels whose most likely class is less likely than this are 0.

    Returns:
        Ids 1 to C, or 0, uint8 [H, W].
    """
    best = np.zeros((height_px, width_px), np.float32)
    ids = np.zeros((height_px, width_px), np.uint8)
    # Interpolated probabilities have at least this sum, so the best of C is at least the C-th part.
    least = probability.sum(axis=2).min() / probability.shape[2]
    for number in np.flatnonzero(probability.max(axis=(0, 1)) >= least * (1 - 1e-4)):
        plane = Image.fromarray(np.ascontiguousarray(probability[..., number], np.float32))
        scaled = np.asarray(plane.resize((width_px, height_px), Image.Resampling.BILINEAR))
        better = scaled > best
        np.copyto(best, scaled, where=better)
        np.copyto(ids, np.uint8(number + 1), where=better)
    ids[best < min_probability] = UNKNOWN_ID
    return ids


def depth_of_colour_camera(view: View) -> np.ndarray | None:
    """Return the depth of a view as its colour camera sees it, or None without depth.

    Returns:
        Depth in metres, float32 [h, w], 0 where unknown: the depth image of the view if both images
        are of one camera, else its points projected to the colour camera.
    """
    colour, depth = view.colour_camera, view.depth_camera
    if view.depth_m is None or depth is None or colour is None:
        return None
    if np.allclose(view.depth_to_colour, np.eye(4), atol=1e-6) and _is_same_lens(depth, colour):
        return view.depth_m
    small = colour.scaled_to(*geometry_size(*network_size(colour.width_px, colour.height_px)))
    points_m, _ = unproject_depth(view.depth_m, depth, view.depth_to_colour)
    points_m = points_m[points_m[:, 2] > 0]
    places = project(points_m.astype(np.float64), small) / (small.width_px, small.height_px)
    inside = ((places >= 0) & (places < 1)).all(axis=1)
    right, down = places[inside].T
    return splat_depth(points_m[inside, 2], down, right, (small.width_px, small.height_px))


def _is_same_lens(one: Camera, other: Camera) -> bool:
    """Return whether two cameras of one place see the same image at any two sizes."""
    stated = [
        (
            camera.fx_px / camera.width_px,
            camera.fy_px / camera.height_px,
            camera.cx_px / camera.width_px,
            camera.cy_px / camera.height_px,
        )
        for camera in (one, other)
    ]
    return np.allclose(*stated, rtol=0, atol=SAME_LENS) and one.distortion == other.distortion


@lru_cache(maxsize=1)
def nyu40_colours() -> np.ndarray:
    """Return a colour for each NYU40 id, uint8 [41, 3]; id 0 (unknown) is black.

    Walls are grey. Each further class has the colour that differs most from those before it.
    """
    steps = np.arange(15, 256, 16)
    candidates = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3)
    shades = srgb_to_oklab(candidates)
    usable = (shades[:, 0] > MIN_LIGHTNESS) & (shades[:, 0] < MAX_LIGHTNESS)
    candidates, shades = candidates[usable], shades[usable]
    chosen = [WALL_COLOUR]
    apart = np.linalg.norm(shades - srgb_to_oklab(np.array(WALL_COLOUR)), axis=1)
    for _ in range(NYU40_COUNT - 1):
        farthest = int(np.round(apart, 6).argmax())
        chosen.append(tuple(candidates[farthest].tolist()))
        apart = np.minimum(apart, np.linalg.norm(shades - shades[farthest], axis=1))
    table = np.array([(0, 0, 0), *chosen], np.uint8)
    table.flags.writeable = False
    return table


def blend_classes(colour: np.ndarray, ids: np.ndarray) -> np.ndarray:
    """Blend an image with the colours of its classes. Unknown pixels are only darkened.

    Args:
        colour: Image, uint8 [H, W, 3].
        ids: NYU40 ids of its pixels, uint8 [H, W].

    Returns:
        The blended image, uint8 [H, W, 3].
    """
    mixed = (1 - OVERLAY_SHARE) * colour + OVERLAY_SHARE * nyu40_colours()[ids]
    return np.round(mixed).astype(np.uint8)


def draw_overlay(colour: np.ndarray, ids: np.ndarray) -> Image.Image:
    """Draw an image with the colours of its classes, and a legend on its right.

    Args:
        colour: Image, uint8 [H, W, 3].
        ids: NYU40 ids of its pixels, uint8 [H, W].

    Returns:
        An image in which the longer side of the photo has at most ``MAX_OVERLAY_PX`` pixels.
    """
    height, width = ids.shape
    share = min(1.0, MAX_OVERLAY_PX / max(width, height))
    size = (max(1, round(width * share)), max(1, round(height * share)))
    small = np.asarray(Image.fromarray(colour).resize(size, Image.Resampling.BOX))
    classes = np.asarray(Image.fromarray(ids).resize(size, Image.Resampling.NEAREST))
    page = Image.new("RGB", (size[0] + LEGEND_PX, size[1]), PAPER)
    page.paste(Image.fromarray(blend_classes(small, classes)), (0, 0))
    draw, font = ImageDraw.Draw(page), ImageFont.load_default(12)
    colours, left = nyu40_colours(), size[0] + 6
    for line, (number, part) in enumerate(class_shares(ids)[: size[1] // LINE_PX]):
        top = line * LINE_PX + 3
        swatch = (left, top, left + SWATCH_PX, top + SWATCH_PX)
        draw.rectangle(swatch, tuple(colours[number].tolist()))
        text = f"{class_name(number)} {part:.1%}"
        draw.text((left + SWATCH_PX + 5, top - 1), text, INK, font)
    return page


def write_class_names(image: Image.Image, ids: np.ndarray) -> None:
    """Write the name of each large class into an image, at a pixel of the class near its middle.

    Args:
        image: The image, which is changed.
        ids: NYU40 ids of its pixels, uint8 [H, W].
    """
    draw, font = ImageDraw.Draw(image), ImageFont.load_default(max(11, image.width / 60))
    small = ids[::SPARSE_PX, ::SPARSE_PX]
    for number, part in class_shares(small):
        if number == UNKNOWN_ID or part < WRITTEN_SHARE:
            continue
        rows, columns = np.nonzero(small == number)
        nearest = np.hypot(rows - np.median(rows), columns - np.median(columns)).argmin()
        name = class_name(number)
        half = min(draw.textlength(name, font) / 2 + 3, image.width / 2)
        x = float(np.clip(columns[nearest] * SPARSE_PX, half, image.width - half))
        place = (x, float(rows[nearest] * SPARSE_PX))
        draw.text(place, name, PAPER, font, "mm", stroke_width=2, stroke_fill=INK)


def class_shares(ids: np.ndarray) -> list[tuple[int, float]]:
    """Return the ids in an image with their shares of its pixels, the largest first."""
    counts = np.bincount(ids.reshape(-1), minlength=NYU40_COUNT + 1)
    shares = counts / max(ids.size, 1)
    return [
        (int(number), float(shares[number]))
        for number in np.argsort(-shares, kind="stable")
        if shares[number] >= NAMED_SHARE
    ]


def class_name(number: int) -> str:
    """Return the name of an NYU40 id.

    Example:
        >>> class_name(32), class_name(0)
        ('night stand', 'unknown')
    """
    names = {held: name for name, held in nyu40_names().items()}
    return names.get(number, "unknown")
