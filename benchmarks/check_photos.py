"""Reconstruction from colour images, compared with depth and with OpenCV's stereo.

``python -m benchmarks.check_photos KITCHEN``       a 7-Scenes folder that has depth too
``python -m benchmarks.check_photos --seeds 10``    generated rooms, photographed with texture

Each capture is reconstructed from depth (the reference; for generated rooms noise-free depth and
exact poses), from colour with the stated poses, from colour alone, and with OpenCV's StereoSGBM
(``rival_sgbm``) instead of our stereo. Printed, within one voxel: precision, recall over all
occupied cells, the share of free cells found free, the share of occupied cells called free, the
scale's error, CPU seconds, wall seconds and peak memory. ``--json FILE`` writes them too.

Two runs of the same room are compared in the frame of the reference's capture. Within one voxel
means that centres are at most the diagonal of a voxel apart.
"""

import argparse
import json
import resource
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image
from scipy.spatial import cKDTree

from world2minecraft.capture.readers.capture_json import write_plain
from world2minecraft.capture.sfm.similarity_transform import align_views
from world2minecraft.core.types import OBSERVED, Camera, View
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.procgen.sensors.photo_rendering import prepare_photos, take_photo

REACH_VOXELS = 3**0.5 + 0.01
USUAL_DEPTH_M = 2.0


class Cells(NamedTuple):
    """What a run found, centres [N, 3] in metres of its capture's frame."""

    occupied_m: np.ndarray
    free_m: np.ndarray
    labels: np.ndarray
    source: np.ndarray
    origin_m: np.ndarray
    voxel_m: float
    scan_to_room: np.ndarray


def read_cells(room_file: Path) -> Cells:
    """Read the observed and the free cells of a ``room.npz``."""
    with np.load(room_file) as room:
        labels, source, origin = room["labels"], room["source"], room["origin_m"]
        voxel, scan_to_room = float(room["voxel_m"]), room["scan_to_room"]
    to_scan = np.linalg.inv(scan_to_room)

    def centers(mask):
        at = origin + (np.argwhere(mask) + 0.5) * voxel
        return at @ to_scan[:3, :3].T + to_scan[:3, 3]

    occupied = (labels > 0) & (labels != 255) & (source == 1)
    return Cells(
        centers(occupied), centers(labels == 0), labels, source, origin, voxel, scan_to_room
    )


def looked_up(cells: Cells, points_m: np.ndarray) -> np.ndarray:
    """Return the labels of the cells that hold points of the capture's frame.

    255 where they lie outside, and where nobody saw: what was completed is no observation.
    """
    at = points_m @ cells.scan_to_room[:3, :3].T + cells.scan_to_room[:3, 3]
    index = np.floor((at - cells.origin_m) / cells.voxel_m + 1e-9).astype(int)
    inside = ((index >= 0) & (index < cells.labels.shape)).all(axis=1)
    found = np.full(len(points_m), 255, np.uint8)
    at = tuple(index[inside].T)
    found[inside] = np.where(cells.source[at] == OBSERVED, cells.labels[at], 255)
    return found


def moved(points_m: np.ndarray, similarity: np.ndarray) -> np.ndarray:
    """Carry points by a 4x4 similarity."""
    return points_m @ similarity[:3, :3].T + similarity[:3, 3]


def compare(
    reference: Path, result: Path, result_to_reference: np.ndarray | None = None
) -> dict[str, float]:
    """Return the figures of ``result / room.npz`` against ``reference / room.npz``.

    ``result_to_reference`` is a similarity between the frames of their captures.
    """
    carry = np.eye(4) if result_to_reference is None else result_to_reference
    true, found = read_cells(reference / "room.npz"), read_cells(result / "room.npz")
    reach = REACH_VOXELS * true.voxel_m
    occupied = moved(found.occupied_m, carry)
    near_true, _ = cKDTree(true.occupied_m).query(occupied)
    near_found, _ = cKDTree(occupied).query(true.occupied_m)
    back = np.linalg.inv(carry)
    true_at = looked_up(found, moved(true.occupied_m, back))
    free_at = looked_up(found, moved(true.free_m, back))
    known = looked_up(true, occupied) != 255
    return {
        "precision": float((near_true <= reach).mean()),
        "precision where known": float((near_true[known] <= reach).mean()),
        "recall": float((near_found <= reach).mean()),
        "free found": float((free_at == 0).mean()),
        "wrong free": float((true_at == 0).mean()),
        "cells": len(occupied),
    }


