"""Reading and writing of items, trajectories and episodes as JSONL, one validated record per line.

A line is a JSON object with the fields of a type in ``navigation.types``. A ``Move`` is written as
its number. Records keep the order of the caller, and equal records give identical files. Input
files are not trusted: sizes are limited, types must match exactly (numbers must not be quoted), and
names that would leave the folder are rejected.
"""

import json
import math
import os
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from pydantic import TypeAdapter, ValidationError

from world2minecraft.core.checksums import CHECKSUMS
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UsageError
from world2minecraft.core.file_names import is_text
from world2minecraft.core.files import write_text
from world2minecraft.core.output_folders import FolderKind
from world2minecraft.navigation.types import Episode, Item, Trajectory

ITEMS = "items.jsonl"
TRAJECTORIES = "trajectories.jsonl"
EPISODES = "episodes.jsonl"
ABOUT, CARD = "dataset.json", "README.md"
IMAGES = "images"
SCENES_FOLDER = "scenes"  # Scenes that were generated for the set.
# Files that people and models add to a set, which its list of files does not contain.
ANNOTATIONS, REPLIES_FOLDER = "annotations.jsonl", "rewriting"
NAVIGATION_SET = FolderKind(
    {ITEMS: ""},
    (ABOUT, CARD, ITEMS, TRAJECTORIES, EPISODES, CHECKSUMS, IMAGES, SCENES_FOLDER),
)

# A set of the paper's size has 3,542 items of about 2 kB.
MAX_FILE_BYTES = 1 << 30
MAX_LINE_BYTES = 1 << 20
MAX_RECORDS = 1_000_000
MAX_TEXT = 4_000  # Characters of an instruction or an option; the paper's longest has 340.
MAX_NAME = 240
MAX_IMAGES = 64  # Of one item.
_SHA256 = re.compile(r"[0-9a-f]{64}")

Record = TypeVar("Record", Item, Trajectory, Episode)


def read_items(path: str | Path) -> list[Item]:
    """Read the items of a set folder or a JSONL file.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If a line is not a valid item, or an ID occurs twice.
        LimitError: If the file is too large.
    """
    return _read(_file(path, ITEMS), Item, check_item, lambda item: item.item_id)


def read_trajectories(path: str | Path) -> list[Trajectory]:
    """Read the trajectories of a set folder or a JSONL file.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If a line is not a valid trajectory, or an ID occurs twice.
        LimitError: If the file is too large.
    """
    return _read(
        _file(path, TRAJECTORIES), Trajectory, check_trajectory, lambda one: one.trajectory_id
    )


def read_episodes(path: str | Path) -> list[Episode]:
    """Read the episodes of a set folder or a JSONL file.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If a line is not a valid episode, or an ID occurs twice.
        LimitError: If the file is too large.
    """
    return _read(_file(path, EPISODES), Episode, check_episode, lambda one: one.episode_id)


def write_items(path: str | Path, items: Iterable[Item]) -> None:
    """Write items to a JSONL file that ``read_items`` can read.

    Raises:
        UsageError: If an item is invalid.
        OutputError: If the file cannot be written.
    """
    _write(path, items, check_item)


def write_trajectories(path: str | Path, trajectories: Iterable[Trajectory]) -> None:
    """Write trajectories to a JSONL file.

    Raises:
        UsageError: If a trajectory is invalid.
        OutputError: If the file cannot be written.
    """
    _write(path, trajectories, check_trajectory)


def write_episodes(path: str | Path, episodes: Iterable[Episode]) -> None:
    """Write episodes to a JSONL file.

    Raises:
        UsageError: If an episode is invalid.
        OutputError: If the file cannot be written.
    """
    _write(path, episodes, check_episode)


def to_json_line(record: Item | Trajectory | Episode) -> str:
    """Return the JSON line of a record, without the line break.

    Raises:
        UsageError: If a value is not finite or cannot be represented in JSON.
    """
    fields = asdict(record)
    try:
        line = _compact(fields, ensure_ascii=False)
        if not is_text(line):
            # Only paths may contain bytes that are not UTF-8, as surrogate escapes.
            os.fsencode(str(fields.get("scene", "")))
            _compact(fields | {"scene": ""}, ensure_ascii=False).encode()
            line = _compact(fields, ensure_ascii=True)
    except (TypeError, ValueError) as error:
        raise UsageError(f"the record cannot be written as JSON: {error}") from error
    return line


