"""Diagnostics of a scene: places that should be checked, each with a reason.

Objects are reported if no furniture fits, if two templates fit almost equally well, if the
confidence of their cells is low, or if they have no support. Cells are reported if they float,
belong to no object, are probably wrong by their calibrated confidence, or were completed without
being observed. Painted cells count as observed with full confidence, so repaired places are no
longer reported.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import OBJECT_CLASSES, display_name
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import COMPLETED, Placement, SceneObject
from world2minecraft.core.vocabulary import object_title
from world2minecraft.editing.scene.repair import find_floaters
from world2minecraft.editing.scene.scene_draft import SceneDraft
from world2minecraft.geometry.connected_components import label_components

LOW_IOU = 0.5  # Below it, furniture and cells have less than half of their union in common.
TIE = 0.03  # Smaller differences of IoU are noise.
UNSURE = 0.5  # Below this confidence, a cell is probably wrong.
UNSURE_CELLS = 30  # About 0.2 square metres at 0.08 m; smaller groups are edges of objects.
CRUMB_CELLS = 8  # A cube of 16 cm: the smallest object that is detected.
FLOATING, UNSUPPORTED, CRUMB = 0.97, 0.85, 0.4  # On the scale of 1 - IoU.
NO_TEMPLATE, COMPLETED_DOUBT = 0.45, 0.3  # Often right, and quick to check.
# In ten tuning rooms, a third of the objects that fit as well in another rotation were wrong, a
# tenth of those that another template fits as well, and 7 % of the others.
TURN_DOUBT, TIE_DOUBT = 0.6, 0.32
STANDING = (5, 6, 7, 8)  # Chairs, beds, sofas and tables stand; other objects may hang.


@dataclass(frozen=True, eq=False)
class Diagnostic:
    """A place to check. ``doubt`` is 0 to 1. ``object_id`` is 0 if no object is concerned."""

    kind: str
    why: str
    doubt: float
    at_m: np.ndarray  # float64 [3]
    object_id: int = 0


def find_diagnostics(draft: SceneDraft, progress: Progress = no_progress) -> list[Diagnostic]:
    """Return the diagnostics of a scene, one per object and place, most doubtful first.

    ``progress`` is called for each check.
    """
    found: list[Diagnostic] = []
    for done, kind in enumerate(CHECKS):
        progress("doubts", done, len(CHECKS))
        found.extend(kind(draft))
    progress("doubts", len(CHECKS), len(CHECKS))
    return rank_diagnostics(found)


def rank_diagnostics(found: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return diagnostics, most doubtful first, with only the most doubtful one of each object."""
    kept: list[Diagnostic] = []
    seen: set[int] = set()
    for one in sorted(found, key=lambda one: (-one.doubt, one.kind, one.object_id, *one.at_m)):
        if one.object_id not in seen:
            kept.append(one)
        if one.object_id:
            seen.add(one.object_id)
    return kept


def _of_objects(draft: SceneDraft) -> Iterator[Diagnostic]:
    for one in draft.objects.values():
        name = object_title(one.name, one.class_id)
        sure = round(100 * one.confidence)
        if sure < 100:
            why = f"{name}: cell confidence {sure}%"
            yield Diagnostic("low_confidence", why, 1 - one.confidence, one.center_m, one.id)
        yield from _check_support(draft, one)
        for placed in one.placements:
            yield from _of_furniture(one, placed)


def _of_furniture(one: SceneObject, placed: Placement) -> Iterator[Diagnostic]:
    name, at_m = object_title(one.name, one.class_id), placed.center_m
    if placed.template == "cells":
        why = f"{name}: no furniture template fits, built from its voxels"
        yield Diagnostic("no_template", why, NO_TEMPLATE, at_m, one.id)
        return
    share = f"{100 * placed.iou:.0f}%"
    if placed.iou < LOW_IOU:
        why = f"{name}: template {template_words(placed.template)} has low IoU {share}"
        yield Diagnostic("low_iou", why, 1 - placed.iou, at_m, one.id)
    rivals = [o for o in placed.alternatives if _is_other(placed, o) and placed.iou - o.iou < TIE]
    # The direction of an object matters more than which of two similar templates it has.
    rivals.sort(key=lambda other: (other.quarter_turns == placed.quarter_turns, -other.iou))
    if not rivals:
        return
    best, faces = rivals[0], rivals[0].quarter_turns != placed.quarter_turns
    turned = f" rotated to {90 * best.quarter_turns}°" if faces else ""
    why = f"{name}: {template_words(best.template)}{turned} fits almost as well, "
    why += f"IoU {100 * best.iou:.0f}% against {share}"
    apart = max(placed.iou - best.iou, 0) / TIE
    doubt = (TURN_DOUBT if faces else TIE_DOUBT) * (1 - apart / 4)
    yield Diagnostic("near_tie", why, doubt, at_m, one.id)


