"""Colours of built worlds against photos, by class, and grey walls that should not be.

``python -m benchmarks.check_colours --keep DIR [--data DATA] [--scenes NAME ...] [--nyu 4]
[--rooms 8] [--set KEY=VALUE] [--previews DIR] [--json FILE]``

Scenes of ``benchmarks.real_captures`` and generated rooms, scanned with noise, are reconstructed
once in ``DIR``; their blocks are built again by each call. For each class, the median CIEDE2000
difference of the pixels of photos and of the world rendered from the same pose is printed, where
the thing stands in its place; ``surface`` is that of walls, floors and large furniture together.
A wall (at least 1 m2 of faces in one plane) is coloured if the chroma of its paint in CIELAB is at
least ``COLOURED``, by the true colours of a generated room and by the photos of a real one. It is
built grey if its commonest block has a chroma below ``GREY``. ``relief`` is the share of wall and
ceiling blocks with bevels, joints or speckles.
"""

import argparse
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL import Image
from scipy.spatial import KDTree

from benchmarks.real_captures.running import Options, run_scene
from benchmarks.real_captures.scenes import list_scenes
from world2minecraft.core.classes import CLASS_NAMES, SemanticClass
from world2minecraft.core.coordinates import apply
from world2minecraft.core.files import write_json
from world2minecraft.core.types import BlockVolume
from world2minecraft.evaluation.scoring.used_frames import truth_of_run
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.geometry.colour import ciede2000, linear_to_lab, srgb_to_linear
from world2minecraft.minecraft.block_colours import colours_of
from world2minecraft.procgen import generate_room, scan_room
from world2minecraft.reconstruction.file_stages import built_volume
from world2minecraft.reconstruction.naming.name_votes import NAME_VOTES, read_name_votes
from world2minecraft.reconstruction.opening import prepare_and_open
from world2minecraft.reconstruction.parameters import Parameters, with_settings
from world2minecraft.reconstruction.pipeline import read_registered, reconstruct
from world2minecraft.reconstruction.verification.photo_agreement import (
    compare_view,
    things_of_photo,
)
from world2minecraft.reconstruction.verification.photo_samples import sample_photos
from world2minecraft.rendering.preview import preview
from world2minecraft.rendering.scene import prepare_scene

SCENES = ("kitchen", "lounge", "sunrgbd", "nyu-living", "emsanet-lounge", "nyuv2")
ROOMS = (
    ("living", 2),
    ("bed", 7),
    ("kitchen", 6),
    ("kitchen", 3),
    ("bathroom", 5),
    ("bathroom", 6),
    ("dining", 6),
    ("hall", 6),
)
FRAMES = 16
COLOURED, GREY = 8.0, 3.5  # A paint of less chroma is white or grey with a cast.
MIN_WALL_M2 = 1.0
LARGE = ("wall", "floor", "sofa", "bed", "table", "furn")
RELIEF = ("bricks", "_tiles", "planks", "polished_", "diorite", "granite", "andesite", "quartz_b")
PREVIEW_PX = (960, 720)


class WallColour(NamedTuple):
    """A wall: the chroma of its paint and of its block, and the CIEDE2000 difference of both."""

    block: str
    chroma: float
    built_chroma: float
    difference: float


def labs_of(colours: np.ndarray) -> np.ndarray:
    """Return the CIELAB colours, float64 [..., 3], of sRGB colours, uint8 [..., 3]."""
    return linear_to_lab(srgb_to_linear(colours))