def _compact(fields: dict[str, Any], *, ensure_ascii: bool) -> str:
    return json.dumps(fields, ensure_ascii=ensure_ascii, allow_nan=False, separators=(",", ":"))


def parse_record(kind: type[Record], line: str | bytes) -> Record:
    """Parse a JSON line into a record, and check the types of its fields.

    Raises:
        UsageError: If the line is not a valid record. The message names the invalid field.
    """
    try:
        json.loads(line, parse_constant=_not_finite, parse_float=_finite)
        return _adapter(kind).validate_json(line, strict=True)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        place = ".".join(str(part) for part in first["loc"]) or "the line"
        raise UsageError(f"{place}: {first['msg']}") from error
    except (ValueError, RecursionError) as error:
        raise UsageError(f"not valid JSON ({error})") from error


def check_item(item: Item) -> None:
    """Check that an item is valid.

    Raises:
        UsageError: If a name is invalid, an image path leaves the folder or has no checksum, or the
            options do not fit the task.
    """
    _check_names(item.item_id, item.trajectory_id)
    check_scene_id(item.scene_id)
    _check_text("the instruction", item.instruction.text)
    if item.step < 0:
        raise UsageError(f"step must be 0 or more, got {item.step}")
    if item.composition not in ("base", "extend"):
        raise UsageError(f"composition must be base or extend, got {item.composition!r}")
    if len(item.options) < 2:
        raise UsageError(f"options must have two or more entries, got {len(item.options)}")
    shown, hidden = ("image", "text") if item.task == "next_view" else ("text", "image")
    for option in item.options:
        _check_text(f"option {option.label}", option.text or option.label)
        if not getattr(option, shown) or getattr(option, hidden):
            raise UsageError(
                f"option {option.label}: the options of a {item.task} item must have {shown} only"
            )
    if len(item.images) > MAX_IMAGES:
        raise UsageError(f"the item has {len(item.images)} images, the limit is {MAX_IMAGES}")
    for name in item.images:
        check_image_name(name)
        _check_sum(name, item.sha256.get(name, ""))
    _check_scale(item.metres_per_block)


def check_trajectory(trajectory: Trajectory) -> None:
    """Check that a trajectory is valid.

    Raises:
        UsageError: If a field of the trajectory is invalid.
    """
    _check_names(trajectory.trajectory_id)
    check_scene_id(trajectory.scene_id)
    if not trajectory.keyframes:
        raise UsageError(f"trajectory {trajectory.trajectory_id} has no keyframes")
    for keyframe in trajectory.keyframes:
        check_image_name(keyframe.image)
        if keyframe.sha256:
            _check_sum(keyframe.image, keyframe.sha256)
    for instruction in trajectory.instructions:
        _check_text("an instruction", instruction.text)
    if trajectory.path_m < 0:
        raise UsageError(f"path_m must be 0 or more, got {trajectory.path_m}")
    _check_scale(trajectory.metres_per_block)


def check_episode(episode: Episode) -> None:
    """Check that an episode is valid.

    Raises:
        UsageError: If a field of the episode is invalid.
    """
    _check_names(episode.episode_id)
    check_scene_id(episode.scene_id)
    _check_text("the instruction", episode.instruction.text)
    if not 1 <= episode.max_steps <= 100_000:
        raise UsageError(f"max_steps must be 1 to 100000, got {episode.max_steps}")


def resolve_scene_path(scene: str, folder: Path) -> Path:
    """Return the path of an episode's scene, as recorded or relative to its set.

    If the set has been moved, the scene is also searched for in the ``SCENES_FOLDER`` of the set.

    Args:
        scene: The path recorded in the episode.
        folder: The folder of the set.
    """
    stated = Path(scene)
    own = folder / SCENES_FOLDER / stated.name
    places = (stated, folder / stated, own)
    return next((place for place in places if place.exists()), stated)