def _is_other(placed: Placement, other) -> bool:
    return (other.template, other.quarter_turns) != (placed.template, placed.quarter_turns)


def _check_support(draft: SceneDraft, one: SceneObject) -> Iterator[Diagnostic]:
    """Report an object that should stand but has only observed air below its lowest cells."""
    if one.class_id not in STANDING:
        return
    cells = draft.cells_of(one.id)
    if not len(cells) or cells[:, 2].min() == 0:
        return
    lowest = cells[cells[:, 2] == cells[:, 2].min()]
    under = draft.labels[lowest[:, 0], lowest[:, 1], lowest[:, 2] - 1]
    if (under == 0).all():
        why = f"{object_title(one.name, one.class_id)}: no support, only observed air below"
        yield Diagnostic("unsupported", why, UNSUPPORTED, one.center_m, one.id)


def _of_loose_cells(draft: SceneDraft) -> Iterator[Diagnostic]:
    loose = np.isin(draft.labels, OBJECT_CLASSES) & (draft.instance == 0)
    for one in find_floaters(draft, draft.labels.size):
        loose[tuple(one.cells.T)] = False
        owner = next((number for number in one.object_ids if number in draft.objects), 0)
        why = f"{_count_text(len(one.cells), one.class_id)} floating in the air"
        yield Diagnostic("floater", why, FLOATING, center_of_cells_m(draft, one.cells), owner)
    for cells in _parts(loose, 1, CRUMB_CELLS):
        what = _commonest(draft, cells)
        why = f"{_count_text(len(cells), what)} without an object"
        yield Diagnostic("crumb", why, CRUMB, center_of_cells_m(draft, cells))


def _of_unsure_cells(draft: SceneDraft) -> Iterator[Diagnostic]:
    unsure = (draft.labels % 255 > 0) & (draft.confidence < UNSURE)
    for cells in _parts(unsure, UNSURE_CELLS):
        mean = float(draft.confidence[tuple(cells.T)].astype(np.float64).mean())
        what = _commonest(draft, cells)
        why = f"{_count_text(len(cells), what)}, confidence {100 * mean:.0f}%"
        yield Diagnostic("unsure_cells", why, 1 - mean, center_of_cells_m(draft, cells))


def _of_completed_cells(draft: SceneDraft) -> Iterator[Diagnostic]:
    completed = (draft.source == COMPLETED) & (draft.labels % 255 > 0)
    for cells in _parts(completed, UNSURE_CELLS):
        what = _commonest(draft, cells)
        why = f"{_count_text(len(cells), what)}, completed but not observed"
        yield Diagnostic("completed", why, COMPLETED_DOUBT, center_of_cells_m(draft, cells))


CHECKS: tuple[Callable[[SceneDraft], Iterator[Diagnostic]], ...] = (
    _of_objects,
    _of_loose_cells,
    _of_unsure_cells,
    _of_completed_cells,
)


def _parts(mask: np.ndarray, least: int, most: int | None = None) -> Iterator[np.ndarray]:
    """Yield the cells int [N, 3] of each connected part of a mask with an allowed size."""
    parts, count = label_components(mask)
    at = np.argwhere(parts > 0)
    if not count:
        return
    numbers = parts[tuple(at.T)]
    order = np.argsort(numbers, kind="stable")
    for cells in np.split(at[order], np.flatnonzero(np.diff(numbers[order])) + 1):
        if len(cells) >= least and (most is None or len(cells) <= most):
            yield cells


def _commonest(draft: SceneDraft, cells: np.ndarray) -> int:
    return int(np.bincount(draft.labels[tuple(cells.T)]).argmax())


def _count_text(count: int, class_id: int) -> str:
    return f"{count} {display_name(class_id)} {'cell' if count == 1 else 'cells'}"


def template_words(template: str) -> str:
    """Return a template's name as words."""
    return " ".join("TV" if word == "tv" else word for word in template.split("_"))


def center_of_cells_m(draft: SceneDraft, cells: np.ndarray) -> np.ndarray:
    """Return the centre of cells int [N, 3] in the room frame in metres, float64 [3]."""
    return draft.origin_m + (cells.mean(axis=0) + 0.5) * draft.voxel_m
