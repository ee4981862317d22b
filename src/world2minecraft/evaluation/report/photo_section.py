"""The part of the report that compares the world with the photos: figures, and crops of objects."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.core.parallel import map_parallel
from world2minecraft.core.types import Scan
from world2minecraft.evaluation.report.finished_run import FinishedScene
from world2minecraft.reconstruction.naming.name_votes import NAME_VOTES, read_name_votes
from world2minecraft.reconstruction.verification.photo_samples import PhotoSample, sample_photos
from world2minecraft.reconstruction.verification.world_agreement import (
    ObjectAgreement,
    PhotoAgreement,
    compare_world,
)
from world2minecraft.rendering.picture import render_volume
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.shading_parameters import NEUTRAL

MARGIN = 0.2  # Around an object in its crop, as a share of its size.
MIN_CROP = 0.2  # Least side of a crop, as a share of the image's long side.


@dataclass(frozen=True, eq=False)
class Crop:
    """An object in the photo that shows most of it, and in the world from the same pose.

    Attributes:
        object_id: Id of the object.
        photo: Part of the photo, uint8 [H, W, 3].
        built: The same part of the rendered image, uint8 [H, W, 3].
    """

    object_id: int
    photo: np.ndarray
    built: np.ndarray


def compare_with_photos(
    scene: FinishedScene, scan: Scan, drawn: BlockScene | None = None
) -> tuple[PhotoAgreement | None, tuple[PhotoSample, ...]]:
    """Compare the world of a run with its photos, and return the samples that were compared.

    ``drawn`` is the scene of its volume, if it is already prepared.
    """
    path = scene.folder / NAME_VOTES
    samples = sample_photos(scan, read_name_votes(path) if path.is_file() else None)
    if not samples:
        return None, ()
    volume = scene.volume if drawn is None else drawn
    found = compare_world(samples, scene.grid, scene.instances, scene.placements, volume)
    return found, samples


def agreement_facts(found: PhotoAgreement | None, samples: Sequence[PhotoSample]) -> dict[str, Any]:
    """Return the content of ``photo_agreement`` in ``report.json``.

    Without a comparison, ``headline`` is None and ``reason`` says why.
    """
    if found is None:
        reason = "the photos have no depth of the room" if samples else "no photo with depth"
        return {"headline": None, "reason": reason}
    return {
        "headline": round(found.headline, 4),
        "standard_error": _rounded(found.standard_error),
        "views": found.views,
        "objects_right": _rounded(found.objects_right),
        "structure_right": _rounded(found.structure_right),
        "fails": {
            "missing": round(found.missing, 4),
            "look": round(found.look, 4),
            "name": round(found.name, 4),
        },
        "objects": [_row(one, samples) for one in found.objects],
    }


def _row(one: ObjectAgreement, samples: Sequence[PhotoSample]) -> dict[str, Any]:
    difference = one.colour_difference
    return {
        "id": one.object_id,
        "built_as": list(one.titles),
        "pixels": one.pixels,
        "right": round(one.right, 4),
        "there": round(one.there, 4),
        "silhouette_iou": round(one.silhouette_iou, 4),
        "colour_difference": None if difference is None else round(difference, 2),
        "name_agreement": round(one.named, 4),
        "photos_show": [{"name": name, "share": round(share, 4)} for name, share in one.seen],
        "view": samples[one.best_view].name,
    }


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, 4)


def crop_objects(
    found: PhotoAgreement, samples: Sequence[PhotoSample], scene: BlockScene
) -> list[Crop]:
    """Return a crop of each object, in the order of ``found.objects``."""

    def draw(view: int) -> np.ndarray:
        sample = samples[view]
        height, width = sample.picture.shape[:2]
        camera = sample.camera.scaled_to(width, height)
        drawn = render_volume(scene, camera, sample.camera_to_room, light=NEUTRAL).colour
        if drawn is None:
            raise RuntimeError("the renderer returned no colour image")
        return drawn

    shown = sorted({one.best_view for one in found.objects})
    pictures = dict(zip(shown, map_parallel(draw, shown), strict=True))
    crops = []
    for one in found.objects:
        sample = samples[one.best_view]
        rows, columns = _crop_box(one.box_px, sample)
        crops.append(
            Crop(
                one.object_id,
                sample.picture[rows, columns],
                pictures[one.best_view][rows, columns],
            )
        )
    return crops


def _crop_box(box_px: tuple[int, int, int, int], sample: PhotoSample) -> tuple[slice, slice]:
    """Return the rows and columns of the picture around a box of the raster."""
    height, width = sample.picture.shape[:2]
    scale = width / sample.camera.width_px
    least = MIN_CROP * max(height, width)
    sides = []
    for first, last, size in (
        (box_px[0], box_px[2], height),
        (box_px[1], box_px[3], width),
    ):
        middle = scale * (first + last) / 2
        half = max(scale * (last - first) * (1 + 2 * MARGIN), least) / 2
        sides.append(slice(max(int(middle - half), 0), min(int(np.ceil(middle + half)), size)))
    return sides[0], sides[1]


def worst_first(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the object rows of ``agreement_facts``, those with most wrong surface first."""
    return sorted(rows, key=lambda row: (-(1 - row["right"]) * row["pixels"], row["id"]))
