"""Creation of ``truth.npz`` and ``truth.json`` for a ScanNet scene.

The labelled surface is converted to fine voxels with the most frequent class and object in each.
Triangles are divided into pieces smaller than a voxel, and the point half a voxel behind the centre
of each piece determines the voxel to fill. A wall whose face is between two voxels therefore fills
the rear one, like a solid wall. The order of a triangle's corners determines its rear side. Because
the solid side of the floor is below it, the floor shows whether a file uses the opposite order.

Free voxels are those that the cameras saw through. A ray only counts if the mesh and the depth
image agree on its end. Where the sensor measured nothing (a screen, a window) or the mesh has a
hole, the free space along the ray is unknown.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from world2minecraft.capture.depth_images import DepthEncoding, read_depth
from world2minecraft.capture.format_detection import SOURCES
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.capture.validation import evenly_spaced, validate_capture
from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import CaptureError, DamagedFileError, InputError, LimitError
from world2minecraft.core.files import write_json, write_npz
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.evaluation.scoring.observed_cells import (
    CROSSED,
    MAX_CELLS,
    Believed,
    reached_cells,
)
from world2minecraft.evaluation.scoring.scannet.labelled_mesh import (
    LabelledMesh,
    labelled_meshes,
    read_labelled_mesh,
)
from world2minecraft.evaluation.scoring.truth_files import Truth
from world2minecraft.evaluation.scoring.used_frames import UsedFrame
from world2minecraft.procgen.virtual_scan import object_to_json

PIECE = 0.75  # Longest side of a piece, in voxels.
MARGIN = 2  # Free voxels around the surface.
CHUNK_M2 = 4.0  # Of surface at a time, some 200,000 pieces.
MAX_VALUES = 1 << 16

MAX_FRAMES = 200  # Evenly spread over the recording: seven a second of a walk of half a minute.
APART_M, APART_SHARE = 0.08, 0.05  # A cell, or what such sensors err by at 2 m and beyond.

RECORDINGS = ("scannet_sens", "scannet_folder")
VOXEL_M = 0.02  # As for generated rooms: a quarter of a cell.


@dataclass(frozen=True, eq=False)
class SurfaceVoxels:
    """The voxels of a surface.

    Attributes:
        labels: The classes as uint8 [A, B, C], or 255 without a surface or a class.
        surface: The surface voxels as bool [A, B, C].
        instance: The objects as uint16 [A, B, C].
        origin_m: The minimum corner in metres, a multiple of the voxel size, as float64 [3].
    """

    labels: np.ndarray
    surface: np.ndarray
    instance: np.ndarray
    origin_m: np.ndarray


def surface_voxels(mesh: LabelledMesh, voxel_m: float) -> SurfaceVoxels:
    """Convert a mesh to surface voxels.

    Args:
        mesh: The upright mesh in metres.
        voxel_m: The voxel size in metres.

    Raises:
        LimitError: If the mesh spans too many voxels.
    """
    low = np.floor(mesh.vertices_m.min(axis=0) / voxel_m).astype(np.int64) - MARGIN
    high = np.ceil(mesh.vertices_m.max(axis=0) / voxel_m).astype(np.int64) + MARGIN
    shape = high - low
    if np.prod(shape, dtype=np.float64) > MAX_CELLS:
        sides = " x ".join(f"{side * voxel_m:.0f}" for side in shape)
        raise LimitError(mesh.name, f"mesh spans {sides} m, too large for a single room")
    first, second, third = mesh.triangles.T
    chosen = np.where(mesh.classes[second] == mesh.classes[third], second, first)
    classes, instance = mesh.classes[chosen], mesh.instance[chosen]
    inward = -_normals(mesh, classes)
    votes_of = {"class": _Votes(), "instance": _Votes()}
    for middles, owner in _pieces(mesh.vertices_m[mesh.triangles], PIECE * voxel_m):
        inside = middles + inward[owner] * (voxel_m / 2)
        cells = np.floor(inside / voxel_m).astype(np.int64) - low
        at = np.asarray(np.ravel_multi_index(tuple(cells.T), tuple(shape)))
        votes_of["class"].add(at, classes[owner])
        votes_of["instance"].add(at, instance[owner])
    labels = np.full(shape, UNKNOWN, np.uint8)
    surface, owners = np.zeros(shape, bool), np.zeros(shape, np.uint16)
    at, most = votes_of["class"].winners()
    labels.reshape(-1)[at], surface.reshape(-1)[at] = most, True
    at, most = votes_of["instance"].winners()
    owners.reshape(-1)[at] = most
    return SurfaceVoxels(labels, surface, owners, low * voxel_m)


class _Votes:
    """Counts of values by voxel, collected in chunks."""

    def __init__(self) -> None:
        self.keys: list[np.ndarray] = []
        self.counts: list[np.ndarray] = []

    def add(self, at: np.ndarray, values: np.ndarray) -> None:
        """Add values [N] below ``MAX_VALUES`` for the voxels with flat indices [N]."""
        keys, counts = np.unique(at * MAX_VALUES + values, return_counts=True)
        self.keys.append(keys)
        self.counts.append(counts)

    def winners(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the flat indices of the voxels, and the most frequent value of each.

        In a tie, the lowest value is returned.
        """
        keys, group = np.unique(np.concatenate(self.keys), return_inverse=True)
        counts = np.bincount(group, np.concatenate(self.counts)).astype(np.int64)
        at, values = keys // MAX_VALUES, keys % MAX_VALUES
        order = np.lexsort((-values, counts, at))
        last = np.flatnonzero(np.append(np.diff(at[order]) > 0, True))
        return at[order][last], values[order][last]


