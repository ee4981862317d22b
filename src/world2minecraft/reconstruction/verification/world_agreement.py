"""How well the built world agrees with the photos: a headline for the room and a row per object.

The **headline** is the share of the photographed surface whose thing is there with the right look
and name (``photo_agreement``). Every pixel with a measured depth counts the same, so surface counts
as much as photos show of it, except that objects together weigh as much as walls, floor, ceiling
and windows together: otherwise a bare room would look good. Surface that lies in no cell of the
room counts as missing. The standard error is that of a bootstrap over the views.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import OBJECT_CLASSES
from world2minecraft.core.parallel import map_parallel
from world2minecraft.core.types import BlockVolume, ObjectInstance, OccupancyGrid, Placement
from world2minecraft.core.vocabulary import NYU40_COUNT, nyu40_classes, read_vocabulary
from world2minecraft.reconstruction.verification.built_names import (
    BuiltThing,
    built_structure,
    built_thing,
)
from world2minecraft.reconstruction.verification.photo_agreement import (
    NOTHING,
    ViewAgreement,
    compare_view,
    things_of_photo,
)
from world2minecraft.reconstruction.verification.photo_samples import PhotoSample
from world2minecraft.rendering.scene import BlockScene, prepare_scene

RESAMPLES = 500
NAMES_LISTED, MIN_SHARE = 3, 0.01  # Of what photos show at an object.
MIN_PIXELS = 20  # Of an object, over all samples, for its scores to mean something.


@dataclass(frozen=True, eq=False)
class ObjectAgreement:
    """The agreement of one object with the photos that show it.

    Attributes:
        object_id: Id of the object.
        titles: What is built, in words.
        pixels: Number of its pixels with a measured depth, over all samples.
        silhouette_iou: IoU of its pixels in the photos and in the rendered images.
        colour_difference: Median CIEDE2000 difference where it is there, or None if it is nowhere.
        there: Share of its pixels at which it is there.
        named: Share of its pixels with the right name.
        right: Share of its pixels at which it is there with the right look and name.
        seen: Names of what the segmentation network sees there, with their shares, best first.
        best_view: Index of the sample with most of its pixels.
        box_px: First row, first column and exclusive last ones of the object in that sample.
    """

    object_id: int
    titles: tuple[str, ...]
    pixels: int
    silhouette_iou: float
    colour_difference: float | None
    there: float
    named: float
    right: float
    seen: tuple[tuple[str, float], ...]
    best_view: int
    box_px: tuple[int, int, int, int]


@dataclass(frozen=True)
class ObjectScore:
    """How well an object agrees with the photos, in a few numbers.

    Attributes:
        pixels: Number of its pixels with a measured depth, over all samples.
        wrong: Number of pixels that are not right, of those that show it in the photos or in the
            rendered images.
        silhouette_iou: IoU of its pixels in the photos and in the rendered images.
        there: Share of these at which it is there.
        agreement: Mean of three of their shares: those at which it is there, those at which it also
            has the right look, and those at which it is right.
    """

    pixels: int
    wrong: int
    silhouette_iou: float
    there: float
    agreement: float


@dataclass(frozen=True, eq=False)
class PhotoAgreement:
    """The agreement of the world with the photos.

    Attributes:
        headline: Share of the photographed surface that is right.
        standard_error: Standard error of the headline over the choice of views, or None for one.
        views: Number of samples.
        objects_right: Share of the objects' surface that is right, or None without any.
        structure_right: That of walls, floor, ceiling and windows.
        missing: Share of the surface whose thing is not there, with the headline's weights.
        look: Share of the surface whose thing is there but looks different.
        name: Share of the surface whose thing is there and looks right but has another name or
            none.
        objects: Rows of the objects that photos show.
    """

    headline: float
    standard_error: float | None
    views: int
    objects_right: float | None
    structure_right: float | None
    missing: float
    look: float
    name: float
    objects: tuple[ObjectAgreement, ...]


def compare_world(
    samples: Sequence[PhotoSample],
    grid: OccupancyGrid,
    instances: Sequence[ObjectInstance],
    placements: Sequence[Placement],
    volume: BlockVolume | BlockScene,
) -> PhotoAgreement | None:
    """Compare the built world with photos, or return None if they measured no surface.

    Args:
        samples: Samples of the photos.
        grid: Grid with the class and the object of each cell.
        instances: Objects of the room.
        placements: Their furniture.
        volume: The built world, or its scene.
    """
    things = built_things(instances, placements)
    shown = [things_of_photo(sample, grid) for sample in samples]
    views = compare_views(samples, shown, things, volume, grid.voxel_m)
    if not any(view.measured.any() for view in views):
        return None
    counts = _counts_of_views(samples, views)
    missing, look, name, right = _weighted(counts.sum(axis=0))
    of_objects, of_structure = counts.sum(axis=0)
    return PhotoAgreement(
        headline=right,
        standard_error=_standard_error(counts),
        views=len(views),
        objects_right=_share(of_objects[3], of_objects.sum()),
        structure_right=_share(of_structure[3], of_structure.sum()),
        missing=missing,
        look=look,
        name=name,
        objects=_object_rows(samples, views, things, [one.id for one in instances]),
    )


def built_things(
    instances: Sequence[ObjectInstance], placements: Sequence[Placement]
) -> dict[int, BuiltThing]:
    """Return what the things of a world show, by object id or minus the class of structure."""
    things = {-number: thing for number, thing in built_structure().items()}
    return things | {one.id: built_thing(one, placements) for one in instances}


def compare_views(
    samples: Sequence[PhotoSample],
    shown: Sequence[np.ndarray],
    things: Mapping[int, BuiltThing],
    volume: BlockVolume | BlockScene,
    voxel_m: float,
) -> list[ViewAgreement]:
    """Compare the world with each photo.

    Args:
        samples: Samples of the photos.
        shown: What each of them shows, from ``things_of_photo``.
        things: What the world's things show, from ``built_things``.
        volume: The built world, or its scene.
        voxel_m: Cell size of the grid in metres.
    """
    scene = prepare_scene(volume) if isinstance(volume, BlockVolume) else volume
    tolerance_m = max(1 / scene.cells_per_metre, 2 * voxel_m)
    pairs = list(zip(samples, shown, strict=True))
    return map_parallel(lambda pair: compare_view(*pair, scene, things, tolerance_m), pairs)


def share_right(samples: Sequence[PhotoSample], views: Sequence[ViewAgreement]) -> float:
    """Return the headline of compared photos."""
    return _weighted(_counts_of_views(samples, views).sum(axis=0))[3]


def score_objects(views: Sequence[ViewAgreement]) -> dict[int, ObjectScore]:
    """Return the scores of all objects that photos or rendered images show, by id."""
    size = 1 + max((int(max(view.thing.max(), view.built.max(), 0)) for view in views), default=0)
    counts = np.zeros((6, size))
    for view in views:
        thing = np.maximum(view.thing[view.measured], 0)
        built = np.maximum(view.built[view.measured], 0)
        counts[0] += np.bincount(thing, minlength=size)
        counts[1] += np.bincount(built, minlength=size)
        counts[2] += np.bincount(thing[thing == built], minlength=size)
        for row, mask in enumerate((view.there, view.looks, view.right), 3):
            counts[row] += np.bincount(thing, weights=mask[view.measured], minlength=size)
    result = {}
    for number in (np.flatnonzero(counts[:2].sum(axis=0)[1:]) + 1).tolist():
        photographed, built, both, there, looks, right = counts[:, number].tolist()
        either = photographed + built - both
        result[number] = ObjectScore(
            pixels=int(photographed),
            wrong=int(either - right),
            silhouette_iou=both / either,
            there=there / either,
            agreement=(there + looks + right) / 3 / either,
        )
    return result


def headline_gains(
    samples: Sequence[PhotoSample],
    before: Sequence[ViewAgreement],
    after: Sequence[ViewAgreement],
) -> dict[int, float]:
    """Return by how much each object changes the headline between two worlds, by id.

    An object accounts for its pixels in the photos, and for those that it covers in one of the
    worlds. Where objects cover each other, both account for a pixel.
    """
    totals = _counts_of_views(samples, before).sum(axis=(0, 2))
    weights = 1 / (np.maximum(totals, 1) * np.count_nonzero(totals))
    result: dict[int, float] = {}
    for sample, old, new in zip(samples, before, after, strict=True):
        changed = old.measured & (old.right != new.right)
        weight = np.where(_is_object(sample, old), *weights)[changed]
        gain = np.where(new.right[changed], weight, -weight)
        shown = np.stack([view[changed] for view in (old.thing, old.built, new.built)])
        for number in np.unique(shown[shown > 0]).tolist():
            mine = (shown == number).any(axis=0)
            result[number] = result.get(number, 0.0) + float(gain[mine].sum())
    return result


def _counts_of_views(samples: Sequence[PhotoSample], views: Sequence[ViewAgreement]) -> np.ndarray:
    """Return the counts of ``_counts`` for each view, int64 [V, 2, 4]."""
    pairs = zip(samples, views, strict=True)
    return np.array([_counts(view, _is_object(sample, view)) for sample, view in pairs])


def _is_object(sample: PhotoSample, view: ViewAgreement) -> np.ndarray:
    """Return which pixels show objects; where the room has nothing, the network decides."""
    seen = np.isin(nyu40_classes()[sample.seen], OBJECT_CLASSES)
    structure = (view.thing < 0) & ~np.isin(-view.thing, OBJECT_CLASSES)
    return np.where(view.thing == NOTHING, seen, ~structure)


def _counts(view: ViewAgreement, is_object: np.ndarray) -> np.ndarray:
    """Return the pixels missing, of another look, of another name and right, int64 [2, 4].

    The first row is that of objects, the second that of structure.
    """
    kinds = (~view.there, view.there & ~view.looks, view.looks & ~view.named, view.right)
    rows = (view.measured & is_object, view.measured & ~is_object)
    return np.array([[np.count_nonzero(kind & row) for kind in kinds] for row in rows])


def _weighted(counts: np.ndarray) -> tuple[float, float, float, float]:
    """Return the mean shares of the rows of ``_counts`` that have pixels."""
    totals = counts.sum(axis=1, keepdims=True)
    shares = (counts / np.maximum(totals, 1))[totals[:, 0] > 0]
    missing, look, name, right = shares.mean(axis=0).tolist() if len(shares) else (0.0,) * 4
    return missing, look, name, right


def _standard_error(counts: np.ndarray) -> float | None:
    """Return the standard deviation of the headline over resampled views, or None for one view."""
    if len(counts) < 2:
        return None
    chosen = np.random.default_rng(0).integers(len(counts), size=(RESAMPLES, len(counts)))
    return float(np.std([_weighted(counts[rows].sum(axis=0))[3] for rows in chosen]))


def _object_rows(
    samples: Sequence[PhotoSample],
    views: Sequence[ViewAgreement],
    things: Mapping[int, BuiltThing],
    ids: Sequence[int],
) -> tuple[ObjectAgreement, ...]:
    """Return the rows of the objects that photos show, in the order of ``ids``."""
    rows = []
    for number in ids:
        masks = [view.measured & (view.thing == number) for view in views]
        pixels = [int(np.count_nonzero(mask)) for mask in masks]
        if sum(pixels) < MIN_PIXELS:
            continue
        built = [view.measured & (view.built == number) for view in views]
        both = sum(int((a & b).sum()) for a, b in zip(masks, built, strict=True))
        either = sum(int((a | b).sum()) for a, b in zip(masks, built, strict=True))
        differences = np.concatenate(
            [view.difference[mask & view.there] for view, mask in zip(views, masks, strict=True)]
        )
        seen = sum(
            np.bincount(sample.seen[mask], minlength=NYU40_COUNT + 1)
            for sample, mask in zip(samples, masks, strict=True)
        )
        best = int(np.argmax(pixels))
        rows.append(
            ObjectAgreement(
                object_id=number,
                titles=things[number].titles,
                pixels=sum(pixels),
                silhouette_iou=both / max(either, 1),
                colour_difference=float(np.median(differences)) if len(differences) else None,
                there=_mean(views, masks, "there"),
                named=_mean(views, masks, "named"),
                right=_mean(views, masks, "right"),
                seen=_seen_names(np.asarray(seen)),
                best_view=best,
                box_px=_box(masks[best] | built[best]),
            )
        )
    return tuple(rows)


def _mean(views: Sequence[ViewAgreement], masks: Sequence[np.ndarray], name: str) -> float:
    values = [getattr(view, name)[mask] for view, mask in zip(views, masks, strict=True)]
    return float(np.concatenate(values).mean())


def _seen_names(counts: np.ndarray) -> tuple[tuple[str, float], ...]:
    """Return the most frequent NYU40 classes, counted by number, in words and with their shares."""
    shares = counts / counts.sum()
    order = [int(n) for n in np.argsort(-shares, kind="stable")[:NAMES_LISTED]]
    named = [(read_vocabulary().of_nyu40(n), shares[n]) for n in order if shares[n] >= MIN_SHARE]
    return tuple((entries[0].title, float(share)) for entries, share in named if entries)


def _box(mask: np.ndarray) -> tuple[int, int, int, int]:
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return int(rows[0]), int(columns[0]), int(rows[-1]) + 1, int(columns[-1]) + 1


def _share(part: int, whole: int) -> float | None:
    return float(part / whole) if whole else None
