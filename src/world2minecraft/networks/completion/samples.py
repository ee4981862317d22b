"""Training samples for the completion network: the input from a virtual scan, and the ground truth.

The ground truth is the grid of the room, resampled to the cells with the rule used for scoring
reconstructions. Up to ``OUTSIDE_CELLS`` beyond the rooms that the scan has observed it is empty, so
that the network leaves the space behind walls empty; further cells and other rooms are 255. Frames
of real data sets have a ground truth on the observed surface only, from their label images
(``labelled_sample``).

The samples cover rooms of all kinds and shapes, tidy and cluttered, and houses. Training uses seeds
from 10,000 upwards, so the seeds of the benchmarks (1000 to 1049 and 2000 to 2019, and 500 to 549
for tuning) and the ``held_out`` seeds, which are all lower, are never used for training.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.coordinates import apply, rotation_about_z
from world2minecraft.core.errors import CaptureError, DamagedFileError, World2MinecraftError
from world2minecraft.core.files import npz_array_names, read_npz, write_npz
from world2minecraft.core.types import Camera, FusedEvidence
from world2minecraft.evaluation.metrics.truth_resampling import carry_truth
from world2minecraft.networks.completion.sensor_noise import ScanNoise, draw_noise
from world2minecraft.networks.completion.virtual_views import (
    TOUR_VIEWS,
    ScanKind,
    VirtualScan,
    draw_scan,
    fuse_scan,
    lean_scan,
)
from world2minecraft.procgen import generate_house, generate_room
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.procgen.sensors.navmesh import is_inside
from world2minecraft.procgen.sensors.photo_rendering import prepare_photos
from world2minecraft.procgen.sensors.trajectory import plan_trajectory
from world2minecraft.reconstruction.fusion import CleaningParameters, extract_grid, remove_floaters
from world2minecraft.reconstruction.semantics.completion_channels import Sight, sight_of
from world2minecraft.reconstruction.semantics.completion_labeller import hint_of
from world2minecraft.reconstruction.semantics.geometric_labeller import GeometricLabeller

FIRST_SEED = 10_000
HOUSE_SHARE = 0.06  # A house takes four times as long as a room.
BOX_SHARE = 0.6
# The kinds of rooms that people scan most are the most frequent.
KIND_SHARES = {
    "living": 0.17,
    "bed": 0.17,
    "kitchen": 0.15,
    "office": 0.12,
    "dining": 0.11,
    "study": 0.1,
    "children": 0.08,
    "bathroom": 0.06,
    "hall": 0.04,
}
LOOKS: tuple[ScanKind, ...] = ("walk", "few", "single", "single", "single")
SHELL_CELLS = 2  # Cells of wall, slab and ceiling around a room that count as its own.
OUTSIDE_CELLS = 10  # Cells beyond a room that are known to be empty.
MAX_CELLS = (96, 96, 44)
FRAME_CELLS = (60, 60, 36)  # Of the grids of single frames.
PLAN_CAMERA = Camera(160, 120, 129.7, 129.7, 80.0, 60.0)
FIELDS = ("log_odds", "at", "hits", "colour", "offset", "votes", "hint")


def training_room(seed: int) -> Room:
    """Generate the room or house for a seed. The same seed always gives the same result."""
    rng = np.random.default_rng([seed, 11])
    clutter = float(rng.choice([0.0, rng.uniform(0, 1)], p=[0.2, 0.8]))
    if rng.random() < HOUSE_SHARE:
        return generate_house(seed, rooms=int(rng.integers(3, 5)), clutter=clutter)
    kind = str(rng.choice(list(KIND_SHARES), p=list(KIND_SHARES.values())))
    shape = "box" if rng.random() < BOX_SHARE else None
    try:
        return generate_room(seed, kind=kind, clutter=clutter, shape=shape)
    except World2MinecraftError:  # A few kinds do not fit into a few shapes.
        return generate_room(seed, kind=kind, clutter=clutter)


@dataclass(frozen=True, eq=False)
class Sample:
    """A training sample.

    Attributes:
        sight: Input of the network. Its votes are those of the true labels; ``simulate_votes``
            makes votes of a segmentation network of them.
        truth: Class of each cell (0 to 11 or 255), uint8 [X, Y, Z].
        kind: Kind of the scan.
        hinted: Whether the geometric labeller was used, which requires walls along the axes.
        false_share: Fraction of the occupied input cells with known ground truth that are empty in
            the ground truth.
    """

    sight: Sight
    truth: np.ndarray
    kind: str
    hinted: bool
    false_share: float


def make_samples(seed: int) -> list[Sample]:
    """Create the samples for the room of a seed. The same seed always gives the same result.

    There is one sample for each scan in ``LOOKS``, except for scans that observe almost nothing.
    """
    room = training_room(seed)
    scene = prepare_photos(room)
    rng = np.random.default_rng([seed, 12])
    views = TOUR_VIEWS * (2 if len(room.layouts) > 1 else 1)
    tour = plan_trajectory(room, scene.scene, PLAN_CAMERA, views, rng)
    samples = []
    for number, kind in enumerate(LOOKS):
        rng = np.random.default_rng([seed, 13, number])
        noise = draw_noise(rng, kind)
        look = lean_scan(draw_scan(kind, tour, rng), noise.lean_deg)
        try:
            evidence = fuse_scan(room, scene, look, noise, rng)
        except CaptureError:
            continue
        sample = make_sample(room, look, noise, evidence, rng)
        if len(sample.sight.at) > 300:
            samples.append(sample)
    return samples


def make_sample(
    room: Room,
    look: VirtualScan,
    noise: ScanNoise,
    evidence: FusedEvidence,
    rng: np.random.Generator,
) -> Sample:
    """Create the sample for a fused scan."""
    grid = remove_floaters(extract_grid(evidence), CleaningParameters())
    hint = hint_of(*GeometricLabeller().traced(grid, evidence)) if look.in_room_axes else None
    truth_to_grid = look.room_to_grid.copy()
    truth_to_grid[:3, :3] = truth_to_grid[:3, :3] @ rotation_about_z(noise.yaw_error_deg)[:3, :3]
    truth_to_grid[:3, 3] += noise.misfit_m
    low, shape = _box(room, look, evidence, truth_to_grid, rng)
    voxel_m = evidence.voxel_m
    truth = carry_truth(
        room.labels, room.voxel_m, room.origin_m, truth_to_grid, shape, low * voxel_m, voxel_m
    )
    start = low - np.round(evidence.origin_m / voxel_m).astype(np.int64)
    sight = replace(
        crop_input(sight_of(grid, evidence, hint), start, shape), bottom_m=low[2] * voxel_m
    )
    seen, other = mask_rooms(room, truth_to_grid, low, voxel_m, sight.log_odds)
    away = np.asarray(ndimage.distance_transform_edt(~seen))
    near = (away <= OUTSIDE_CELLS) & seen.any()
    empty = near & ~seen & ~other & ((truth == 0) | (truth == UNKNOWN))
    truth[~seen] = UNKNOWN
    truth[empty] = 0
    there = truth.reshape(-1)[sight.at]
    false = float((there == 0).sum() / max((there != UNKNOWN).sum(), 1))
    return Sample(sight, truth, look.kind, hint is not None, false)


def crop_input(sight: Sight, start: np.ndarray, shape: tuple[int, int, int]) -> Sight:
    """Crop the network input to a box of cells. Cells outside the input are unknown."""
    old = sight.log_odds.shape
    first, last = np.maximum(start, 0), np.minimum(start + shape, old)
    odds = np.zeros(shape, np.int8)
    if (first < last).all():
        source = tuple(slice(a, b) for a, b in zip(first, last, strict=True))
        target = tuple(slice(a, b) for a, b in zip(first - start, last - start, strict=True))
        odds[target] = sight.log_odds[source]
    cells = np.stack(np.unravel_index(sight.at, old), axis=1) - start
    inside = np.asarray(((cells >= 0) & (cells < shape)).all(axis=1))
    at = np.asarray(np.ravel_multi_index(tuple(cells[inside].T), shape), np.int32)
    bottom = sight.bottom_m
    bottom = None if bottom is None else bottom + float(start[2]) * sight.voxel_m
    return replace(with_rows(sight, inside, log_odds=odds, at=at), bottom_m=bottom)


def with_rows(sight: Sight, rows: np.ndarray, *, log_odds: np.ndarray, at: np.ndarray) -> Sight:
    """Return a network input with other cells and only the given rows of its occupied cells."""
    selected = {
        name: None if (value := getattr(sight, name)) is None else value[rows]
        for name in FIELDS[2:]
    }
    return replace(sight, log_odds=log_odds, at=at, **selected)


def _box(
    room: Room,
    look: VirtualScan,
    evidence: FusedEvidence,
    room_to_grid: np.ndarray,
    rng: np.random.Generator,
) -> tuple[np.ndarray, tuple[int, int, int]]:
    """Return the first cell and the shape of a sample's box."""
    voxel_m = evidence.voxel_m
    seen_low = np.round(evidence.origin_m / voxel_m).astype(np.int64)
    seen_high = seen_low + evidence.log_odds.shape
    if look.kind == "single":
        shape = np.array(FRAME_CELLS)
        low = (seen_low + seen_high - shape) // 2 + rng.integers(-4, 5, 3)
        if not look.in_room_axes:
            camera = apply(room_to_grid, look.poses[0, :3, 3]) / voxel_m
            low[:2] = np.floor(camera[:2]) - [30, 2] + rng.integers(-3, 4, 2)
        low[2] = rng.integers(-3, 0)
        return low, FRAME_CELLS
    corners = np.array(list(np.ndindex(2, 2, 2))) * room.labels.shape * room.voxel_m
    walls = apply(room_to_grid, corners + room.origin_m) / voxel_m
    low = np.minimum(seen_low, np.floor(walls.min(axis=0)).astype(np.int64))
    high = np.maximum(seen_high, np.ceil(walls.max(axis=0)).astype(np.int64))
    # For a house, the part around the observed cells.
    shape = np.minimum(high - low, MAX_CELLS)
    middle = (seen_low + seen_high) // 2
    low = np.clip(middle - shape // 2, low, high - shape)
    low[2] = max(low[2], -4)
    return low, tuple(int(side) for side in shape)  # type: ignore[return-value]


def mask_rooms(
    room: Room, room_to_grid: np.ndarray, low: np.ndarray, voxel_m: float, log_odds: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the cells of the rooms that a scan has observed, and of other rooms.

    A room includes its walls, floor and ceiling. It is observed if at least 5 % of its cells were
    observed as free.

    Args:
        room: Room or house.
        room_to_grid: Rigid transform from the room to the frame of the cells, float64 [4, 4].
        low: First cell of the box.
        voxel_m: Size of a cell in metres.
        log_odds: Evidence in the box [X, Y, Z]; below 0 free.

    Returns:
        Two masks, bool [X, Y, Z].
    """
    shape = log_odds.shape
    middles = (np.moveaxis(np.indices(shape), 0, -1).reshape(-1, 3) + low + 0.5) * voxel_m
    places = apply(np.linalg.inv(room_to_grid), middles)
    seen, other = np.zeros((2, *shape), bool)
    around = ndimage.generate_binary_structure(3, 3)
    for layout in room.layouts:
        top_m = layout.floor_z_m + layout.wall_height_m
        inside = is_inside(layout.floor_polygon_m, places[:, :2])
        inside &= (places[:, 2] > layout.floor_z_m) & (places[:, 2] < top_m)
        inside = inside.reshape(shape)
        free = (log_odds[inside] < 0).mean() if inside.any() else 0
        is_seen = free >= 0.05 or len(room.layouts) == 1
        mask = seen if is_seen else other
        mask |= ndimage.binary_dilation(inside, around, iterations=SHELL_CELLS)
    return seen, other & ~seen


def labelled_sample(evidence: FusedEvidence) -> Sample:
    """Create the sample for a fused frame of a data set, with its labels as votes.

    The ground truth is the label with the most votes on observed surface, empty in observed free
    cells, and 255 elsewhere.
    """
    grid = remove_floaters(extract_grid(evidence), CleaningParameters())
    hint = hint_of(*GeometricLabeller().traced(grid, evidence))
    sight = sight_of(grid, evidence, hint)
    truth = np.where(sight.log_odds < 0, np.uint8(0), np.uint8(UNKNOWN))
    if sight.votes is not None:
        named = sight.votes.any(axis=1)
        kinds = sight.votes[named].argmax(axis=1).astype(np.uint8) + 1
        truth.reshape(-1)[sight.at[named]] = kinds
    return Sample(sight, truth, "frame", hinted=True, false_share=0.0)


def write_samples(path: Path, samples: list[Sample]) -> None:
    """Write the samples of a seed to a file."""
    arrays: dict[str, np.ndarray] = {"count": np.array(len(samples))}
    for n, sample in enumerate(samples):
        for name in FIELDS:
            value = getattr(sample.sight, name)
            if value is not None:
                arrays[f"{name}_{n}"] = value
        arrays[f"truth_{n}"] = sample.truth
        arrays[f"facts_{n}"] = np.array(
            [sample.sight.voxel_m, sample.sight.bottom_m or 0.0, sample.hinted, sample.false_share]
        )
        arrays[f"kind_{n}"] = np.array(sample.kind)
    write_npz(path, arrays)


def read_samples(path: Path) -> list[Sample]:
    """Read a file written by ``write_samples``.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not valid.
    """
    arrays = read_npz(path, npz_array_names(path))
    try:
        return _samples_of(arrays)
    except (KeyError, ValueError) as error:
        raise DamagedFileError(path, f"not a valid sample file ({error})") from error


def _samples_of(arrays: dict[str, np.ndarray]) -> list[Sample]:
    samples = []
    for n in range(int(arrays["count"])):
        voxel_m, bottom_m, hinted, false = arrays[f"facts_{n}"].tolist()
        sight = Sight(
            voxel_m=voxel_m,
            bottom_m=bottom_m,
            **{name: arrays.get(f"{name}_{n}") for name in FIELDS},  # type: ignore[arg-type]
        )
        kind = str(arrays[f"kind_{n}"])
        samples.append(Sample(sight, arrays[f"truth_{n}"], kind, bool(hinted), false))
    return samples
