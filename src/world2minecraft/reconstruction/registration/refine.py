"""``refine``: poses and depth scales of all frames at once, from what they see in common.

In: a scan whose poses are off by some millimetres and tenths of a degree, and whose depth may be
stretched by some per cent, each frame its own way. Out: a change for each frame. Patches of all
frames are grouped into surfels, and all frames are moved until the patches of a surfel meet; then
they are grouped again, more finely. How far poses and scales are off is learned on the way. A part
of the surface takes no part and judges: where it does not fit better afterwards, nothing is moved.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.progress import Progress, silent
from world2minecraft.core.types import Corrections, Scan, View
from world2minecraft.geometry.oriented_points import Surface, collect_surface
from world2minecraft.reconstruction.registration.kernels import surfel_means
from world2minecraft.reconstruction.registration.parameters import RegisterParameters
from world2minecraft.reconstruction.registration.passes import (
    State,
    begin,
    run_passes,
    shared,
    surfels_of,
    without_scale,
)

STAGE = "register"
JUDGED_GAP_M = 0.10
HELD_BLOCK_M = 0.4  # Held-out surface comes in blocks: neighbours would speak for each other.
MUST_FALL = 0.97  # What the held-out misfit must fall to; less is chance.
CLEAR_SPREAD = 0.02  # Depth scales that spread by less must prove that they do.
CLOSER_PASSES = 2  # With the depth left alone, poses are at most millimetres from their best.
MOST_PATCHES = 1_200_000  # Of all frames: about 700 MB at work.
LEAST_EACH = 200
LEAST_JUDGES = 50
DECIMALS = 9


@dataclass(frozen=True)
class Verdict:
    """Whether corrections are kept, and the held-out misfit without and with them."""

    kept: bool
    before_m: float | None
    after_m: float | None


@dataclass(frozen=True, eq=False)
class Registered:
    """Corrections, and the surface that they give, in the scan's frame."""

    corrections: Corrections
    surface: Surface


def refine(
    scan: Scan, parameters: RegisterParameters | None = None, progress: Progress = silent
) -> Corrections:
    """Return what puts a scan's poses and depth scales right; arguments as ``register``."""
    return register(scan, parameters, progress).corrections