def _normals(mesh: LabelledMesh, classes: np.ndarray) -> np.ndarray:
    """Return outward unit normals as float64 [T, 3], with 0 for degenerate triangles."""
    corners = mesh.vertices_m[mesh.triangles]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    if cross[classes == SemanticClass.FLOOR, 2].sum() < 0:
        cross = -cross
    return cross / np.maximum(np.linalg.norm(cross, axis=1), 1e-300)[:, None]


def _pieces(corners: np.ndarray, longest_m: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield the centres of small pieces, float64 [P, 3], and their triangle indices, int64 [P]."""
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    chunk = (np.linalg.norm(cross, axis=1) / 2).cumsum() // CHUNK_M2
    starts = np.append(np.flatnonzero(np.diff(chunk, prepend=-1)), len(corners))
    for start, stop in pairwise(starts):
        yield _cut(corners[start:stop], np.arange(start, stop), longest_m)


def _cut(corners: np.ndarray, owner: np.ndarray, longest_m: float) -> tuple[np.ndarray, np.ndarray]:
    """Halve triangles [T, 3, 3] at their longest sides until all sides are short enough."""
    middles, owners = [], []
    while len(corners):
        sides = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
        is_long = sides.max(axis=1) > longest_m
        middles.append(corners[~is_long].mean(axis=1))
        owners.append(owner[~is_long])
        corners, owner = corners[is_long], owner[is_long]
        turned = (sides[is_long].argmax(axis=1)[:, None] + np.arange(3)) % 3
        a, b, c = np.take_along_axis(corners, turned[..., None], axis=1).transpose(1, 0, 2)
        middle = (a + b) / 2
        halves = (np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1))
        corners, owner = np.concatenate(halves), np.concatenate([owner, owner])
    return np.concatenate(middles), np.concatenate(owners)


def seen_free(truth: Truth, progress: Progress = no_progress) -> np.ndarray:
    """Return the voxels that rays of the capture passed through, as bool [A, B, C].

    Args:
        truth: A scanned surface whose ``capture`` has depth images and poses.
        progress: Called with the stage ``seen``.

    Raises:
        CaptureError: If the capture has no frame with a pose and depth.
    """
    judged = validate_capture(truth.capture, ScanOptions())
    usable = [f for f in judged.frames if f.depth_path and f.camera_to_world is not None]
    if not usable:
        raise CaptureError(
            truth.capture, "no depth images with camera poses found; provide the scene's .sens file"
        )
    frames = {frame.name: frame for frame in evenly_spaced(usable, MAX_FRAMES)}
    scan_to_truth = invert_rigid(truth.truth_to_scan)
    used = [_used(frame, scan_to_truth) for frame in frames.values()]
    agreed = _agreed(frames, judged.encoding, progress)
    reached = reached_cells(truth, used, np.eye(4), truth.voxel_m, believed=agreed)
    start = np.round(truth.origin_m / truth.voxel_m).astype(np.int64) - reached.low
    inside = tuple(slice(a, a + n) for a, n in zip(start, truth.labels.shape, strict=True))
    return (reached.flags[inside] & CROSSED) > 0


def _used(frame: FrameFiles, scan_to_truth: np.ndarray) -> UsedFrame:
    colour_to_scan = np.asarray(frame.camera_to_world, np.float64)
    depth_to_scan = colour_to_scan @ frame.depth_to_colour
    camera = frame.depth_camera
    if camera is None:
        raise CaptureError(frame.name, "a depth image has no camera")
    truly = scan_to_truth @ depth_to_scan
    return UsedFrame(frame.name, camera, truly, scan_to_truth @ colour_to_scan, depth_to_scan)


def _agreed(
    frames: Mapping[str, FrameFiles], encoding: DepthEncoding, progress: Progress
) -> Believed:
    """Return a function that selects the rays that agree with the depth image of their frame."""
    done = {"frames": 0}

    def agreed(used: UsedFrame, depth_m: np.ndarray) -> np.ndarray:
        """Return the rays that agree with the frame's depth image, bool [H, W]."""
        done["frames"] += 1
        progress("seen", done["frames"], len(frames), used.name)
        path = frames[used.name].depth_path
        try:
            measured = read_depth(path, encoding) if path else np.zeros((1, 1), np.float32)
        except DamagedFileError:
            return np.zeros(depth_m.shape, bool)
        rows, columns = (
            ((np.arange(side) + 0.5) * (full / side)).astype(np.int64)
            for side, full in zip(depth_m.shape, measured.shape, strict=True)
        )
        there = measured[np.ix_(rows, columns)]
        allowed = np.maximum(APART_M, APART_SHARE * depth_m)
        return (there > 0) & (np.abs(there - depth_m) <= allowed)

    return agreed


@dataclass(frozen=True)
class TruthMade:
    """A summary of a ground truth.

    Attributes:
        name: The name of the scene.
        size_m: The size of the surface in metres.
        surface: The number of surface voxels.
        annotated_share: The share of surface voxels that have a class.
        free: The number of free voxels.
        objects: The number of objects.
    """

    name: str
    size_m: tuple[float, float, float]
    surface: int
    annotated_share: float
    free: int
    objects: int


def scenes_in(place: Path) -> list[Path]:
    """Return a ScanNet scene, or the scenes in a folder, sorted by name.

    Raises:
        InputError: If there are no scenes.
    """
    if labelled_meshes(place):
        return [place]
    inner = sorted(place.iterdir()) if place.is_dir() else []
    found = [folder for folder in inner if labelled_meshes(folder)]
    if not found:
        raise InputError(
            place, "no *_vh_clean_2.labels.ply found; give a ScanNet scene, or a folder of scenes"
        )
    return found


def write_scannet_truth(
    scene: Path, out: Path | None = None, progress: Progress = no_progress
) -> TruthMade:
    """Create and write the ground truth of a ScanNet scene.

    Args:
        scene: The folder with the labelled mesh, and the ``.sens`` file or exported frames.
        out: The output folder. None uses the folder of the scene.
        progress: Called with the stages ``mesh`` and ``seen``.

    Raises:
        InputError: If a file of the scene is missing or damaged.
        OutputError: If the output folder cannot be written.
    """
    progress("mesh", 0, 1, scene.name)
    mesh = read_labelled_mesh(scene)
    # Asked first: a mesh alone is a capture too, of another kind.
    if not any(SOURCES.load(name)().recognise(scene) for name in RECORDINGS):
        raise CaptureError(
            scene,
            f"no frames found; add {mesh.name}.sens, or the exported folders color, depth and pose",
        )
    voxels = surface_voxels(mesh, VOXEL_M)
    progress("mesh", 1, 1, scene.name)
    truth = Truth(
        folder=scene if out is None else out,
        labels=voxels.labels,
        voxel_m=VOXEL_M,
        origin_m=voxels.origin_m,
        truth_to_scan=mesh.truth_to_scan,
        objects=mesh.objects,
        surface=voxels.surface,
        capture=scene,
    )
    free = seen_free(truth, progress) & ~voxels.surface
    truth = replace(truth, labels=np.where(free, 0, truth.labels).astype(np.uint8))
    _write(truth, voxels.instance, mesh.name)
    return _told(mesh.name, truth, free)


def _write(truth: Truth, instance: np.ndarray, name: str) -> None:
    arrays = {
        "labels": truth.labels,
        "instance": instance,
        "surface": np.asarray(truth.surface),
        "voxel_m": np.array(truth.voxel_m),
        "origin_m": truth.origin_m,
        "truth_room_to_scan": truth.truth_to_scan,
    }
    write_npz(truth.folder / "truth.npz", arrays)
    is_separate = truth.capture.resolve() != truth.folder.resolve()
    stated = {
        "kind": "scannet",
        "scene": name,
        "objects": [object_to_json(n, item) for n, item in enumerate(truth.objects, start=1)],
        "layouts": [],
    }
    where = {"capture": str(truth.capture.resolve())} if is_separate else {}
    write_json(truth.folder / "truth.json", stated | where)


def _told(name: str, truth: Truth, free: np.ndarray) -> TruthMade:
    surface = np.asarray(truth.surface)
    held = np.argwhere(surface)
    size = (held.max(axis=0) + 1 - held.min(axis=0)) * truth.voxel_m
    classed = int((surface & (truth.labels != UNKNOWN)).sum())
    return TruthMade(
        name=name,
        size_m=(float(size[0]), float(size[1]), float(size[2])),
        surface=len(held),
        annotated_share=classed / len(held),
        free=int(free.sum()),
        objects=len(truth.objects),
    )