def check_image_name(name: str) -> None:
    """Check that an image name is a plain path inside the folder of the set.

    Raises:
        UsageError: If the name is empty, absolute, leaves the folder or has invalid characters.

    Example:
        >>> check_image_name("images/kitchen/t003/004.jpg")
    """
    parts = name.split("/")
    strange = any(not mark.isprintable() or mark in '\\:*?"<>|' for mark in name)
    if strange or len(name) > MAX_NAME or any(part.strip(". ") == "" for part in parts):
        raise UsageError(
            f"image {name[:80]!r} must be a path inside the folder of the set, such as "
            "images/room/t0/0.jpg"
        )


def check_scene_id(name: str) -> None:
    """Check that a scene ID is a valid file name, because exports use it in file names.

    Raises:
        UsageError: If the ID is empty, too long or has invalid characters.
    """
    _check_names(name)
    if any(mark in '/\\:*?"<>|' for mark in name) or not name.strip(". "):
        raise UsageError(f"scene ID {name[:80]!r} must be a valid file name")


@cache
def _adapter(kind: type[Any]) -> TypeAdapter[Any]:
    return TypeAdapter(kind)


def _file(path: str | Path, name: str) -> Path:
    place = Path(path)
    return place / name if place.is_dir() else place


def _read(
    path: Path,
    kind: type[Record],
    check: Callable[[Record], None],
    name: Callable[[Record], str],
) -> list[Record]:
    records, seen = [], set()
    for number, line in _lines(path):
        try:
            record = parse_record(kind, line)
            check(record)
        except UsageError as error:
            raise DamagedFileError(path, f"line {number}: {error}") from error
        if name(record) in seen:
            raise DamagedFileError(path, f"line {number}: duplicate ID {name(record)}")
        seen.add(name(record))
        records.append(record)
    return records


def _lines(path: Path) -> Iterator[tuple[int, bytes]]:
    """Yield the non-empty lines of a file with their numbers, starting at 1."""
    try:
        size = path.stat().st_size
        if size > MAX_FILE_BYTES:
            raise LimitError(
                path, f"file of {size:,} bytes exceeds the limit of {MAX_FILE_BYTES:,}"
            )
        with path.open("rb") as stream:
            number = 0
            while line := stream.readline(MAX_LINE_BYTES + 1):
                number += 1
                if len(line) > MAX_LINE_BYTES:
                    raise LimitError(
                        path, f"line {number}: exceeds the limit of {MAX_LINE_BYTES:,} bytes"
                    )
                if number > MAX_RECORDS:
                    raise LimitError(path, f"file exceeds the limit of {MAX_RECORDS:,} lines")
                if line.strip():
                    yield number, line
    except FileNotFoundError as error:
        raise InputError(path, "not found; w2m vln build SCENE --out SET writes it") from error
    except OSError as error:
        raise InputError(path, f"cannot be read: {error.strerror or error}") from error


def _write(path: str | Path, records: Iterable[Record], check: Callable[[Record], None]) -> None:
    lines = []
    for record in records:
        check(record)
        lines.append(f"{to_json_line(record)}\n")
    write_text(path, "".join(lines))


def _check_names(*names: str) -> None:
    for name in names:
        if not name or len(name) > MAX_NAME or not name.isprintable() or name != name.strip():
            raise UsageError(
                f"{name[:80]!r} is not a valid name: expected 1 to {MAX_NAME} printable characters"
            )


def _check_text(what: str, text: str) -> None:
    if len(text) > MAX_TEXT:
        raise UsageError(f"{what} has {len(text):,} characters, the limit is {MAX_TEXT:,}")


def _check_sum(name: str, sum_: str) -> None:
    if not _SHA256.fullmatch(sum_):
        raise UsageError(f"sha256 of {name} must be 64 hexadecimal digits, got {sum_[:80]!r}")


def _check_scale(metres_per_block: float) -> None:
    if not 1e-3 <= metres_per_block <= 1e3:
        raise UsageError(f"metres_per_block must be 0.001 to 1000, got {metres_per_block}")


def _finite(text: str) -> float:
    value = float(text)
    return value if math.isfinite(value) else _not_finite(text)


def _not_finite(text: str) -> NoReturn:
    raise ValueError(f"{text} is not a finite number")