def register(
    scan: Scan, parameters: RegisterParameters | None = None, progress: Progress = silent
) -> Registered:
    """Return the corrections of a scan together with the corrected surface.

    Args:
        scan: an aligned scan; its views are read once, depth alone where they can be.
        parameters: see ``RegisterParameters``.
        progress: told of the stage ``register``.
    """
    total = len(scan.views) + 1
    most_each = max(LEAST_EACH, MOST_PATCHES // max(1, len(scan.views)))
    surface = collect_surface(_told(depth_views(scan), total, progress), most_each)
    found = register_surface(surface, scan.scan_to_room, parameters or RegisterParameters())
    progress(STAGE, total, total)
    return found


def depth_views(scan: Scan) -> Iterable[View]:
    """Return the views of a scan, their colours undecoded where the stream can leave them so."""
    read = getattr(scan.views, "depth_views", None)
    return scan.views if read is None else read()


def register_surface(
    surface: Surface, scan_to_room: np.ndarray, chosen: RegisterParameters
) -> Registered:
    """Register the frames of a surface of the scan's frame; ``scan_to_room`` turns walls to axes.

    The depth is touched only where scales are found to vary, and nothing where the surface that
    took no part does not fit better.
    """
    room = surface.turned(scan_to_room)
    still = begin(room, chosen)
    if chosen.passes == 0 or len(room.cameras) < 2 or not len(room.points_m):
        return _registered(surface, still, scan_to_room, Verdict(False, None, None))
    held = _held_out(room, chosen.held_share)
    before_m = _misfit_m(room, held, chosen)
    moved = run_passes(still, ~held, chosen)
    after_m = _misfit_m(moved.surface, held, chosen)
    if moved.sigmas[2] < CLEAR_SPREAD:
        rigid = without_scale(still, moved)
        rigid = run_passes(rigid, ~held, chosen, max(1, chosen.passes - CLOSER_PASSES))
        rigid_m = _misfit_m(rigid.surface, held, chosen)
        if moved.sigmas[2] < chosen.least_scale_sigma or not _fell(rigid_m, after_m):
            moved, after_m = rigid, rigid_m
    kept = _fell(before_m, after_m)
    return _registered(
        surface, moved if kept else still, scan_to_room, Verdict(kept, before_m, after_m)
    )


def _fell(before_m: float | None, after_m: float | None) -> bool:
    """Whether a held-out misfit fell by more than chance; where few judge, it did not."""
    return before_m is not None and after_m is not None and after_m < MUST_FALL * before_m


def _told(views: Iterable[View], total: int, progress: Progress) -> Iterable[View]:
    for done, view in enumerate(views, start=1):
        yield view
        progress(STAGE, min(done, total - 1), total, view.name)


def _held_out(room: Surface, share: float) -> np.ndarray:
    """Return bool [N]: patches in a share of the blocks of space, spread by a fixed hash."""
    block = np.floor(room.points_m / HELD_BLOCK_M).astype(np.int64)
    code = block[:, 0] * 73856093 ^ block[:, 1] * 19349663 ^ block[:, 2] * 83492791
    return (code * 2654435761 % 2**32) < share * 2**32


def _misfit_m(surface: Surface, held: np.ndarray, chosen: RegisterParameters) -> float | None:
    """Return the median distance of held-out patches from their surfels; None where few judge."""
    judges = surface.chosen(held)
    surfels = surfels_of(judges, chosen.cell_m, JUDGED_GAP_M)
    index = shared(judges, surfels, np.ones(len(judges.points_m), bool))
    if len(index) < LEAST_JUDGES:
        return None
    owner = surfels.owner[index]
    off = judges.points_m[index] - surfels.centers_m[owner]
    along = np.einsum("ia,ia->i", surfels.normals[owner], off)
    weight = 1 / (judges.sigma_m[index] ** 2 + 0.002**2)
    means = surfel_means(along, weight, owner, len(surfels.frames))
    return float(np.median(np.abs(along - means[owner])))


def _registered(
    surface: Surface, state: State, scan_to_room: np.ndarray, verdict: Verdict
) -> Registered:
    room_to_scan = invert_rigid(scan_to_room)
    cameras = room_to_scan @ state.surface.cameras
    change = cameras @ np.array([invert_rigid(old) for old in surface.cameras]).reshape(-1, 4, 4)
    change = np.round(change, DECIMALS)
    scale = np.round(np.exp(state.total[:, 6]), DECIMALS)
    facts = _facts(state, verdict)
    return Registered(
        Corrections(surface.names, change, scale, facts), state.surface.turned(room_to_scan)
    )


def _facts(state: State, verdict: Verdict) -> dict[str, Any]:
    """Return the figures for ``scan.json``."""
    shift_mm = 1000 * np.linalg.norm(state.total[:, 3:6], axis=1)
    turn_deg = np.degrees(np.linalg.norm(state.total[:, :3], axis=1))
    scaled = verdict.kept and state.sigmas[2] > 0
    figures = {
        "moved_median_mm": _median(shift_mm),
        "moved_most_mm": float(shift_mm.max(initial=0)),
        "turned_median_deg": _median(turn_deg),
        "turned_most_deg": float(turn_deg.max(initial=0)),
        "depth_scale_spread": float(state.sigmas[2]) if scaled else 0.0,
        "misfit_before_mm": None if verdict.before_m is None else 1000 * verdict.before_m,
        "misfit_after_mm": None if verdict.after_m is None else 1000 * verdict.after_m,
    }
    rounded = {name: None if v is None else round(v, 4) for name, v in figures.items()}
    return {
        "kept": verdict.kept,
        "depth_scaled": bool(scaled),
        "frames": len(state.total),
    } | rounded


def _median(values: np.ndarray) -> float:
    return float(np.median(values)) if len(values) else 0.0
