"""Fit the confidence of names on real frames and generated rooms, and measure it on other frames.

``python -m benchmarks.fit_name_confidence DATA --keep DIR --rooms ROOMS [--frames 19]``

``DATA`` is the folder of shared inputs, and ``ROOMS`` the ``--keep`` folder of
``benchmarks.check_names``. Frames of NYUv2 that the segmentation network was not trained on
(calibration) are reconstructed once; both sources count the same in the fit. Printed are the
constants for ``reconstruction/naming/name_model.py``, and for each source and the validation frames
the calibration error before and after, and how many names of 0.5 and more are right.
"""

import argparse
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image
from scipy.optimize import minimize

from benchmarks.real_captures.scenes import NYU_FOLDER, nyu_scene, sample_nyu
from benchmarks.train_names import calibration_error
from world2minecraft.core.types import ObjectInstance, OccupancyGrid, View
from world2minecraft.core.vocabulary import OTHER_NYU40, read_vocabulary
from world2minecraft.evaluation.metrics.objects import match_objects
from world2minecraft.evaluation.scoring.score import see_truth
from world2minecraft.evaluation.scoring.used_frames import truth_of_run, used_frames
from world2minecraft.formats.layout import read_rooms
from world2minecraft.formats.objects_and_placements import read_objects
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.geometry.unprojection import unproject_depth
from world2minecraft.networks.segmentation.frames import nyu_part
from world2minecraft.reconstruction.naming import name_model
from world2minecraft.reconstruction.naming.name_votes import (
    NAME_VOTES,
    read_name_votes,
    votes_of_objects,
)
from world2minecraft.reconstruction.naming.object_traits import name_instances
from world2minecraft.reconstruction.opening import prepare_and_open
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.pipeline import read_registered, reconstruct

OBJS = 11
MIN_POINTS = 50  # Of an object that are labelled.
VALIDATION_FRAMES = 22


class Named(NamedTuple):
    """The best name of an object: its share in the votes, their number, and whether it is right."""

    share: float
    votes: float
    right: bool


class Found(NamedTuple):
    """An object of a run with its best name."""

    item: ObjectInstance
    name: str
    share: float
    votes: float


def best_names(run: Path) -> tuple[OccupancyGrid, list[Found]]:
    """Return the grid of a run, and its objects with their best names."""
    grid, _ = read_room(run / "room.npz")
    objects = read_objects(run / "objects.json", grid)
    votes = votes_of_objects(read_name_votes(run / NAME_VOTES), grid, len(objects))[1:]
    before = name_model.CALIBRATION, name_model.MIN_NAME_CONFIDENCE
    # The share itself, and always the best name.
    name_model.CALIBRATION, name_model.MIN_NAME_CONFIDENCE = (0.0, 1.0, 0.0), 0.0
    try:
        names = name_instances(objects, read_rooms(run, grid), votes)
    finally:
        name_model.CALIBRATION, name_model.MIN_NAME_CONFIDENCE = before
    found = [
        Found(item, name, share, float(row.sum()))
        for item, (name, share), row in zip(objects, names, votes, strict=True)
        if row.any()
    ]
    return grid, found


class Surface(NamedTuple):
    """The labelled pixels of a frame of NYUv2 that lie in cells of its run.

    Attributes:
        view: The frame.
        pixels: Flat indices of the pixels in the depth image, int64 [N].
        cells: Their cells, int64 [N, 3].
        nyu40: Their true NYU40 ids, 1 to 40, int64 [N].
        area: The squares of their depths, to which the area that they show is proportional.
    """

    view: View
    pixels: np.ndarray
    cells: np.ndarray
    nyu40: np.ndarray
    area: np.ndarray


def run_frame(data: Path, folder: Path, number: int) -> Path:
    """Reconstruct a frame if that was not done before, and return the folder of the run."""
    run = folder / f"run-{number}"
    capture = nyu_scene(number).prepare(data, folder / f"capture-{number}")
    if not (run / "placements.json").is_file():
        reconstruct(capture, run, Parameters())
    return run


def labelled_surface(data: Path, folder: Path, number: int, grid: OccupancyGrid) -> Surface:
    """Return the labelled pixels of a frame that lie in the grid of its run."""
    run = folder / f"run-{number}"
    with Image.open(data / NYU_FOLDER / f"{number:04d}.label40.png") as image:
        labels = np.asarray(image).astype(np.int64).reshape(-1) + 1
    capture = nyu_scene(number).prepare(data, folder / f"capture-{number}")
    scan = read_registered(prepare_and_open(capture, run, Parameters()), run)
    view = next(iter(scan.views))
    if view.depth_m is None or view.depth_camera is None:
        raise ValueError(f"view {view.name} has no depth")
    pose = scan.scan_to_room @ view.depth_camera_to_scan
    points_m, pixels = unproject_depth(view.depth_m, view.depth_camera, pose)
    cells = np.floor((points_m - grid.origin_m) / grid.voxel_m).astype(np.int64)
    known = ((cells >= 0) & (cells < grid.shape)).all(axis=1)
    known &= labels[pixels] <= OTHER_NYU40
    pixels = pixels[known]
    area = view.depth_m.reshape(-1)[pixels] ** 2
    return Surface(view, pixels, cells[known], labels[pixels], area)


