"""The rules of the loaders, held against the files of an export.

Trainers warn, drop a row or fail hours later; here a file that breaks a rule is named at once. An
export is checked so when it is written; files that were edited since can be checked again.
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
    """Have a check name the folder, too, where a row lacks a column or holds another kind."""

    @wraps(check)
    def checked(root: Path, *rest: Any) -> None:
        try:
            check(root, *rest)
        except (KeyError, TypeError, AttributeError, ValueError) as error:
            reason = f"a row is not as the trainer reads it ({type(error).__name__}: {error})"
            raise DamagedFileError(root, reason) from error

    return checked


@_report_bad_rows
def check_llamafactory(root: Path) -> None:
    """Check a folder by LLaMA-Factory's converter: turns that alternate, a picture for each mark.

    Raises:
        InputError: a file is missing. DamagedFileError: a row breaks a rule; it is named.
    """
    path = root / "dataset_info.json"
    for name, entry in read_json(path).items():
        rows_path = root / entry["file_name"]
        if entry.get("formatting") != "sharegpt" or "tags" not in entry:
            raise DamagedFileError(path, f"{name} must be sharegpt and say its tags")
        for number, row in enumerate(read_json(rows_path, MAX_BYTES)):
            turns = row["messages"]
            roles = tuple(turn["role"] for turn in turns)
            if not roles or roles != _TURNS * (len(roles) // 2):
                raise DamagedFileError(rows_path, f"row {number}: turns do not alternate: {roles}")
            text = "".join(turn["content"] for turn in turns)
            _check_pictures(rows_path, number, text.count(IMAGE), row["images"], root)


@_report_bad_rows
def check_easyr1(root: Path, image_dir: str | None) -> None:
    """Check a folder by EasyR1's loader: columns, a picture for each mark, a prompt to set it in.

    Args:
        root: the folder.
        image_dir: that the recipe names, under the folder; None where pictures are embedded.

    Raises:
        InputError: a file is missing. DamagedFileError: a row breaks a rule; it is named.
    """
    form = jinja2.Template(read_bytes(root / "mc.jinja", MAX_BYTES).decode().strip())
    for path in sorted(root.glob("*.parquet")):
        if "@" in path.name:
            raise InputError(path, "holds an @, which EasyR1 takes for the name of a split")
        for number, row in enumerate(_parquet_rows(path)):
            if not isinstance(row["content"], str) or not isinstance(row["answer"], str):
                raise DamagedFileError(path, f"row {number}: content and answer must be texts")
            if len(row["answer"]) != 1:
                raise DamagedFileError(path, f"row {number}: the answer must be a letter")
            marks = form.render(content=row["content"]).count(IMAGE)
            names = row["images"]
            if image_dir is None:
                if not all(image["bytes"] for image in names):
                    raise DamagedFileError(path, f"row {number}: an embedded picture is empty")
                names = [image["path"] for image in names]
            _check_pictures(path, number, marks, names, root / image_dir if image_dir else None)


@_report_bad_rows
def check_trl(root: Path) -> None:
    """Check a folder by what TRL asks: typed parts, a picture for each image part.

    Raises:
        InputError: a file is missing. DamagedFileError: a row breaks a rule; it is named.
    """
    for path in sorted(root.glob("*.jsonl")):
        for number, line in enumerate(read_bytes(path, MAX_BYTES).splitlines()):
            row = json.loads(line)
            parts = [part for turn in row["prompt"] for part in turn["content"]]
            marks = sum(part["type"] == "image" for part in parts)
            if any(part["type"] == "text" and IMAGE in part["text"] for part in parts):
                raise DamagedFileError(path, f"row {number}: a text holds {IMAGE}")
            _check_pictures(path, number, marks, row["images"], root)


def parquet_modules(what: str) -> tuple[Any, Any]:
    """Return pyarrow and its parquet. Raises MissingExtraError, for ``what`` one wants it."""
    try:
        import pyarrow as pa  # noqa: PLC0415
        import pyarrow.parquet as pq  # noqa: PLC0415
    except ImportError as error:
        raise MissingExtraError(what, "vln") from error
    return pa, pq


def _parquet_rows(path: Path) -> Iterable[dict[str, Any]]:
    pa, pq = parquet_modules("reading parquet")
    try:
        with pq.ParquetFile(path) as table:
            for batch in table.iter_batches(batch_size=64):
                yield from batch.to_pylist()
    except (pa.ArrowException, OSError) as error:
        raise DamagedFileError(path, f"is no parquet ({error})") from error


def _check_pictures(
    path: Path, number: int, marks: int, names: list[str], folder: Path | None
) -> None:
    if marks != len(names):
        raise DamagedFileError(path, f"row {number}: {marks} marks {IMAGE}, {len(names)} pictures")
    for name in names:
        try:
            check_image_name(name)
        except UsageError as error:
            raise DamagedFileError(path, f"row {number}: {error}") from error
        if folder is not None and not (folder / name).is_file():
            raise DamagedFileError(path, f"row {number}: {name} is not there")
