"""Oracle stages: ground truth in place of fusion, labels, instances or templates.

After oracle fusion, the geometry is correct but the votes and colours are those of the real images.
Each cell that a noise-free ray reached or crossed is occupied or free as in the ground truth, and
each pixel of the 2D labels votes for the cell where its ray truly ends, whether its label is right
or wrong. The result shows what the labelling stage can achieve with correct geometry.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import CLASS_COUNT, OBJECT_CLASSES, UNKNOWN
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.errors import World2MinecraftError
from world2minecraft.core.types import (
    OBSERVED,
    OWN_CELLS,
    UNSEEN,
    Camera,
    FusedEvidence,
    ObjectInstance,
    OccupancyGrid,
    Placement,
    View,
)
from world2minecraft.evaluation.scoring.observed_cells import PUSH_M, RAYS_WIDE, pinhole
from world2minecraft.evaluation.scoring.score import TrueRoom, placed
from world2minecraft.evaluation.scoring.truth_files import read_instances
from world2minecraft.formats.objects_and_placements import (
    read_objects,
    read_placements,
    write_objects,
    write_placements,
)
from world2minecraft.formats.run_arrays import read_room, write_room
from world2minecraft.furniture import template
from world2minecraft.rendering.scene_tables import FACE_NORMALS
from world2minecraft.rendering.voxel_camera import VoxelScene, cast_voxels, prepare_voxels

SURE_LOG_ODDS = 6.0  # The limit of the fusion.


@dataclass(eq=False)
class _Sums:
    """The pixel sums of the cells of a box, as flat arrays with a row per cell."""

    votes: np.ndarray  # float32 [C, 12]
    colour: np.ndarray  # float64 [C, 3]
    offset: np.ndarray  # float64 [C, 3], metres
    hits: np.ndarray  # int64 [C]


def true_evidence(room: TrueRoom, views: Iterable[View], scan_to_room: np.ndarray) -> FusedEvidence:
    """Return the evidence that perfect geometry would give.

    Args:
        room: The ground truth in the frame of ``scan_to_room``.
        views: The views of the capture, of which only colours and labels are used.
        scan_to_room: The 4x4 transform to store in the evidence.
    """
    shape = room.labels.shape
    occupied = room.reached.scored & (room.labels > 0) & (room.labels != UNKNOWN)
    free = room.reached.scored & (room.labels == 0)
    cells = int(np.prod(shape))
    sums = _Sums(
        np.zeros((cells, CLASS_COUNT), np.float32), np.zeros((cells, 3)), np.zeros((cells, 3)),
        np.zeros(cells, np.int64),
    )  # fmt: skip
    truth = room.truth
    scene = prepare_voxels(truth.solid, truth.voxel_m, truth.origin_m)
    frames = {frame.name: frame for frame in room.frames}
    for view in views:
        if view.name in frames and view.colour_camera is not None:
            pose = frames[view.name].colour_to_truth
            _add_view(sums, room, scene, view, view.colour_camera, pose, occupied)
    _fill(sums, occupied)
    log_odds = np.zeros(shape, np.float16)
    log_odds[occupied], log_odds[free] = SURE_LOG_ODDS, -SURE_LOG_ODDS
    return FusedEvidence(
        log_odds=log_odds,
        votes=np.minimum(sums.votes, 60_000).reshape(*shape, CLASS_COUNT).astype(np.float16),
        colour_sum=sums.colour.reshape(*shape, 3).astype(np.float32),
        offset_sum=sums.offset.reshape(*shape, 3).astype(np.float32),
        hits=np.minimum(sums.hits, 65_535).reshape(shape).astype(np.uint16),
        voxel_m=room.reached.voxel_m,
        origin_m=room.reached.low * room.reached.voxel_m,
        scan_to_room=scan_to_room,
    )


def _add_view(
    sums: _Sums,
    room: TrueRoom,
    scene: VoxelScene,
    view: View,
    stated: Camera,
    camera_to_truth: np.ndarray,
    occupied: np.ndarray,
) -> None:
    """Add the pixels of one view to the cells where their rays truly end."""
    camera = pinhole(stated, RAYS_WIDE)
    hits = cast_voxels(scene, camera, camera_to_truth)
    rows, columns = np.nonzero(hits.voxel_index >= 0)
    surface, cell = _ends(room, camera, camera_to_truth, hits, rows, columns, occupied)
    valid = cell >= 0
    cell, surface = cell[valid], surface[valid]
    pixels = _pixels(stated, camera, rows[valid], columns[valid])
    # Sums over the cells that this view touches alone: a house has far more.
    touched, at = np.unique(cell, return_inverse=True)
    count = len(touched)
    sums.hits[touched] += np.bincount(at, minlength=count)
    place = np.stack(np.unravel_index(cell, room.labels.shape), axis=1) + room.reached.low + 0.5
    offset = surface - place * room.reached.voxel_m
    for axis in range(3):
        sums.offset[touched, axis] += np.bincount(at, offset[:, axis], count)
        if view.colour is not None:
            tone = view.colour[..., axis][pixels].astype(np.float64)
            sums.colour[touched, axis] += np.bincount(at, tone, count)
    if view.labels is not None:
        voted = view.labels[pixels].astype(np.int64)
        voting = (voted > 0) & (voted < CLASS_COUNT)
        pairs = at[voting] * CLASS_COUNT + voted[voting]
        votes = np.bincount(pairs, minlength=count * CLASS_COUNT)
        sums.votes[touched] += votes.reshape(count, CLASS_COUNT).astype(np.float32)


def _ends(room, camera, camera_to_truth, hits, rows, columns, occupied):
    """Return the end points of rays in metres of the room [N, 3], and their flat cell indices.

    The cell is that of the surface, or else of the centre of the voxel, if it is truly occupied. If
    neither is, the index is -1.
    """
    truth, reached = room.truth, room.reached
    z = hits.depth_m[rows, columns].astype(np.float64)
    x = (columns + 0.5 - camera.cx_px) / camera.fx_px * z
    y = (rows + 0.5 - camera.cy_px) / camera.fy_px * z
    met_m = apply(camera_to_truth, np.stack([x, y, z], axis=1))
    inward = -FACE_NORMALS[hits.face[rows, columns]].astype(np.float64)
    fine = np.stack(np.unravel_index(hits.voxel_index[rows, columns], truth.labels.shape), axis=1)
    middle_m = truth.origin_m + (fine + 0.5) * truth.voxel_m
    chosen = np.full(len(z), -1, np.int64)
    for point_m in (middle_m, met_m + inward * PUSH_M):  # The cell of the surface decides.
        cells = np.floor(apply(room.truth_to_room, point_m) / reached.voxel_m).astype(np.int64)
        flat = np.ravel_multi_index(tuple((cells - reached.low).T), room.labels.shape)
        chosen = np.where(occupied.reshape(-1)[flat], flat, chosen)
    return apply(room.truth_to_room, met_m), chosen


def _pixels(stated: Camera, camera: Camera, rows: np.ndarray, columns: np.ndarray):
    """Return the pixels of the full image that contain the centres of coarse pixels."""
    across, down = stated.width_px / camera.width_px, stated.height_px / camera.height_px
    return (
        ((rows + 0.5) * down).astype(np.int64),
        ((columns + 0.5) * across).astype(np.int64),
    )


def _fill(sums: _Sums, occupied: np.ndarray) -> None:
    """Copy values to occupied cells without rays from the nearest cell with rays."""
    bare = occupied & (sums.hits.reshape(occupied.shape) == 0)
    if not bare.any() or not sums.hits.any():
        return
    empty = sums.hits.reshape(occupied.shape) == 0
    nearest = ndimage.distance_transform_edt(empty, return_distances=False, return_indices=True)
    from_flat = np.ravel_multi_index(tuple(n[bare] for n in nearest), occupied.shape)  # type: ignore[union-attr]
    at = np.flatnonzero(bare.reshape(-1))
    for values in (sums.votes, sums.colour, sums.hits):
        values[at] = values[from_flat]


def put_true_labels(out: Path, room: TrueRoom) -> None:
    """Replace the labels of the reached cells in ``room.npz`` by the true ones, without objects."""
    grid, scan_to_room = read_room(out / "room.npz")
    known = room.reached.scored & (room.labels != UNKNOWN)
    labels = np.where(known, room.labels, np.uint8(UNKNOWN))
    colour = np.stack(
        [placed(grid.colour[..., n], grid, room.reached, 0) for n in range(3)], axis=-1
    )
    result = OccupancyGrid(
        labels=labels,
        confidence=known.astype(np.float16),
        colour=colour,
        source=np.where(known, OBSERVED, UNSEEN).astype(np.uint8),
        instance=np.zeros(labels.shape, np.uint16),
        voxel_m=grid.voxel_m,
        origin_m=room.reached.low * grid.voxel_m,
    )
    write_room(out / "room.npz", result, scan_to_room)


def put_true_objects(out: Path, room: TrueRoom) -> None:
    """Write the true instances to ``room.npz``, and the true boxes to ``objects.json``.

    ``room.npz`` must already contain the true labels.
    """
    grid, scan_to_room = read_room(out / "room.npz")
    instance = carry_instances(room, grid)
    rows = []
    for number, item in enumerate(room.objects.objects, start=1):
        cells = np.argwhere(instance == number).astype(np.int32)
        if len(cells):
            rows.append(
                ObjectInstance(
                    id=number,
                    class_id=item.class_id,
                    center_m=item.center_m,
                    size_m=item.size_m,
                    yaw_deg=item.yaw_deg,
                    cells=cells,
                    confidence=1.0,
                )
            )
    write_room(out / "room.npz", replace(grid, instance=instance), scan_to_room)
    write_objects(out / "objects.json", tuple(rows))


def carry_instances(room: TrueRoom, grid: OccupancyGrid) -> np.ndarray:
    """Return the true object that owns most of each object cell, as uint16 [X, Y, Z], or 0.

    Only objects with the class of the cell are considered.
    """
    truth = room.truth
    fine_instance = read_instances(truth)
    cells = np.argwhere(np.isin(grid.labels, OBJECT_CLASSES))
    instance = np.zeros(grid.shape, np.uint16)
    if not len(cells):
        return instance
    room_to_truth = invert_rigid(room.truth_to_room)
    classes = np.array([0, *(item.class_id for item in room.objects.objects)])
    wanted = grid.labels[tuple(cells.T)]
    side = max(round(grid.voxel_m / truth.voxel_m), 1)
    votes = []
    for sub in np.ndindex(side, side, side):
        points = grid.origin_m + (cells + (np.array(sub) + 0.5) / side) * grid.voxel_m
        fine = np.floor((apply(room_to_truth, points) - truth.origin_m) / truth.voxel_m)
        inside = np.asarray(((fine >= 0) & (fine < truth.labels.shape)).all(axis=1))
        at = np.where(inside[:, None], fine, 0).astype(np.int64)
        owner = np.where(inside, fine_instance[tuple(at.T)], 0).astype(np.int64)
        owner[owner >= len(classes)] = 0
        votes.append(np.where(classes[owner] == wanted, owner, 0))
    instance[tuple(cells.T)] = _majority(np.stack(votes, axis=1), len(classes))
    return instance


def _majority(votes: np.ndarray, count: int) -> np.ndarray:
    """Return the most frequent non-zero number in each row of votes [N, S], the lowest in a tie."""
    row = np.repeat(np.arange(len(votes)), votes.shape[1])
    pairs, times = np.unique(row * count + votes.reshape(-1), return_counts=True)
    owner, number = pairs // count, pairs % count
    times = np.where(number == 0, 0, times)
    order = np.lexsort((-number, times, owner))  # The last of each row has most votes.
    winner = np.zeros(len(votes), np.int64)
    winner[owner[order]] = number[order]
    return winner


def put_true_placements(out: Path) -> None:
    """Move the furniture in ``placements.json`` to the true objects.

    If several pieces belong to one object, the largest one with a template is used. If a template
    does not support the size of the object, the object is built from its own cells.
    """
    grid, _ = read_room(out / "room.npz")
    chosen = read_placements(out / "placements.json")
    result = []
    for instance in read_objects(out / "objects.json", grid):
        mine = [p for p in chosen if p.object_id == instance.id]
        if mine:
            best = max(mine, key=lambda p: (p.template != OWN_CELLS, float(p.size_m.prod())))
            result.append(_moved(best, instance))
    write_placements(out / "placements.json", tuple(result))


def _moved(placement: Placement, instance: ObjectInstance) -> Placement:
    true = replace(
        placement,
        center_m=instance.center_m,
        size_m=instance.size_m,
        quarter_turns=round(instance.yaw_deg / 90) % 4,
    )
    if true.template == OWN_CELLS:
        return true
    try:
        template(true.template).parts(true.size_m, true.parameters)
    except (World2MinecraftError, ValueError):
        return replace(true, template=OWN_CELLS, parameters={})
    return true
