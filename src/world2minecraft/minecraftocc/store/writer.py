"""Writer for data sets made from samples, and the final step of a build."""

import platform
import re
from collections.abc import Container, Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import PIL

from world2minecraft import __version__
from world2minecraft.core.checksums import (
    CHECKSUMS,
    FileSum,
    sum_of_bytes,
    sum_of_file,
    sums_of_files,
    write_checksums,
)
from world2minecraft.core.errors import ConflictError, UsageError
from world2minecraft.core.files import json_bytes, write_bytes
from world2minecraft.core.output_folders import draft_of, output_folder
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.minecraftocc.store.folder import (
    CARD,
    CLASSES,
    DATASET,
    INDEX,
    KIND,
    META,
    SCENES,
    WORLDS,
    shard_name,
    write_card,
    write_classes,
)
from world2minecraft.minecraftocc.store.index import arrow_modules, shard_rows, write_index
from world2minecraft.minecraftocc.store.sample_files import (
    FORMAT,
    FineTable,
    SampleFiles,
    pack_sample,
)
from world2minecraft.minecraftocc.store.shard import MAX_KEY_LENGTH, ShardWriter
from world2minecraft.minecraftocc.types import FineClass, OccSample

MAX_SCENE_ID = 80  # The name of a shard may have 90 characters, including its number.
SHARD_SAMPLES = 100  # About 100 MB at 1920x1129.
CONVENTIONS = {
    "cells": "labels[x, y, z] in region axes: x right, y forward, z up; 255 is unknown",
    "region": "centre of cell (i, j, k) in the room: region_to_room * (i + 0.5) * voxel_m ...",
    "room": "metres, right-handed, z up",
    "camera": "OpenCV: x right, y down, z forward; pixel centres at +0.5",
    "block": "game axes: x east, y up, z south; camera_to_block is in blocks",
    "depth": "16 bits, millimetres along the camera's z axis; 0: no depth, 65535: larger depths",
    "masks": "np.unpackbits(mask, count=cells).reshape(shape); hits: pixels that see the cell",
}


def versions() -> dict[str, str]:
    """Return the program and library versions on which the files of a data set depend."""
    return {
        "world2minecraft": __version__,
        "numpy": np.__version__,
        "pillow": PIL.__version__,
        "python": ".".join(platform.python_version_tuple()[:2]),
    }


ShardContents = tuple[list[dict[str, Any]], FileSum]
"""The index rows of a shard and its checksum."""


def read_shard(folder: Path, name: str) -> ShardContents:
    """Return the index rows of a shard and its checksum.

    Raises:
        DamagedFileError: If the shard cannot be read.
    """
    return shard_rows(folder / name, name), sum_of_file(folder / name)


def finish_store(
    folder: Path,
    shards: list[str],
    meta: dict[str, Any],
    contents: Iterable[ShardContents],
) -> dict[str, Any]:
    """Write the index, the card, the checksums and ``dataset.json``, which completes the data set.

    Args:
        folder: Folder of the data set.
        shards: Paths of all shards inside the folder, in order.
        meta: Further content for ``dataset.json``, including ``images`` and ``scenes``.
        contents: Results of ``read_shard`` for each shard, in the same order.

    Returns:
        The content of ``dataset.json``.

    Raises:
        OutputError: If a file cannot be written.
    """
    sums: dict[str, FileSum] = {}

    def rows() -> Iterator[list[dict[str, Any]]]:
        for name, (some, sum_) in zip(shards, contents, strict=True):
            sums[name] = sum_
            yield some

    total = write_index(folder / INDEX, rows())
    whole = {
        **meta,
        "kind": KIND,
        "format": FORMAT,
        "checksums": CHECKSUMS,
        "complete": True,
        "conventions": CONVENTIONS,
        "shards": shards,
        "sha256": total,
        "versions": versions(),
    }
    write_card(folder, whole)
    data = json_bytes(whole)
    sums |= sums_of_files(folder, (CARD, CLASSES, INDEX, SCENES, WORLDS))
    write_checksums(folder, {**sums, META: sum_of_bytes(data)})
    write_bytes(folder / META, data)
    return whole


