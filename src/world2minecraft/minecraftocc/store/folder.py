"""The folder layout of a data set, and its files ``dataset.json`` and ``classes.json``.

::

    DIR/
      dataset.json      parameters, versions, seed, counts and the SHA-256 of all samples
      classes.json      the 12 classes and the numbered fine classes
      index.parquet     one row per sample: position, checksums and cells of each class
      README.md         data set card for Hugging Face, which assigns shards to splits
      checksums.json    the size and SHA-256 of every file
      scenes/           SCENE.json (survey result), SCENE.poses.jsonl (views), SCENE.objects.json
      shards/SPLIT/     WebDataset tar files such as SCENE-000.tar
      worlds/           houses that were generated for the data set
"""

import re
from pathlib import Path
from typing import Any

from world2minecraft.core.checksums import CHECKSUMS
from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import MALFORMED, DamagedFileError, InputError
from world2minecraft.core.files import read_json, write_json, write_text
from world2minecraft.core.locks import LOCK_FILE
from world2minecraft.core.output_folders import FolderKind
from world2minecraft.minecraftocc.store.sample_files import FORMAT, FineTable
from world2minecraft.minecraftocc.types import FineClass

META, CLASSES, INDEX, CARD, LOCK, CREW = (
    "dataset.json",
    "classes.json",
    "index.parquet",
    "README.md",
    LOCK_FILE,
    ".crew",
)
SHARDS, SCENES, WORLDS = "shards", "scenes", "worlds"
SPLITS = ("train", "test")
# Temporary files and houses that a killed build leaves.
LEFTOVER = re.compile(
    r"\.(?:[\w.-]+\.(?:json|jsonl|md)\.\w{8}|index\.parquet\.part|house_\d+\.part)"
)
SHARD_NAME = re.compile(r"shards/(?:train|val|test|all)/[A-Za-z0-9_-]{1,90}\.tar")
KIND = "minecraftocc"
DATASET = FolderKind(
    {META: "kind"}, (META, CLASSES, INDEX, CARD, CHECKSUMS, SHARDS, SCENES, WORLDS)
)
MAX_META_BYTES, MAX_FINE = 64 << 20, 65_535


def shard_name(split: str, scene_id: str, number: int) -> str:
    """Return the path of a scene's shard inside its data set.

    Example:
        >>> shard_name("train", "house_0001", 2)
        'shards/train/house_0001-002.tar'
    """
    return f"{SHARDS}/{split or 'all'}/{scene_id}-{number:03d}.tar"


def read_meta(folder: Path, finished: bool = True) -> dict[str, Any]:
    """Read ``dataset.json``.

    Args:
        folder: Folder of the data set.
        finished: Whether the data set must be complete.

    Raises:
        InputError: If the file does not exist, or if the data set is not complete.
        DamagedFileError: If the file has another format.
    """
    path = folder / META
    if not path.is_file():
        raise InputError(
            folder, f"not a data set: {META} not found; create a data set with w2m dataset build"
        )
    meta = read_json(path, MAX_META_BYTES)
    if not isinstance(meta, dict) or meta.get("kind") != KIND or meta.get("format") != FORMAT:
        raise DamagedFileError(path, f"not a valid {META} in format {FORMAT}")
    if finished and not meta.get("complete"):
        raise InputError(
            folder, "the data set is not complete; run the same w2m dataset build again"
        )
    return meta


def leftovers(folder: Path) -> list[str]:
    """Return the names of temporary files and folders that a killed build left in a data set."""
    places = (folder, folder / SCENES, folder / WORLDS, *sorted((folder / SHARDS).glob("*")))
    return [
        path.relative_to(folder).as_posix()
        for place in places
        if place.is_dir()
        for path in sorted(place.iterdir())
        if LEFTOVER.fullmatch(path.name)  # Other names belong to the user, such as .git.
    ]


def objects_path(folder: Path, scene_id: str) -> Path:
    """Return the path of the object table of a scene."""
    return folder / SCENES / f"{scene_id}.objects.json"


def write_classes(folder: Path, table: FineTable) -> None:
    """Write ``classes.json``.

    Raises:
        OutputError: If the file cannot be written.
    """
    fine = [
        {"block": one.block, "design": one.design, "name": one.name, "id": number}
        for number, one in enumerate(table.classes)
    ]
    write_json(folder / CLASSES, {"classes": list(CLASS_NAMES), "unknown": 255, "fine": fine})


def read_classes(folder: Path) -> FineTable:
    """Read the fine classes of a data set.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not valid.
    """
    path = folder / CLASSES
    raw = read_json(path, MAX_META_BYTES)
    try:
        rows = raw["fine"]
        if len(rows) > MAX_FINE:
            raise ValueError(f"more than {MAX_FINE:,} fine classes")
        return FineTable(tuple(FineClass(str(row["block"]), str(row["design"])) for row in rows))
    except MALFORMED as error:
        raise DamagedFileError(path, f"not a valid list of classes ({error})") from error


def write_card(folder: Path, meta: dict[str, Any]) -> None:
    """Write the data set card, which assigns shards to splits on Hugging Face."""
    counts = {split: meta["images"].get(split) for split in ("train", "val", "test", "all")}
    counts = {split: count for split, count in counts.items() if count}
    files = "".join(
        f"      - split: {'full' if split == 'all' else split}\n"  # Hugging Face reserves "all".
        f"        path: {SHARDS}/{split}/*.tar\n"
        for split in counts
    )
    totals = ", ".join(f"{count:,} {split}" for split, count in counts.items())
    write_text(
        folder / CARD,
        f"---\nconfigs:\n  - config_name: default\n    data_files:\n{files}---\n"
        f"# MinecraftOcc data set\n\n{totals} images of {len(meta['scenes'])} scenes, created with "
        f"world2minecraft {meta['versions']['world2minecraft']}.\n\n"
        "Each sample has an image, depth (16-bit millimetres), occ.npz (labels and masks of its\n"
        "cells) and json (camera, poses, region). Check the files with `w2m dataset verify`.\n",
    )
