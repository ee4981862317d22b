"""Checks of exported files against the rules of the trainers' loaders.

Trainers warn, drop rows or fail hours later, so these checks report invalid rows immediately. Every
export is checked when it is written. Files that were edited later can be checked again.
"""

import json
from collections.abc import Callable, Iterable
from functools import wraps
from pathlib import Path
from typing import Any

import jinja2

from world2minecraft.core.errors import DamagedFileError, InputError, MissingExtraError, UsageError
from world2minecraft.core.files import read_bytes, read_json
from world2minecraft.navigation.item_prompts import IMAGE
from world2minecraft.navigation.records import check_image_name

MAX_BYTES = 1 << 30
_TURNS = ("user", "assistant")
Check = Callable[..., None]


def _report_bad_rows(check: Check) -> Check:
    """Convert exceptions for missing or mistyped columns into a DamagedFileError for the folder."""

    @wraps(check)
    def checked(root: Path, *rest: Any) -> None:
        """Run the check and raise DamagedFileError for a malformed row."""
        try:
            check(root, *rest)
        except (KeyError, TypeError, AttributeError, ValueError) as error:
            reason = (
                "a row does not have the structure that the trainer expects "
                f"({type(error).__name__}: {error})"
            )
            raise DamagedFileError(root, reason) from error

    return checked


@_report_bad_rows
def check_llamafactory(root: Path) -> None:
    """Check a LLaMA-Factory export: alternating turns, and one image per placeholder.

    Raises:
        InputError: If a file is missing.
        DamagedFileError: If a row breaks a rule.
    """
    path = root / "dataset_info.json"
    for name, entry in read_json(path).items():
        rows_path = root / entry["file_name"]
        if entry.get("formatting") != "sharegpt" or "tags" not in entry:
            raise DamagedFileError(
                path, f"entry {name} must have the format sharegpt and define its role tags"
            )
        for number, row in enumerate(read_json(rows_path, MAX_BYTES)):
            turns = row["messages"]
            roles = tuple(turn["role"] for turn in turns)
            if not roles or roles != _TURNS * (len(roles) // 2):
                raise DamagedFileError(
                    rows_path, f"row {number}: user and assistant turns must alternate, got {roles}"
                )
            text = "".join(turn["content"] for turn in turns)
            _check_pictures(rows_path, number, text.count(IMAGE), row["images"], root)


@_report_bad_rows
def check_easyr1(root: Path, image_dir: str | None) -> None:
    """Check an EasyR1 export: columns, one image per placeholder, and a prompt template.

    Args:
        root: The folder of the export.
        image_dir: The image folder of the recipe, relative to ``root``. None for embedded images.

    Raises:
        InputError: If a file is missing.
        DamagedFileError: If a row breaks a rule.
    """
    form = jinja2.Template(read_bytes(root / "mc.jinja", MAX_BYTES).decode().strip())
    for path in sorted(root.glob("*.parquet")):
        if "@" in path.name:
            raise InputError(
                path,
                "the path must not contain '@', because EasyR1 reads the text after it as the "
                "name of a split; export to another folder",
            )
        for number, row in enumerate(_parquet_rows(path)):
            if not isinstance(row["content"], str) or not isinstance(row["answer"], str):
                raise DamagedFileError(path, f"row {number}: content and answer must be strings")
            if len(row["answer"]) != 1:
                raise DamagedFileError(path, f"row {number}: the answer must be a single letter")
            marks = form.render(content=row["content"]).count(IMAGE)
            names = row["images"]
            if image_dir is None:
                if not all(image["bytes"] for image in names):
                    raise DamagedFileError(path, f"row {number}: an embedded image is empty")
                names = [image["path"] for image in names]
            _check_pictures(path, number, marks, names, root / image_dir if image_dir else None)


@_report_bad_rows
def check_trl(root: Path) -> None:
    """Check a TRL export: typed message parts, and one image per image part.

    Raises:
        InputError: If a file is missing.
        DamagedFileError: If a row breaks a rule.
    """
    for path in sorted(root.glob("*.jsonl")):
        for number, line in enumerate(read_bytes(path, MAX_BYTES).splitlines()):
            row = json.loads(line)
            parts = [part for turn in row["prompt"] for part in turn["content"]]
            marks = sum(part["type"] == "image" for part in parts)
            if any(part["type"] == "text" and IMAGE in part["text"] for part in parts):
                raise DamagedFileError(path, f"row {number}: a text must not contain {IMAGE}")
            _check_pictures(path, number, marks, row["images"], root)


def parquet_modules(what: str) -> tuple[Any, Any]:
    """Import pyarrow and its Parquet module.

    Args:
        what: The feature that requires them, for the error message.

    Raises:
        MissingExtraError: If pyarrow is not installed.
    """
    try:
        import pyarrow as pa  # noqa: PLC0415
        import pyarrow.parquet as pq  # noqa: PLC0415
    except ImportError as error:
        raise MissingExtraError(what, "vln") from error
    return pa, pq


def _parquet_rows(path: Path) -> Iterable[dict[str, Any]]:
    pa, pq = parquet_modules("reading Parquet")
    try:
        with pq.ParquetFile(path) as table:
            for batch in table.iter_batches(batch_size=64):
                yield from batch.to_pylist()
    except (pa.ArrowException, OSError) as error:
        raise DamagedFileError(path, f"not a valid Parquet file ({error})") from error


def _check_pictures(
    path: Path, number: int, marks: int, names: list[str], folder: Path | None
) -> None:
    if marks != len(names):
        raise DamagedFileError(
            path, f"row {number}: the text has {marks} {IMAGE} placeholders for {len(names)} images"
        )
    for name in names:
        try:
            check_image_name(name)
        except UsageError as error:
            raise DamagedFileError(path, f"row {number}: {error}") from error
        if folder is not None and not (folder / name).is_file():
            raise DamagedFileError(path, f"row {number}: image {name} not found")
