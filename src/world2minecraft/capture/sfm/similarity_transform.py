"""A robust similarity transform between two sets of poses, by centres and rotations.

Centres alone rotate and stretch a small path with noisy poses (2.5 % in a trial); rotations hold
it. Both are weighted by how well they agree, and poses that do not fit lose their weight.

Stated poses are often those of another sensor on the same device, or of its wrong lens: a focal
length or a principal point that is off moves and rotates all poses alike, as seen from the camera.
Where that is allowed for, position and rotation of that sensor in the camera are estimated too. On
the real kitchen, with poses of the depth sensor, they bring 84 % of the points within 8 cm of the
sensor's own surface; its position alone 60 %, neither 32 %.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import least_squares

from world2minecraft.core.types import checks
from world2minecraft.geometry.rotations import rotation_from_vector

MOUNT_ROTATION_SIGMA = 0.1  # Radians: sensors on one device look nearly the same way.
MAX_ITERATIONS = 60  # It settles to 1e-9 in about ten, with a mount in thirty.


@dataclass(frozen=True, eq=False)
class Similarity:
    """x -> scale * rotation @ x + shift_m; ``off_m`` and ``off_deg`` [N] are what is left.

    ``mount_m`` is where the stated poses' sensor sits in the camera's own axes, ``mount_turn``
    [3, 3] how it is turned against them.
    """

    scale: float
    rotation: np.ndarray
    shift_m: np.ndarray
    off_m: np.ndarray
    off_deg: np.ndarray
    mount_m: np.ndarray = field(default_factory=lambda: np.zeros(3))
    mount_turn: np.ndarray = field(default_factory=lambda: np.eye(3))

    def __post_init__(self):
        checks.positive("scale", self.scale)
        object.__setattr__(self, "rotation", checks.floats("rotation", self.rotation, (3, 3)))
        object.__setattr__(self, "shift_m", checks.floats("shift_m", self.shift_m, (3,)))

    def points(self, points: np.ndarray) -> np.ndarray:
        """Return points [..., 3] carried over."""
        return self.scale * points @ self.rotation.T + self.shift_m

    def poses(self, poses: np.ndarray) -> np.ndarray:
        """Return camera poses [N, 4, 4] carried over; the cameras themselves do not stretch."""
        carried = np.array(poses, np.float64)
        carried[:, :3, :3] = self.rotation @ carried[:, :3, :3]
        carried[:, :3, 3] = self.points(carried[:, :3, 3])
        return carried


def align_similarity(given: np.ndarray, wanted: np.ndarray, mounted: bool = False) -> Similarity:
    """Return the similarity that carries poses ``given`` to ``wanted``, robust to a wrong third.

    Args:
        given: camera-to-world poses [N, 4, 4] in one frame, N >= 2, with centres apart.
        wanted: the poses [N, 4, 4] of the same cameras in the other frame.
        mounted: ``wanted`` may be of a sensor that sits elsewhere on the device and is turned a
            little; needs eight poses that look in different directions.

    Raises:
        ValueError: shapes differ, there are too few, or all centres coincide.
    """
    given = checks.floats("given", given, (len(given), 4, 4))
    wanted = checks.floats("wanted", wanted, (len(given), 4, 4))
    least = 8 if mounted else 2
    if len(given) < least:
        raise ValueError(f"a similarity needs {least} poses or more, not {len(given)}")
    reach = [float(np.ptp(poses[:, :3, 3], axis=0).max()) for poses in (given, wanted)]
    if min(reach) < 1e-12:
        raise ValueError("all cameras stand in one place: no scale can be found")
    turns = wanted[:, :3, :3] @ given[:, :3, :3].transpose(0, 2, 1)
    a, b, axes = given[:, :3, 3], wanted[:, :3, 3], wanted[:, :3, :3]
    rotation, scale, shift = _initial_similarity(turns, a, b)
    mount = np.zeros(3)
    for _ in range(MAX_ITERATIONS):
        near, turned = _robust_weights(
            turns, a, b - axes @ mount, (rotation, scale, shift), reach[1]
        )
        before = np.concatenate([rotation.ravel(), [scale], mount])
        rotation = _fit_rotation(turns, a, b - axes @ mount, scale, near, turned)
        scale, shift, mount = _fit_scale_and_shift(
            a @ rotation.T, b, axes if mounted else None, near, scale
        )
        after = np.concatenate([rotation.ravel(), [scale], mount])
        if np.allclose(before, after, rtol=1e-12, atol=1e-12):
            break
    found = Similarity(
        scale,
        rotation,
        shift,
        _distances(a, b - axes @ mount, rotation, scale, shift),
        np.degrees(_angles(turns, rotation)),
        mount,
    )
    return _fit_mount_rotation(given, wanted, found, reach[1]) if mounted else found


def _fit_mount_rotation(
    given: np.ndarray, wanted: np.ndarray, start: Similarity, reach_m: float
) -> Similarity:
    """Return a similarity with the sensor's turn found too, by least squares over all at once.

    One after the other they would hold each other fast: the turn takes up whatever the rotation
    leaves. What keeps them apart is that one is the camera's and the other the world's.
    """
    sigma_m = max(1.48 * float(np.median(start.off_m)), 1e-6 * reach_m)
    sigma = max(np.radians(1.48 * float(np.median(start.off_deg))), 1e-6)

    def solved(values: np.ndarray):
        rotation = rotation_from_vector(values[1:4]) @ start.rotation
        scale, turn = start.scale * np.exp(values[0]), rotation_from_vector(values[10:13])
        shift = start.shift_m + values[4:7] * reach_m
        return scale, rotation, shift, values[7:10] * reach_m, turn

    def residuals(values: np.ndarray) -> np.ndarray:
        scale, rotation, shift, mount, turn = solved(values)
        off = wanted[:, :3, 3] - wanted[:, :3, :3] @ mount
        off -= scale * given[:, :3, 3] @ rotation.T + shift
        between = wanted[:, :3, :3].transpose(0, 2, 1) @ rotation @ given[:, :3, :3] @ turn.T
        skew = between - between.transpose(0, 2, 1)
        apart = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=1) / 2
        usual = values[10:13] / MOUNT_ROTATION_SIGMA
        return np.concatenate([(off / sigma_m).ravel(), (apart / sigma).ravel(), usual])

    first = np.concatenate([np.zeros(7), start.mount_m / reach_m, np.zeros(3)])
    best = least_squares(residuals, first, loss="cauchy", xtol=1e-14, ftol=1e-14, gtol=1e-14)
    scale, rotation, shift, mount, turn = solved(best.x)
    centers = wanted[:, :3, 3] - wanted[:, :3, :3] @ mount
    off_m = _distances(given[:, :3, 3], centers, rotation, scale, shift)
    turns = wanted[:, :3, :3] @ turn @ given[:, :3, :3].transpose(0, 2, 1)
    off_deg = np.degrees(_angles(turns, rotation))
    return Similarity(float(scale), rotation, shift, off_m, off_deg, mount, turn)


def _initial_similarity(turns: np.ndarray, given: np.ndarray, wanted: np.ndarray):
    """Return the rotation that half of the poses agree with best, and scale and shift by it."""
    medians = [np.median(_angles(turns, turn)) for turn in turns]
    rotation = turns[int(np.argmin(medians))]
    a, b = given @ rotation.T, wanted
    first, second = np.triu_indices(len(a), 1)
    if len(first) > 20_000:
        some = np.linspace(0, len(first) - 1, 20_000).astype(np.intp)
        first, second = first[some], second[some]
    lengths = np.linalg.norm(a[first] - a[second], axis=1)
    # Long ways tell the scale best, and a median of ratios bears a third of wrong ones.
    long = lengths >= np.median(lengths)
    ways = np.linalg.norm(b[first] - b[second], axis=1)[long] / np.maximum(lengths[long], 1e-300)
    scale = max(float(np.median(ways)), 1e-12)
    return rotation, scale, np.median(b - scale * a, axis=0)


def _robust_weights(turns, given, wanted, found, reach_m) -> tuple[np.ndarray, np.ndarray]:
    """Return what centres and rotations weigh, by the square of Cauchy's weight over variance."""
    rotation, scale, shift = found
    off_m = _distances(given, wanted, rotation, scale, shift)
    angles = _angles(turns, rotation)
    sigma_m = max(1.48 * float(np.median(off_m)), 1e-9 * reach_m)
    sigma = max(1.48 * float(np.median(angles)), 1e-9)
    near = 1 / (1 + (off_m / sigma_m) ** 2) ** 2 / sigma_m**2
    return near, 1 / (1 + (angles / sigma) ** 2) ** 2 / sigma**2