def poses_of(capture_file: Path) -> dict[str, np.ndarray]:
    """Return camera_to_world by frame, of a plain capture's ``capture.json``."""
    frames = json.loads(capture_file.read_text())["frames"]
    return {f["name"]: np.array(f["camera_to_world"]) for f in frames if "camera_to_world" in f}


def best_similarity(found: dict[str, np.ndarray], true: dict[str, np.ndarray]) -> np.ndarray:
    """Return the 4x4 similarity that carries found poses to the true ones best.

    Points about two metres in front of the cameras are to coincide: true poses that were computed
    from bent depth turn too far, and then centres and rotations alone carry no surface well.
    """
    names = sorted(set(found) & set(true))
    poses = (np.array([given[name] for name in names]) for given in (found, true))
    best = align_views(*poses, np.full(len(names), USUAL_DEPTH_M))
    similarity = np.eye(4)
    similarity[:3, :3] = best.scale * best.rotation
    similarity[:3, 3] = best.shift_m
    return similarity


def kitchen_inputs(source: Path, folder: Path, every: int = 1) -> None:
    """Link a 7-Scenes folder as ``depth``, ``posed`` and ``unposed``, and note its poses."""
    if (folder / "poses.json").is_file():
        return
    frames = sorted((source / "frames").glob("*.color.*"))[::every]
    poses = {}
    for colour in frames:
        stem = colour.name.split(".")[0]
        poses[stem] = np.loadtxt(source / "frames" / f"{stem}.pose.txt").tolist()
        for kind in ("depth", "posed"):
            place = folder / kind / "frames"
            place.mkdir(parents=True, exist_ok=True)
            for path in (colour, colour.parent / f"{stem}.pose.txt"):
                shutil.copy(path, place / path.name)
            shutil.copy(source / "camera-intrinsics.txt", folder / kind)
        shutil.copy(colour.parent / f"{stem}.depth.png", folder / "depth" / "frames")
        (folder / "unposed").mkdir(exist_ok=True)
        shutil.copy(colour, folder / "unposed" / f"{stem}{colour.suffix}")
    (folder / "poses.json").write_text(json.dumps(poses))


def room_inputs(seed: int, folder: Path, frames: int) -> None:
    """Write a generated room as posed photos, as photos alone and as noise-free depth.

    All three look from the same places the same way: what one cannot see none of them can.
    """
    from world2minecraft.procgen import generate_room, scan_room

    if (folder / "poses.json").is_file():
        return
    room = generate_room(seed)
    scan_room(room, folder / "posed", sensor="photo", frames=frames, seed=seed)
    (folder / "unposed").mkdir(parents=True, exist_ok=True)
    for photo in sorted((folder / "posed" / "colour").iterdir()):
        shutil.copy(photo, folder / "unposed")
    write_plain(folder / "depth", depth_views(room, folder / "posed"), depth_unit="m")
    stated = json.loads((folder / "depth" / "capture.json").read_text())["frames"]
    poses = {frame["name"]: frame["camera_to_world"] for frame in stated}
    (folder / "poses.json").write_text(json.dumps(poses))


def depth_views(room: Room, posed: Path) -> Iterator[View]:
    """Yield a virtual phone's photos of a room with exact depth."""
    scene = prepare_photos(room)
    stated = json.loads((posed / "capture.json").read_text())
    camera = Camera(**stated["colour_camera"])
    with np.load(posed / "truth.npz") as truth:
        places = dict(zip(truth["frame_names"].tolist(), truth["camera_to_truth"], strict=True))
    for frame in stated["frames"]:
        name, pose = frame["name"], np.array(frame["camera_to_world"])
        colour = np.asarray(Image.open(posed / "colour" / f"{name}.jpg"))
        depth_m = take_photo(scene, camera, places[name]).depth_m
        yield View(name, pose, colour, camera, depth_m, camera)


