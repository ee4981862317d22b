"""Joint refinement of the poses and depth scales of all frames from the surfaces they share.

The input is a scan with pose errors of some millimetres and tenths of a degree, and depth scales
that differ by some per cent per frame; the result is a correction for each frame. The patches of
all frames are grouped into surfels, all frames are moved until the patches of each surfel coincide
(one joint Gauss-Newton step), and the patches are grouped again with smaller tolerances. The noise
of poses and scales is estimated on the way. A held-out part of the surface judges the result: if it
does not fit better afterwards, the corrections are discarded.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Corrections, Scan, View
from world2minecraft.geometry.oriented_points import OrientedPoints, collect_oriented_points
from world2minecraft.reconstruction.registration.gauss_newton import (
    UNKNOWNS,
    Observations,
    Step,
    jacobian_rows,
    move_patches,
    solve,
)
from world2minecraft.reconstruction.registration.parameters import RegistrationParameters
from world2minecraft.reconstruction.registration.patch_correspondences import Surfels, find_surfels

# The gap that parts two surfaces and the residual beyond which a patch is no look at its surfel
# narrow from pass to pass: a depth scale that is 10 % off moves a wall at 3 m by 30 cm.
GAPS_M = (0.30, 0.10, 0.05, 0.04)
WIDTHS_M = (0.12, 0.04, 0.015, 0.01)
FIRST_CELLS = 2.0  # The first pass's cells are wider by this, for the same reason.
SAME_WAY = 0.9  # Cosine of 26 degrees between a patch and its surfel.
FIRST_BEND_M = 0.003  # Depth error of patches that is not due to pixel noise.
INDEPENDENT = 30  # Regions of an image with independent smooth depth errors.
MIN_NOISE_M = 0.002
SIGMAS_LEAST = np.array([1e-4, 3e-4, 1e-4])  # Radians, metres, log; less would freeze a frame.
SIGMAS_MOST = np.array([0.03, 0.05, 0.15])
GROUPS = (slice(0, 3), slice(3, 6), slice(6, 7))

STAGE = "register"
JUDGED_GAP_M = 0.10
HELD_BLOCK_M = 0.4  # Whole blocks of surface are held out, because neighbours are correlated.
MUST_FALL = 0.97  # Maximum ratio of the held-out misfits after and before; less gain is chance.
CLEAR_SPREAD = 0.02  # Scales with a smaller spread must be confirmed by held-out surface.
CLOSER_PASSES = 2  # With the depth left alone, poses are at most millimetres from their best.
MAX_PATCHES = 600_000  # For all frames together; more moved no pose of 600 frames by 0.1 mm.
MIN_PATCHES_PER_FRAME = 200
MIN_JUDGES = 50
DECIMALS = 9


@dataclass(frozen=True, eq=False)
class State:
    """The current patches and cameras, and all changes made so far.

    Attributes:
        surface: Patches and cameras.
        total: Sum of all steps, float64 [F, 7]: rotation in radians, translation in metres, log of
            the depth scale.
        sigmas: Estimated standard deviations of the three kinds of change, float64 [3].
        bend_m: Remaining distance of patches from their surfels in metres.
    """

    surface: OrientedPoints
    total: np.ndarray
    sigmas: np.ndarray
    bend_m: float


def begin(surface: OrientedPoints, chosen: RegistrationParameters) -> State:
    """Return the state before the first pass; ``surface`` must be in a frame aligned with walls."""
    sigmas = np.array([np.radians(chosen.jitter_deg), chosen.jitter_m, chosen.scale_sigma])
    return State(surface, np.zeros((len(surface.cameras), UNKNOWNS)), sigmas, FIRST_BEND_M)


def run_passes(
    state: State, speaks: np.ndarray, chosen: RegistrationParameters, first: int = 0
) -> State:
    """Move all frames until their patches coincide.

    Args:
        state: Initial state.
        speaks: Mask of the patches used, bool [N]; all patches are moved.
        chosen: Parameters of the registration.
        first: Number of the first pass; later passes use smaller tolerances.
    """
    frames = len(state.surface.cameras)
    together = np.sqrt(max(1.0, np.count_nonzero(speaks) / frames / INDEPENDENT))
    for number in range(first, chosen.passes):
        gap_m = GAPS_M[min(number, len(GAPS_M) - 1)]
        width_m = WIDTHS_M[min(number, len(WIDTHS_M) - 1)]
        cell_m = chosen.cell_m * (FIRST_CELLS if number == 0 else 1.0)
        noise_m = max(MIN_NOISE_M, state.bend_m * together)
        seen = observe(state.surface, speaks, cell_m, gap_m, noise_m)
        prior = np.repeat(state.sigmas, (3, 3, 1))
        state = _stepped(state, solve(seen, state.total, prior, width_m))
    return state


def without_scale(before: State, after: State) -> State:
    """Return the state ``after`` some passes with the depth scales of the state ``before``."""
    change = after.total - before.total
    change[:, 6] = 0.0
    accepted = Step(change, np.zeros_like(change), after.bend_m)
    sigmas = after.sigmas * [1.0, 1.0, 0.0]
    return replace(_stepped(before, accepted), sigmas=sigmas)


def surfels_of(surface: OrientedPoints, cell_m: float, gap_m: float) -> Surfels:
    """Group the patches of a surface into surfels."""
    weight = 1 / (surface.sigma_m**2 + 0.002**2)
    return find_surfels(
        surface.points_m, surface.normals, weight, surface.owner, cell_m=cell_m, gap_m=gap_m
    )


def shared(surface: OrientedPoints, surfels: Surfels, chosen: np.ndarray) -> np.ndarray:
    """Return the indices of the chosen patches on shared surfels with a similar normal.

    They are sorted by surfel, then by frame.
    """
    owner = surfels.owner
    facing = np.einsum("ia,ia->i", surface.normals, surfels.normals[owner])
    is_shared = chosen & (surfels.frames[owner] > 1) & (facing > SAME_WAY)
    return surfels.order[is_shared[surfels.order]]


def observe(
    surface: OrientedPoints, speaks: np.ndarray, cell_m: float, gap_m: float, noise_m: float
) -> Observations:
    """Return the observations of the frame poses by the selected patches."""
    surfels = surfels_of(surface, cell_m, gap_m)
    index = shared(surface, surfels, speaks)
    surfel, frame = surfels.owner[index], surface.owner[index]
    weight = 1 / (surface.sigma_m[index] ** 2 + noise_m**2)
    rows, residual = jacobian_rows(
        surface.points_m, surface.cameras, frame, surfel, index, weight,
        surfels.centers_m, surfels.normals,
    )  # fmt: skip
    return Observations(rows, residual, weight, frame, surfel, len(surface.cameras))


def _stepped(state: State, step: Step) -> State:
    """Return the state after a step, with standard deviations estimated from all steps."""
    surface, change = state.surface, step.change
    turns = np.array([_rotation(vector) for vector in change[:, :3]])
    eyes = surface.cameras[:, :3, 3]
    points_m, normals = move_patches(
        surface.points_m, surface.normals, surface.owner,
        np.ascontiguousarray(eyes), turns, change[:, 3:6].copy(), np.exp(change[:, 6]),
    )  # fmt: skip
    cameras = surface.cameras.copy()
    cameras[:, :3, :3] = np.einsum("fab,fbc->fac", turns, cameras[:, :3, :3])
    cameras[:, :3, 3] = eyes + change[:, 3:6]
    total = state.total + change
    learned = np.array([np.sqrt(np.mean(total[:, g] ** 2 + step.variance[:, g])) for g in GROUPS])
    learned = np.clip(learned, SIGMAS_LEAST, SIGMAS_MOST)
    moved = replace(surface, points_m=points_m, normals=normals, cameras=cameras)
    return State(moved, total, np.where(state.sigmas > 0, learned, 0.0), step.spread_m)


def _rotation(vector: np.ndarray) -> np.ndarray:
    """Return the rotation [3, 3] of a rotation vector in radians."""
    angle = float(np.sqrt(np.sum(vector * vector)))
    x, y, z = vector
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    square = np.outer(vector, vector) - angle * angle * np.eye(3)
    first, second = (
        (np.sin(angle) / angle, 2 * (np.sin(angle / 2) / angle) ** 2)
        if angle > 1e-9
        else (1.0, 0.5)
    )
    return np.eye(3) + first * cross + second * square


@dataclass(frozen=True)
class Verdict:
    """Whether corrections are accepted, and the held-out misfit before and after in metres."""

    accepted: bool
    before_m: float | None
    after_m: float | None


@dataclass(frozen=True, eq=False)
class Registered:
    """The corrections, and the corrected surface in the scan's frame."""

    corrections: Corrections
    surface: OrientedPoints