def write_store(
    folder: str | Path,
    samples: Iterable[OccSample],
    meta: dict[str, Any] | None = None,
    *,
    files: SampleFiles | None = None,
    force: bool = False,
    progress: Progress = no_progress,
) -> dict[str, Any]:
    """Write samples as a new data set. If this fails, the folder is unchanged.

    Consecutive samples with the same scene and split share shards. Samples are read one at a time,
    and fine classes are numbered in the order in which they appear.

    Args:
        folder: New or empty folder for the data set.
        samples: Samples to write. Keys must be unique; keys and scene names may contain letters,
            digits, ``-`` and ``_``. ``split`` must be ``train``, ``val``, ``test`` or empty.
        meta: Further content for ``dataset.json``.
        files: File formats of the samples.
        force: Whether to write into a folder that contains other files.
        progress: Callback that reports the number of samples written so far.

    Returns:
        The content of ``dataset.json``.

    Raises:
        ConflictError: If the folder already contains a data set, or another process writes it.
        UsageError: If a key, scene name or split is not valid, or if the folder contains other
            files without ``force``.
        OutputError: If a file cannot be written.
    """
    target, how = Path(folder), files or SampleFiles()
    arrow_modules()  # A missing pyarrow is reported before any work.
    with output_folder(target, DATASET, "written", force=force):
        if (target / META).exists():
            raise ConflictError(target, "already contains a data set; choose another folder")
        with draft_of(target) as draft:
            return _write_shards(draft, samples, dict(meta or {}), how, progress)


def _write_shards(
    folder: Path,
    samples: Iterable[OccSample],
    meta: dict[str, Any],
    files: SampleFiles,
    progress: Progress,
) -> dict[str, Any]:
    names: list[str] = []
    kinds: dict[FineClass, None] = {FineClass("minecraft:air"): None}
    images: dict[str, int] = {}
    scenes: dict[str, None] = {}
    batch: list[tuple[str, dict[str, bytes]]] = []
    place: tuple[str, str] | None = None
    keys: set[str] = set()

    def flush() -> None:
        if batch and place is not None:
            names.append(_shard(folder, place, batch, names))
            batch.clear()

    for done, sample in enumerate(samples, 1):
        _check_names(sample, keys)
        keys.add(sample.key)
        if (sample.split, sample.scene_id) != place or len(batch) == SHARD_SAMPLES:
            flush()
            place = (sample.split, sample.scene_id)
        kinds.update(dict.fromkeys(sample.fine_classes))
        batch.append((sample.key, pack_sample(sample, FineTable(tuple(kinds)), files)))
        images[sample.split or "all"] = images.get(sample.split or "all", 0) + 1
        scenes[sample.scene_id] = None
        progress("write", done, 0)
    flush()
    write_classes(folder, FineTable(tuple(kinds)))
    facts = {**meta, "images": images, "scenes": [{"scene_id": one} for one in scenes]}
    return finish_store(folder, names, facts, (read_shard(folder, name) for name in names))


def _check_names(sample: OccSample, known: Container[str]) -> None:
    """Check that the names of a sample can be stored and read again.

    Raises:
        UsageError: If a name or the split is not valid.
    """
    for what, name, most in (
        ("sample key", sample.key, MAX_KEY_LENGTH),
        ("scene name", sample.scene_id, MAX_SCENE_ID),
    ):
        if not re.fullmatch(rf"[A-Za-z0-9_-]{{1,{most}}}", name):
            raise UsageError(
                f"{what} must be 1 to {most} characters of A-Z, a-z, 0-9, - and _, got {name!r}"
            )
    if sample.key in known:
        raise UsageError(f"two samples have the key {sample.key!r}; sample keys must be unique")
    if sample.split not in ("", "train", "val", "test"):
        raise UsageError(f"split must be train, val, test or empty, got {sample.split!r}")


def _shard(
    folder: Path,
    place: tuple[str, str],
    batch: list[tuple[str, dict[str, bytes]]],
    names: list[str],
) -> str:
    """Write a shard of encoded samples and return its name."""
    number = 0
    while (name := shard_name(*place, number)) in names:
        number += 1
    with ShardWriter(folder / name, [key for key, _ in batch]) as shard:
        for _, members in batch[shard.done :]:
            shard.append(members)
        shard.finish()
    return name
