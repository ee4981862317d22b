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

from world2minecraft.coordinates import invert_rigid
from world2minecraft.geometry.surface import Surface, collect_surface
from world2minecraft.progress import Progress, silent
from world2minecraft.register.kernels import UNKNOWNS, surfel_means
from world2minecraft.register.parameters import RegisterParameters
from world2minecraft.register.passes import State, run_passes, shared, surfels_of
from world2minecraft.types import Corrections, Scan, View

STAGE = "register"
JUDGED_GAP_M = 0.10
HELD_BLOCK_M = 0.4  # Held-out surface comes in blocks: neighbours would speak for each other.
MUST_FALL = 0.98  # What the held-out misfit must fall to; less is chance.
LEAST_JUDGES = 50
DECIMALS = 9


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
    surface = collect_surface(_told(depth_views(scan), total, progress))
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
    frames = len(room.cameras)
    still = State(room, np.zeros((frames, UNKNOWNS)), np.zeros(3))
    if chosen.passes == 0 or frames < 2 or not len(room.points_m):
        return _registered(surface, still, scan_to_room, None, None)
    held = _held_out(room, chosen.held_share)
    moved = run_passes(room, ~held, chosen, chosen.scale_sigma)
    if moved.sigmas[2] < chosen.least_scale_sigma and chosen.scale_sigma > 0:
        moved = run_passes(room, ~held, chosen, 0.0)
    before, after = (_misfit_m(state.surface, held, chosen) for state in (still, moved))
    if before is None or after is None or after > MUST_FALL * before:
        return _registered(surface, still, scan_to_room, before, after)
    return _registered(surface, moved, scan_to_room, before, after)


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
    surface: Surface,
    state: State,
    scan_to_room: np.ndarray,
    before_m: float | None,
    after_m: float | None,
) -> Registered:
    room_to_scan = invert_rigid(scan_to_room)
    cameras = room_to_scan @ state.surface.cameras
    change = cameras @ np.array([invert_rigid(old) for old in surface.cameras]).reshape(-1, 4, 4)
    change = np.round(change, DECIMALS)
    scale = np.round(np.exp(state.total[:, 6]), DECIMALS)
    facts = _facts(state, before_m, after_m)
    return Registered(
        Corrections(surface.names, change, scale, facts), state.surface.turned(room_to_scan)
    )


def _facts(state: State, before_m: float | None, after_m: float | None) -> dict[str, Any]:
    """Return the figures for ``scan.json``."""
    shift = np.linalg.norm(state.total[:, 3:6], axis=1)
    turn = np.degrees(np.linalg.norm(state.total[:, :3], axis=1))
    kept = bool(state.sigmas[1] > 0)
    return {
        "kept": kept,
        "frames": len(state.total),
        "moved_median_mm": _rounded(1000 * _median(shift)),
        "moved_most_mm": _rounded(1000 * float(shift.max(initial=0))),
        "turned_median_deg": _rounded(_median(turn)),
        "turned_most_deg": _rounded(float(turn.max(initial=0))),
        "depth_scaled": bool(state.sigmas[2] > 0),
        "depth_scale_spread": _rounded(float(state.sigmas[2])),
        "misfit_before_mm": None if before_m is None else _rounded(1000 * before_m),
        "misfit_after_mm": None if after_m is None else _rounded(1000 * after_m),
    }


def _median(values: np.ndarray) -> float:
    return float(np.median(values)) if len(values) else 0.0


def _rounded(value: float) -> float:
    return round(value, 4)
