"""The folder of a data set: where its files lie, and ``dataset.json`` and ``classes.json``.

::

    DIR/
      dataset.json      what it is: parameters, versions, seed, counts, the sum of all samples
      classes.json      the 12 classes, and the fine classes by their numbers
      index.parquet     one row a sample: where it lies, its sums, how many cells of each class
      README.md         the card that Hugging Face reads: which shards are of which split
      scenes/           SCENE.json (where it comes from) and SCENE.poses.jsonl (its views)
      shards/SPLIT/     SCENE-000.tar and so on, WebDataset tars
      worlds/           the houses, where they were generated for it
"""

import re
from pathlib import Path
from typing import Any

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.files import read_json, write_json, write_text
from world2minecraft.minecraftocc.store.sample_files import FORMAT, FineTable
from world2minecraft.minecraftocc.types import FineClass

META, CLASSES, INDEX, CARD, LOCK, CREW = (
    "dataset.json",
    "classes.json",
    "index.parquet",
    "README.md",
    ".lock",
    ".crew",
)
SHARDS, SCENES, WORLDS = "shards", "scenes", "worlds"
SPLITS = ("train", "test")
# What a killed run leaves of files that were being written, and of houses.
LEFTOVER = re.compile(
    r"\.(?:[\w.-]+\.(?:json|jsonl|md)\.\w{8}|index\.parquet\.part|house_\d+\.part)"
)
SHARD_NAME = re.compile(r"shards/(?:train|val|test|all)/[A-Za-z0-9_-]{1,90}\.tar")
KIND = "minecraftocc"
MAX_META_BYTES, MAX_FINE = 64 << 20, 65_535


def shard_name(split: str, scene_id: str, number: int) -> str:
    """Return the name of a scene's shard in its data set.

    Example:
        >>> shard_name("train", "house_0001", 2)
        'shards/train/house_0001-002.tar'
    """
    return f"{SHARDS}/{split or 'all'}/{scene_id}-{number:03d}.tar"


def read_meta(folder: Path, finished: bool = True) -> dict[str, Any]:
    """Return what ``dataset.json`` holds.

    Raises:
        InputError: there is none, or the data set is not finished. DamagedFileError: it is of
        another kind.
    """
    path = folder / META
    if not path.is_file():
        raise InputError(folder, f"is no data set: it has no {META}; w2m dataset build makes one")
    meta = read_json(path, MAX_META_BYTES)
    if not isinstance(meta, dict) or meta.get("kind") != KIND or meta.get("format") != FORMAT:
        raise DamagedFileError(path, f"is no {META} of format {FORMAT}")
    if finished and not meta.get("complete"):
        raise InputError(folder, "is not finished; run the same w2m dataset build again")
    return meta


def write_classes(folder: Path, table: FineTable) -> None:
    """Write ``classes.json``. Raises OutputError."""
    fine = [
        {"block": one.block, "design": one.design, "name": one.name, "id": number}
        for number, one in enumerate(table.classes)
    ]
    write_json(folder / CLASSES, {"classes": list(CLASS_NAMES), "unknown": 255, "fine": fine})


def read_classes(folder: Path) -> FineTable:
    """Return the fine classes of a data set. Raises InputError or DamagedFileError."""
    path = folder / CLASSES
    raw = read_json(path, MAX_META_BYTES)
    try:
        rows = raw["fine"]
        if len(rows) > MAX_FINE:
            raise ValueError(f"it has more than {MAX_FINE:,} fine classes")
        return FineTable(tuple(FineClass(str(row["block"]), str(row["design"])) for row in rows))
    except (KeyError, TypeError, ValueError) as error:
        raise DamagedFileError(path, f"holds no classes ({error})") from error


def write_card(folder: Path, meta: dict[str, Any]) -> None:
    """Write the card: which shards Hugging Face takes for which split, and how it was made."""
    counts = {split: count for split, count in meta["images"].items() if count}
    files = "".join(
        f"      - split: {split}\n        path: {SHARDS}/{split}/*.tar\n" for split in counts
    )
    totals = ", ".join(f"{count:,} {split}" for split, count in counts.items())
    write_text(
        folder / CARD,
        f"---\nconfigs:\n  - config_name: default\n    data_files:\n{files}---\n"
        f"# MinecraftOcc data set\n\n{totals} images of {len(meta['scenes'])} scenes, made by "
        f"world2minecraft {meta['versions']['world2minecraft']}.\n\n"
        "Each sample: picture, depth (16-bit millimetres), occ.npz (labels and masks of its\n"
        "cells) and json (camera, poses, region). `w2m dataset verify` checks it.\n",
    )