def wall_colours(
    volume: BlockVolume, points_m: np.ndarray, colours: np.ndarray
) -> list[WallColour]:
    """Return the colours of the walls of a volume.

    Args:
        volume: The blocks.
        points_m: Points on walls in the room, float64 [N, 3].
        colours: sRGB colours of the points, uint8 [N, 3].
    """
    tree = KDTree(points_m)
    walls = (volume.semantic == SemanticClass.WALL) & (volume.states > 0)
    rows = []
    for axis, side in ((0, 1), (0, -1), (2, 1), (2, -1)):
        open_side = np.roll(volume.states == 0, -side, axis=axis)
        faces = np.moveaxis(walls & open_side, axis, 0)
        for layer, mask in enumerate(faces):
            if mask.sum() < MIN_WALL_M2 * volume.blocks_per_metre**2:
                continue
            cells = np.insert(np.argwhere(mask), axis, layer, axis=1)
            middle = cells + np.array(volume.corner) + 0.5
            middle[:, axis] += side / 2
            away, nearest = tree.query(apply(volume.block_to_room, middle))
            near = away < 1 / volume.blocks_per_metre
            if near.mean() < 0.3:
                continue
            paint = np.median(colours[nearest[near]], axis=0)
            states = volume.states[tuple(cells.T)]
            block = volume.palette[int(np.bincount(states).argmax())]
            true, built = labs_of(np.array([paint, *colours_of([block])], np.uint8))
            chroma, built_chroma = np.hypot(true[1], true[2]), np.hypot(built[1], built[2])
            row = WallColour(block, chroma, built_chroma, float(ciede2000(true, built)))
            rows.append(row)
    return rows


def relief_share(volume: BlockVolume) -> float:
    """Return the share of wall and ceiling blocks that have a relief or a pattern."""
    mask = np.isin(volume.semantic, (SemanticClass.WALL, SemanticClass.CEILING))
    counts = np.bincount(volume.states[mask & (volume.states > 0)], minlength=len(volume.palette))
    rough = [any(word in state for word in RELIEF) for state in volume.palette]
    return float(counts[rough].sum() / max(counts.sum(), 1))


def class_differences(run: Path, capture: Path, volume: BlockVolume) -> dict[str, np.ndarray]:
    """Return the CIEDE2000 differences of photos and world by class, float32 [N] each."""
    scan = read_registered(prepare_and_open(capture, run, Parameters()), run)
    grid, _ = read_room(run / "room.npz")
    votes = run / NAME_VOTES
    samples = sample_photos(scan, read_name_votes(votes) if votes.is_file() else None)
    scene, tolerance_m = prepare_scene(volume), max(1 / volume.blocks_per_metre, 2 * grid.voxel_m)
    classes = np.zeros(int(grid.instance.max()) + 1, np.int64)
    classes[grid.instance] = grid.labels
    found: dict[str, list[np.ndarray]] = {}
    for sample in samples:
        view = compare_view(sample, things_of_photo(sample, grid), scene, {}, tolerance_m)
        shown = np.where(view.thing > 0, classes[np.maximum(view.thing, 0)], -view.thing)
        for class_id in np.unique(shown[view.there]).tolist():
            mine = view.there & (shown == class_id)
            found.setdefault(CLASS_NAMES[class_id], []).append(view.difference[mine])
    return {name: np.concatenate(parts) for name, parts in found.items()}


def real_walls(run: Path, volume: BlockVolume) -> list[WallColour]:
    """Return the walls of a real room, whose paint is known from photos only."""
    grid, _ = read_room(run / "room.npz")
    mask = (grid.labels == SemanticClass.WALL) & grid.colour.any(axis=-1)
    points_m = grid.origin_m + (np.argwhere(mask) + 0.5) * grid.voxel_m
    return wall_colours(volume, points_m, grid.colour[mask]) if mask.any() else []


def generated_walls(
    run: Path, capture: Path, kind: str, seed: int, volume: BlockVolume
) -> list[WallColour]:
    """Return the walls of a generated room, whose paint is known."""
    room, truth = generate_room(seed, kind=kind), truth_of_run(run, capture)
    _, scan_to_room = read_room(run / "room.npz")
    mask = room.labels == SemanticClass.WALL
    points_m = room.origin_m + (np.argwhere(mask) + 0.5) * room.voxel_m
    to_room = scan_to_room @ truth.truth_to_scan
    return wall_colours(volume, apply(to_room, points_m), room.colour[mask])