def frame_names(data: Path, folder: Path, number: int) -> Iterator[Named]:
    """Yield the names of the objects of a labelled frame, reconstructed once."""
    grid, found = best_names(run_frame(data, folder, number))
    surface = labelled_surface(data, folder, number, grid)
    owners = grid.instance[tuple(surface.cells.T)]
    names = read_vocabulary().names
    for item, name, share, votes in found:
        mine = owners == item.id
        if mine.sum() >= MIN_POINTS:
            counts = np.bincount(surface.nyu40[mine], surface.area[mine], OTHER_NYU40 + 1)
            yield Named(share, votes, bool(names[name].nyu40 == counts.argmax()))


def room_names(folder: Path) -> Iterator[Named]:
    """Yield the names of the objects of a generated room that ``check_names`` reconstructed."""
    run = folder / "run"
    _, found = best_names(run)
    grid, scan_to_room = read_room(run / "room.npz")
    known = truth_of_run(run, folder / "capture")
    room = see_truth(known, used_frames(run, known), scan_to_room, grid.voxel_m)
    places = [replace(one.item, class_id=OBJS) for one in found]
    true = [replace(item, class_id=OBJS) for item in room.objects.objects]
    for number, wanted in match_objects(places, true):
        entry = read_vocabulary().find(true[wanted].name.replace("_", " "))
        if entry is not None:
            yield Named(found[number].share, found[number].votes, found[number].name == entry.name)


def inputs(rows: list[Named]) -> np.ndarray:
    """Return a one, the log-odds of the share and the logarithm of the votes, float64 [N, 3]."""
    share = np.clip([row.share for row in rows], *name_model.SHARE_LIMITS)
    votes = np.log(np.maximum([row.votes for row in rows], 1) / 1000)
    return np.stack([np.ones(len(rows)), np.log(share / (1 - share)), votes], axis=1)


def fit(sources: list[list[Named]]) -> np.ndarray:
    """Return the constants of a logistic regression in which all sources weigh the same."""
    columns = np.concatenate([inputs(rows) for rows in sources])
    right = np.concatenate([[float(row.right) for row in rows] for rows in sources])
    weight = np.concatenate([np.full(len(rows), 1 / len(rows)) for rows in sources])

    def loss(constants: np.ndarray) -> float:
        odds = columns @ constants
        smooth = 1e-3 * float((constants[1:] ** 2).sum())
        return float((weight * (np.logaddexp(0, odds) - right * odds)).sum()) + smooth

    return np.asarray(minimize(loss, np.zeros(3)).x)


def report(name: str, rows: list[Named], constants: np.ndarray) -> str:
    """Return the calibration of the names of a source in one line."""
    right = np.array([row.right for row in rows])
    text = f"{name}: {len(rows)} objects"
    chances = {"share": np.array([row.share for row in rows])}
    chances["fitted"] = 1 / (1 + np.exp(-inputs(rows) @ constants))
    for kind, chance in chances.items():
        sure = chance >= name_model.MIN_NAME_CONFIDENCE
        error, share = calibration_error(chance, right), right[sure].mean() if sure.any() else 0
        text += f"; {kind}: error {error:.3f}, {sure.sum()} sure, {share:.2f} of them right"
    return text


def main() -> None:
    """Fit and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("data", type=Path)
    parser.add_argument("--keep", type=Path, required=True, metavar="DIR")
    parser.add_argument("--rooms", type=Path, required=True, metavar="ROOMS")
    parser.add_argument("--frames", type=int, help="so many frames of each part only")
    chosen = parser.parse_args()
    labelled = (chosen.data / NYU_FOLDER).glob("*.label40.png")
    numbers = sorted(int(path.name[:4]) for path in labelled)
    used = {
        "calibration": [number for number in numbers if nyu_part(number) == "calibration"],
        "validation": sample_nyu(chosen.data / NYU_FOLDER, VALIDATION_FRAMES),
    }
    parts = {
        part: [
            named
            for number in frames[: chosen.frames]
            for named in frame_names(chosen.data, chosen.keep, number)
        ]
        for part, frames in used.items()
    }
    rooms = [named for folder in sorted(chosen.rooms.iterdir()) for named in room_names(folder)]
    constants = fit([parts["calibration"], rooms])
    print("CALIBRATION =", tuple(round(value, 3) for value in constants.tolist()))
    for name, rows in {**parts, "generated": rooms}.items():
        print(report(name, rows, constants))


if __name__ == "__main__":
    main()