def _fit_rotation(turns, given, wanted, scale, near, turned) -> np.ndarray:
    """Return the rotation that both the centres and the poses' own rotations pull to."""
    a = given - np.average(given, axis=0, weights=near)
    b = wanted - np.average(wanted, axis=0, weights=near)
    pull = scale * np.einsum("i,ia,ib->ab", near, b, a) + np.einsum("i,iab->ab", turned, turns)
    left, _, right = np.linalg.svd(pull)
    return left @ np.diag([1, 1, np.linalg.det(left @ right)]) @ right


def _fit_scale_and_shift(turned, wanted, axes, near, scale) -> tuple[float, np.ndarray, np.ndarray]:
    """Return scale, shift and mount by weighted least squares, the rotation being known."""
    count = len(turned)
    columns = [turned.reshape(-1, 1), np.tile(np.eye(3), (count, 1))]
    if axes is not None:
        columns.append(axes.reshape(-1, 3))
    root = np.repeat(np.sqrt(near / near.max()), 3)
    found = np.linalg.lstsq(
        np.concatenate(columns, axis=1) * root[:, None], wanted.reshape(-1) * root, rcond=1e-9
    )[0]
    mount = found[4:] if axes is not None else np.zeros(3)
    return (float(found[0]) if found[0] > 0 else scale), found[1:4], mount


def _distances(given, wanted, rotation, scale, shift) -> np.ndarray:
    return np.linalg.norm(wanted - scale * given @ rotation.T - shift, axis=1)


def _angles(turns: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """Return the angle in rad between each turn and the rotation, exact where it is small."""
    chord = np.linalg.norm(turns - rotation, axis=(1, 2))
    return 2 * np.arcsin(np.minimum(chord / np.sqrt(8), 1))