COLUMNS = ("precision", "precision where known", "recall", "free found", "wrong free")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kitchen", type=Path, nargs="?")
    parser.add_argument("--seeds", type=int, default=0, help="generated rooms")
    parser.add_argument("--first", type=int, default=510)
    parser.add_argument("--frames", type=int, default=100)
    parser.add_argument("--work", type=Path, default=Path("OUT-photos"))
    parser.add_argument("--ways", default="posed,unposed,posed-sgbm,unposed-sgbm")
    parser.add_argument("--every", type=int, default=1, help="take each n-th frame of the kitchen")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args()
    ways, told = chosen.ways.split(","), {}
    print(" ".join([f"{'capture':24}", *(f"{name[:16]:>16}" for name in COLUMNS)]), end="")
    print(f"{'scale':>9}{'CPU s':>8}{'wall s':>8}{'MB':>7}")
    if chosen.kitchen:
        folder = chosen.work / "kitchen"
        kitchen_inputs(chosen.kitchen, folder, chosen.every)
        told["kitchen"] = report("kitchen", folder, ways)
    rows = []
    for seed in range(chosen.first, chosen.first + chosen.seeds):
        folder = chosen.work / f"room-{seed}"
        room_inputs(seed, folder, chosen.frames)
        told[f"room {seed}"] = report(f"room {seed}", folder, ways)
        rows.append(told[f"room {seed}"])
    for way in ways if rows else ():
        mine = [row[way] for row in rows if way in row]
        mean = {name: float(np.mean([row[name] for row in mine])) for name in COLUMNS}
        told.setdefault("mean", {})[way] = mean
        print(" ".join([f"{'mean, ' + way:24}", *(f"{mean[name]:16.3f}" for name in COLUMNS)]))
    if chosen.json:
        chosen.json.write_text(json.dumps(told, indent=1) + "\n")


def report(name: str, folder: Path, ways: list[str]) -> dict[str, dict[str, float]]:
    """Reconstruct the inputs in a folder in all ways; print and return the figures of each."""
    reference = folder / "out-depth"
    if not (reference / "room.npz").is_file():
        run(["reconstruct", str(folder / "depth"), "--out", str(reference)], "ours")
    true = poses_of(reference / "poses.json") if (reference / "poses.json").is_file() else None
    true = true or json_poses(folder)
    rows = {}
    for way in ways:
        kind, _, stereo = way.partition("-")
        out = folder / f"out-{way}"
        words = ["reconstruct", str(folder / kind), "--out", str(out)]
        cost = run(words, stereo or "ours")
        if cost is None:
            print(f"{name + ', ' + way:24} failed")
            continue
        carry, scale = None, 0.0
        if kind == "unposed":
            found = poses_of(out / "capture" / "capture.json")
            carry = best_similarity(found, true)
            scale = np.linalg.det(carry[:3, :3]) ** (1 / 3)
        row = rows[way] = compare(reference, out, carry)
        cells = " ".join(f"{row[column]:16.3f}" for column in COLUMNS)
        off = f"{100 * (1 / scale - 1):+8.1f}%" if scale else " " * 9
        row |= dict(zip(("CPU s", "wall s", "MB"), cost, strict=True))
        row |= {"scale off": abs(1 / scale - 1)} if scale else {}
        print(f"{name + ', ' + way:24} {cells}{off}{cost[0]:8.0f}{cost[1]:8.0f}{cost[2]:7.0f}")
    return rows


def json_poses(folder: Path) -> dict[str, np.ndarray]:
    """Return the true poses by frame that were written with the inputs."""
    rows = json.loads((folder / "poses.json").read_text())
    return {name: np.array(pose) for name, pose in rows.items()}


def run(words: list[str], stereo: str) -> tuple[float, float, float] | None:
    """Run ``w2m`` in a process of its own; return CPU s, wall s and peak MB, None on failure."""
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    module = "benchmarks.rival_sgbm" if stereo == "sgbm" else "world2minecraft"
    command = [sys.executable, "-m", module, *words]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    wall = time.perf_counter() - begun
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        print(done.stderr.strip().splitlines()[-1])
        return None
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    memory = json.loads((Path(words[words.index("--out") + 1]) / "run.json").read_text())
    return cpu, wall, memory["peak_memory_mb"]


if __name__ == "__main__":
    main()
