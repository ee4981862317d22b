"""A generated room as a mesh and as a cloud gives the room that its RGB-D frames give."""

from itertools import permutations

import mesh_writers as writers
import numpy as np
import pytest
from mesh_rooms import Quads
from scipy import ndimage

from world2minecraft.capture import open_scan
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.readers.meshes.mesh_source import estimate_world_frame, load_geometry
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.procgen import generate_room, scan_room
from world2minecraft.reconstruction.fusion import fuse_views
from world2minecraft.reconstruction.occupancy import predictor


def quads_of(room):
    """The faces between the room's voxels and the air in it, each where it is seen from."""
    solid, quads, colours, labels = room.labels > 0, [], [], []
    for axis in range(3):
        for side in (-1, 1):
            beside = np.roll(solid, -side, axis)
            edge = [slice(None)] * 3
            edge[axis] = slice(-1, None) if side > 0 else slice(0, 1)
            beside[tuple(edge)] = True  # The outside of the shell is no one's.
            cells = np.argwhere(solid & ~beside)
            base = cells + np.eye(3)[axis] * (side > 0)
            u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
            quad = np.stack([base, base + u, base + u + v, base + v], axis=1)
            quads.append(quad if side > 0 else quad[:, ::-1])
            colours.append(room.colour[tuple(cells.T)])
            labels.append(room.labels[tuple(cells.T)])
    corners = np.concatenate(quads) * room.voxel_m + room.origin_m
    return Quads(corners, np.concatenate(colours), np.concatenate(labels))


def built(path, every=1):
    """A capture's evidence: what is occupied, what was seen, and the carrying of its room."""
    scan = open_scan(path, options={"every": str(every)})
    return scan, fuse_views(predictor("depth").predict(scan), scan)


@pytest.fixture(scope="module")
def worlds(tmp_path_factory):
    """The room in three ways, each with the 4x4 from the truth's frame to its own."""
    folder = tmp_path_factory.mktemp("room")
    room = generate_room(2, kind="bathroom")
    quads = quads_of(room)
    (folder / "mesh.ply").write_bytes(writers.quad_ply(quads))
    points, colour, labels = quads.points(apart_m=0.015, noise_m=0.005)
    vertex = [*writers.places(points), *writers.paints(colour), ("class", "u1", labels)]
    (folder / "cloud.ply").write_bytes(writers.ply_bytes("<", vertex))
    scan_room(room, folder / "frames", sensor="clean", frames=40, width=320, height=240)
    with np.load(folder / "frames" / "truth.npz") as truth:
        room_to_scan = truth["truth_room_to_scan"]
    made = {"frames": (*built(folder / "frames"), room_to_scan)}
    for name in ("mesh", "cloud"):
        scan, evidence = built(folder / f"{name}.ply", every=2)
        loaded = load_geometry(folder / f"{name}.ply")
        file_to_scan, _ = estimate_world_frame(folder, loaded, ScanOptions())
        near_origin = np.eye(4)
        near_origin[:3, 3] = -loaded.offset
        made[name] = (scan, evidence, file_to_scan @ near_origin)
    return {
        name: (evidence, scan.scan_to_room @ truth_to_scan)
        for name, (scan, evidence, truth_to_scan) in made.items()
    }


def near_share(one, other):
    """The share of one world's occupied cells that lie near one of the other, where it saw."""
    (mine, truth_to_mine), (theirs, truth_to_theirs) = one, other
    held = np.argwhere(mine.log_odds > 0)
    places = mine.origin_m + (held + 0.5) * mine.voxel_m
    places = apply(truth_to_theirs @ invert_rigid(truth_to_mine), places)
    cells = np.floor((places - theirs.origin_m) / theirs.voxel_m).astype(int)
    cells = cells[((cells >= 0) & (cells < theirs.log_odds.shape)).all(axis=1)]
    near = ndimage.binary_dilation(theirs.log_odds > 0, np.ones((3, 3, 3)))
    seen = theirs.log_odds[tuple(cells.T)] != 0
    return near[tuple(cells[seen].T)].mean(), seen.mean()


@pytest.mark.parametrize("one, other", list(permutations(("frames", "mesh", "cloud"), 2)))
def test_all_three_agree_within_a_cell(worlds, one, other):
    share, seen = near_share(worlds[one], worlds[other])
    assert share > 0.97 and seen > 0.85


def test_classes_of_the_cloud_come_with_it(worlds):
    evidence, _ = worlds["cloud"]
    classes = np.bincount(evidence.votes.argmax(axis=-1)[evidence.hits > 5], minlength=12)
    assert (classes[[1, 2, 3, 10]] > 50).all()
