"""Rounds of registration: who sees the same surface, then one joint step of all frames."""

from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.geometry.oriented_points import Surface
from world2minecraft.reconstruction.registration.kernels import UNKNOWNS, move_patches, surfel_means
from world2minecraft.reconstruction.registration.parameters import RegisterParameters
from world2minecraft.reconstruction.registration.solve import Observations, Step, solve
from world2minecraft.reconstruction.registration.surfels import Surfels, find_surfels

# The gap that parts two surfaces and the residual beyond which a patch is no look at its surfel
# narrow from pass to pass: a depth scale that is 10 % off moves a wall at 3 m by 30 cm.
GAPS_M = (0.30, 0.10, 0.05, 0.04)
WIDTHS_M = (0.12, 0.04, 0.015, 0.01)
FIRST_CELLS = 2.0  # The first pass's cells are wider by this, for the same reason.
SAME_WAY = 0.9  # Cosine of 26 degrees between a patch and its surfel.
FIRST_BEND_M = 0.003  # What the depth of patches is off for other reasons than their pixels' noise.
INDEPENDENT = 30  # Regions of an image whose depth bends by itself; patches there err together.
LEAST_NOISE_M = 0.002
SIGMAS_LEAST = np.array([1e-4, 3e-4, 1e-4])  # Radians, metres, log; less would freeze a frame.
SIGMAS_MOST = np.array([0.03, 0.05, 0.15])
GROUPS = (slice(0, 3), slice(3, 6), slice(6, 7))


@dataclass(frozen=True, eq=False)
class State:
    """The patches and cameras as they stand, and what was changed to get here.

    ``total`` float64 [F, 7] is the sum of all steps: turn in radians, shift in metres, log of the
    depth's scale. ``sigmas`` float64 [3] is how far off the three were, as learned so far, and
    ``bend_m`` how far patches still are from their surfels.
    """

    surface: Surface
    total: np.ndarray
    sigmas: np.ndarray
    bend_m: float


def begin(surface: Surface, chosen: RegisterParameters) -> State:
    """Return the state before the first pass; ``surface`` lies in a frame that walls follow."""
    sigmas = np.array([np.radians(chosen.jitter_deg), chosen.jitter_m, chosen.scale_sigma])
    return State(surface, np.zeros((len(surface.cameras), UNKNOWNS)), sigmas, FIRST_BEND_M)


def run_passes(
    state: State, speaks: np.ndarray, chosen: RegisterParameters, first: int = 0
) -> State:
    """Move all frames until their patches meet.

    Args:
        state: where to begin.
        speaks: bool [N], the patches that take part; all are moved.
        chosen: the parameters.
        first: the pass to begin with; later ones look more closely.
    """
    frames = len(state.surface.cameras)
    together = np.sqrt(max(1.0, np.count_nonzero(speaks) / frames / INDEPENDENT))
    for number in range(first, chosen.passes):
        gap_m = GAPS_M[min(number, len(GAPS_M) - 1)]
        width_m = WIDTHS_M[min(number, len(WIDTHS_M) - 1)]
        cell_m = chosen.cell_m * (FIRST_CELLS if number == 0 else 1.0)
        noise_m = max(LEAST_NOISE_M, state.bend_m * together)
        seen = observe(state.surface, speaks, cell_m, gap_m, noise_m)
        prior = np.repeat(state.sigmas, (3, 3, 1))
        state = _stepped(state, solve(seen, state.total, prior, width_m))
    return state


def without_scale(before: State, after: State) -> State:
    """Return the state ``after`` some passes with the depth as it was ``before`` them."""
    change = after.total - before.total
    change[:, 6] = 0.0
    kept = Step(change, np.zeros_like(change), after.bend_m)
    sigmas = after.sigmas * [1.0, 1.0, 0.0]
    return replace(_stepped(before, kept), sigmas=sigmas)


def surfels_of(surface: Surface, cell_m: float, gap_m: float) -> Surfels:
    """Group the patches of a surface."""
    weight = 1 / (surface.sigma_m**2 + 0.002**2)
    return find_surfels(
        surface.points_m, surface.normals, weight, surface.owner, cell_m=cell_m, gap_m=gap_m
    )


def shared(surface: Surface, surfels: Surfels, chosen: np.ndarray) -> np.ndarray:
    """Return the indices of the chosen patches whose surfel faces as they do and is shared."""
    facing = np.einsum("ia,ia->i", surface.normals, surfels.normals[surfels.owner])
    return np.flatnonzero(chosen & (surfels.frames[surfels.owner] > 1) & (facing > SAME_WAY))


def observe(
    surface: Surface, speaks: np.ndarray, cell_m: float, gap_m: float, noise_m: float
) -> Observations:
    """Return what the patches that speak say of their frames' poses."""
    surfels = surfels_of(surface, cell_m, gap_m)
    index = shared(surface, surfels, speaks)
    surfel, frame = surfels.owner[index], surface.owner[index]
    normal = surfels.normals[surfel]
    from_eye = surface.points_m[index] - surface.cameras[frame, :3, 3]
    residual = np.einsum("ia,ia->i", normal, surface.points_m[index] - surfels.centers_m[surfel])
    weight = 1 / (surface.sigma_m[index] ** 2 + noise_m**2)
    count = len(surfels.frames)
    means = surfel_means(residual, weight, surfel, count)
    stretch = np.einsum("ia,ia->i", normal, from_eye)
    # Residuals shrink with the whole room, so that plain least squares would shrink it. Measured
    # in units of their frame's depth they do not; hence the second term.
    stretch -= residual - means[surfel]
    rows = np.column_stack([np.cross(from_eye, normal), normal, stretch])
    return Observations(rows, residual, weight, frame, surfel, len(surface.cameras), count)


def _stepped(state: State, step: Step) -> State:
    """Return the state after a step, with the sigmas that all steps together tell."""
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
    """Return the rotation [3, 3] about a vector by its length in radians."""
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
