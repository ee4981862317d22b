"""Importer for plain ``.npz`` files, one per sample, as written by our own exporter."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError, InputError
from world2minecraft.core.files import npz_array_names, read_npz
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.importers.imported_samples import ImportedSet
from world2minecraft.minecraftocc.types import FineClass, LabelRegion, OccLabels, OccSample

SPLITS = {"train": "train", "test": "test", "val": "val", "all": ""}
MASKS = ("labels", "fine", "instance", "in_frustum", "hits", "free")
NEEDED = (
    *MASKS, "fine_blocks", "fine_designs", "voxel_m", "region_to_room", "camera_to_room",
    "camera_size_px", "camera_lens", "meta",
)  # fmt: skip


def is_npz(path: Path) -> bool:
    """Return whether a path is an ``.npz`` file of a sample, or a folder of such files by split."""
    if path.suffix == ".npz":
        return path.is_file() and "camera_lens" in npz_array_names(path)
    return any(any((path / split).glob("*.npz")) for split in SPLITS)


def open_npz(path: Path) -> ImportedSet:
    """Open a file or folder and list its samples.

    Raises:
        InputError: If there are no samples.
    """
    if path.suffix == ".npz":
        files = {path.stem: path}
        splits = {path.stem: SPLITS.get(path.parent.name, "")}
    else:
        found = [(file, split) for split in SPLITS for file in sorted((path / split).glob("*.npz"))]
        files = {file.stem: file for file, _ in found}
        splits = {file.stem: SPLITS[split] for file, split in found}
    if not files:
        raise InputError(
            path, "no files found that match train/KEY.npz, test/KEY.npz or all/KEY.npz"
        )
    return ImportedSet(path, "npz", splits, lambda key: _read(files[key]))


def _read(path: Path) -> OccSample:
    names = set(npz_array_names(path))
    pictures = tuple(name for name in ("colour", "depth_m") if name in names)
    arrays = read_npz(path, (*NEEDED, *pictures))
    try:
        return _sample(arrays)
    except MALFORMED as error:
        raise DamagedFileError(path, f"not a valid sample ({error})") from error


def _sample(arrays: dict[str, np.ndarray]) -> OccSample:
    meta: dict[str, Any] = json.loads(str(arrays["meta"]))
    width, height = (int(side) for side in arrays["camera_size_px"])
    lens = arrays["camera_lens"].tolist()
    shape = arrays["labels"].shape
    region = LabelRegion(
        (shape[0], shape[1], shape[2]),
        float(arrays["voxel_m"]),
        arrays["region_to_room"],
        str(meta["region_kind"]),
    )
    kinds = zip(arrays["fine_blocks"].tolist(), arrays["fine_designs"].tolist(), strict=True)
    return OccSample(
        key=str(meta["key"]),
        scene_id=str(meta["scene_id"]),
        tour_id=str(meta["tour_id"]),
        frame=int(meta["frame"]),
        camera=Camera(width, height, lens[0], lens[1], lens[2], lens[3], tuple(lens[4:])),
        camera_to_room=arrays["camera_to_room"],
        occ=OccLabels(region, **{name: arrays[name] for name in MASKS}),
        fine_classes=tuple(FineClass(*kind) for kind in kinds),
        colour=arrays.get("colour"),
        depth_m=arrays.get("depth_m"),
        split=str(meta["split"]),
        facts=dict(meta["facts"]),
    )