def refine(
    scan: Scan, parameters: RegistrationParameters | None = None, progress: Progress = no_progress
) -> Corrections:
    """Compute the corrections of a scan's poses and depth scales; see ``register``."""
    return register(scan, parameters, progress).corrections


def register(
    scan: Scan, parameters: RegistrationParameters | None = None, progress: Progress = no_progress
) -> Registered:
    """Compute the corrections of a scan together with the corrected surface.

    Args:
        scan: Aligned scan; its views are read once, without colour if possible.
        parameters: Parameters of the registration.
        progress: Callback for progress, called with the stage ``register``.
    """
    total = len(scan.views) + 1
    most_each = max(MIN_PATCHES_PER_FRAME, MAX_PATCHES // max(1, len(scan.views)))
    surface = collect_oriented_points(_told(depth_views(scan), total, progress), most_each)
    found = register_surface(surface, scan.scan_to_room, parameters or RegistrationParameters())
    progress(STAGE, total, total)
    return found


def depth_views(scan: Scan) -> Iterable[View]:
    """Return the views of a scan without decoding their colour images, if the stream allows it."""
    read = getattr(scan.views, "depth_views", None)
    return scan.views if read is None else read()


def register_surface(
    surface: OrientedPoints, scan_to_room: np.ndarray, chosen: RegistrationParameters
) -> Registered:
    """Register the frames of a surface in the scan's frame; ``scan_to_room`` aligns the walls.

    The depth is changed only if scales are found to vary, and all corrections are discarded unless
    the held-out surface fits better.
    """
    room = surface.transformed(scan_to_room)
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
    accepted = _fell(before_m, after_m)
    return _registered(
        surface, moved if accepted else still, scan_to_room, Verdict(accepted, before_m, after_m)
    )


def _fell(before_m: float | None, after_m: float | None) -> bool:
    """Return whether a held-out misfit decreased significantly; False with too few patches."""
    return before_m is not None and after_m is not None and after_m < MUST_FALL * before_m


def _told(views: Iterable[View], total: int, progress: Progress) -> Iterable[View]:
    for done, view in enumerate(views, start=1):
        yield view
        progress(STAGE, min(done, total - 1), total, view.name)


def _held_out(room: OrientedPoints, share: float) -> np.ndarray:
    """Return the mask of held-out patches, bool [N], chosen by a fixed hash of space blocks."""
    block = np.floor(room.points_m / HELD_BLOCK_M).astype(np.int64)
    code = block[:, 0] * 73856093 ^ block[:, 1] * 19349663 ^ block[:, 2] * 83492791
    return (code * 2654435761 % 2**32) < share * 2**32


def _misfit_m(
    surface: OrientedPoints, held: np.ndarray, chosen: RegistrationParameters
) -> float | None:
    """Return the median distance of held-out patches from their surfels, or None if too few."""
    judges = surface.subset(held)
    surfels = surfels_of(judges, chosen.cell_m, JUDGED_GAP_M)
    index = shared(judges, surfels, np.ones(len(judges.points_m), bool))
    if len(index) < MIN_JUDGES:
        return None
    owner = surfels.owner[index]
    off = judges.points_m[index] - surfels.centers_m[owner]
    along = np.einsum("ia,ia->i", surfels.normals[owner], off)
    weight = 1 / (judges.sigma_m[index] ** 2 + 0.002**2)
    mass = np.bincount(owner, weight, len(surfels.frames))
    means = np.bincount(owner, weight * along, len(surfels.frames)) / np.maximum(mass, 1e-12)
    return float(np.median(np.abs(along - means[owner])))


def _registered(
    surface: OrientedPoints, state: State, scan_to_room: np.ndarray, verdict: Verdict
) -> Registered:
    room_to_scan = invert_rigid(scan_to_room)
    cameras = room_to_scan @ state.surface.cameras
    change = cameras @ np.array([invert_rigid(old) for old in surface.cameras]).reshape(-1, 4, 4)
    change = np.round(change, DECIMALS)
    scale = np.round(np.exp(state.total[:, 6]), DECIMALS)
    facts = _facts(state, verdict)
    return Registered(
        Corrections(surface.names, change, scale, facts), state.surface.transformed(room_to_scan)
    )


def _facts(state: State, verdict: Verdict) -> dict[str, Any]:
    """Return the results for ``scan.json``."""
    shift_mm = 1000 * np.linalg.norm(state.total[:, 3:6], axis=1)
    turn_deg = np.degrees(np.linalg.norm(state.total[:, :3], axis=1))
    scaled = verdict.accepted and state.sigmas[2] > 0
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
        "kept": verdict.accepted,
        "depth_scaled": bool(scaled),
        "frames": len(state.total),
    } | rounded


def _median(values: np.ndarray) -> float:
    return float(np.median(values)) if len(values) else 0.0