def generated_run(keep: Path, kind: str, seed: int) -> Path:
    """Scan and reconstruct a generated room if that was not done before, and return its folder."""
    folder = keep / f"{kind}-{seed}"
    if not (folder / "run" / "placements.json").is_file():
        room = generate_room(seed, kind=kind, clutter=0.3)
        scan_room(room, folder / "capture", frames=FRAMES, seed=seed)
        reconstruct(folder / "capture", folder / "run", Parameters(), until="furnish")
    return folder


def figures(
    name: str, differences: dict[str, np.ndarray], walls: list[WallColour], volume: BlockVolume
) -> dict[str, Any]:
    """Return the row of a scene."""
    large = [differences[key] for key in LARGE if key in differences]
    coloured = [wall for wall in walls if wall.chroma >= COLOURED]
    grey = [wall for wall in coloured if wall.built_chroma < GREY]
    return {
        "scene": name,
        "surface": median(np.concatenate(large)) if large else None,
        **{key: median(values) for key, values in differences.items()},
        "walls": len(walls),
        "coloured": len(coloured),
        "grey": len(grey),
        "wall_blocks": sorted({wall.block.partition(":")[2] for wall in walls}),
        "wall_difference": median([wall.difference for wall in walls]) if walls else None,
        "relief": round(relief_share(volume), 3),
    }


def median(values: Iterable[float]) -> float:
    """Return the median, rounded to one decimal."""
    return round(float(np.median(np.asarray(values))), 1)


def rows_of(chosen: argparse.Namespace) -> Iterable[tuple[dict[str, Any], BlockVolume]]:
    """Yield the figures and the blocks of each scene."""
    parameters = with_settings(Parameters(), chosen.set)
    if chosen.data:
        options = Options(chosen.data.resolve(), chosen.keep)
        for scene in list_scenes(options.data, chosen.nyu):
            if not {scene.name, scene.group} & set(chosen.scenes):
                continue
            folder = options.folder(scene)
            if not (folder / "result.json").is_file():
                run_scene(scene, options)
            run = folder / "run"
            capture = Path((folder / "capture.txt").read_text("utf-8").strip())
            volume = built_volume(run, parameters)
            differences = class_differences(run, capture, volume)
            yield figures(scene.name, differences, real_walls(run, volume), volume), volume
    for kind, seed in ROOMS[: chosen.rooms]:
        folder = generated_run(chosen.keep, kind, seed)
        run, capture = folder / "run", folder / "capture"
        volume = built_volume(run, parameters)
        walls = generated_walls(run, capture, kind, seed, volume)
        differences = class_differences(run, capture, volume)
        yield figures(folder.name, differences, walls, volume), volume


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--keep", type=Path, required=True, metavar="DIR")
    parser.add_argument("--data", type=Path, help="folder of shared inputs, for real scenes")
    parser.add_argument("--scenes", nargs="+", default=SCENES, metavar="NAME")
    parser.add_argument("--nyu", type=int, default=4, help="NYUv2 validation frames (default 4)")
    parser.add_argument("--rooms", type=int, default=len(ROOMS), help="generated rooms")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--previews", type=Path, metavar="DIR")
    parser.add_argument("--json", type=Path)
    chosen = parser.parse_args()
    rows = []
    for row, volume in rows_of(chosen):
        rows.append(row)
        print(*(f"{key} {value}" for key, value in row.items()), sep=", ", flush=True)
        if chosen.previews:
            chosen.previews.mkdir(parents=True, exist_ok=True)
            picture = Image.fromarray(preview(volume, *PREVIEW_PX))
            picture.save(chosen.previews / f"{row['scene']}.png")
    for key in ("surface", "wall", "floor", "ceiling", "table", "sofa", "bed", "furn", "chair"):
        held = [row[key] for row in rows if row.get(key) is not None]
        if held:
            print(f"{key}: median of scenes {np.median(held):.1f}, worst {max(held):.1f}")
    walls, coloured, grey = (sum(row[key] for row in rows) for key in ("walls", "coloured", "grey"))
    print(f"{walls} walls, {coloured} coloured, {grey} of them built grey")
    if chosen.json:
        write_json(chosen.json, rows)


if __name__ == "__main__":
    main()
