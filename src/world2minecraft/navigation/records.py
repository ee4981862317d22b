"""Items, trajectories and episodes on disk: JSONL, one record a line, checked before it is used.

A line is the JSON object of a value of ``navigation.types`` under the names of its fields; a
``Move`` is its number. The lines of ``write_items`` are sorted by nothing but the caller, and the
same values give the same bytes. Files of others are hostile until read: sizes come before memory,
types are exact (no number in quotes), and a name that would leave the folder is refused.
"""

import json
import math
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from pydantic import TypeAdapter, ValidationError

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UsageError
from world2minecraft.core.files import write_text
from world2minecraft.navigation.types import Episode, Item, Trajectory

ITEMS = "items.jsonl"
TRAJECTORIES = "trajectories.jsonl"
EPISODES = "episodes.jsonl"
ABOUT = "dataset.json"
SCENES_FOLDER = "scenes"  # Of a set, where its scenes were made for it.

# A set of the paper's size has 3,542 items of about 2 kB.
MAX_FILE_BYTES = 1 << 30
MAX_LINE_BYTES = 1 << 20
MAX_RECORDS = 1_000_000
MAX_TEXT = 4_000  # Characters of an instruction or an option; the paper's longest has 340.
MAX_NAME = 240
MAX_IMAGES = 64  # That one item shows.
_SHA256 = re.compile(r"[0-9a-f]{64}")

Record = TypeVar("Record", Item, Trajectory, Episode)


def read_items(path: str | Path) -> list[Item]:
    """Read the items of a set folder or of one JSONL file.

    Raises:
        InputError: it is not there. DamagedFileError: a line is no item, or an id comes twice; the
            message names the line. LimitError: it is too large.
    """
    return _read(_file(path, ITEMS), Item, check_item, lambda item: item.item_id)


def read_trajectories(path: str | Path) -> list[Trajectory]:
    """Read the trajectories of a set folder or of one JSONL file. Raises as ``read_items``."""
    return _read(
        _file(path, TRAJECTORIES), Trajectory, check_trajectory, lambda one: one.trajectory_id
    )


def read_episodes(path: str | Path) -> list[Episode]:
    """Read the episodes of a set folder or of one JSONL file. Raises as ``read_items``."""
    return _read(_file(path, EPISODES), Episode, check_episode, lambda one: one.episode_id)


def write_items(path: str | Path, items: Iterable[Item]) -> None:
    """Write items to a JSONL file; ``read_items`` gives the same back.

    Raises:
        UsageError: an item is not sound. OutputError: the file cannot be written.
    """
    _write(path, items, check_item)


def write_trajectories(path: str | Path, trajectories: Iterable[Trajectory]) -> None:
    """Write trajectories to a JSONL file. Raises as ``write_items``."""
    _write(path, trajectories, check_trajectory)


def write_episodes(path: str | Path, episodes: Iterable[Episode]) -> None:
    """Write episodes to a JSONL file. Raises as ``write_items``."""
    _write(path, episodes, check_episode)


def to_json_line(record: Item | Trajectory | Episode) -> str:
    """Return the JSON line of a record, its end of line not included.

    Raises:
        UsageError: it holds a number that is not finite, or something that JSON has no form for.
    """
    try:
        line = json.dumps(
            asdict(record), ensure_ascii=False, allow_nan=False, separators=(",", ":")
        )
        line.encode()  # Half a surrogate pair is no text.
    except (TypeError, ValueError) as error:
        raise UsageError(f"a record cannot be written as JSON: {error}") from error
    return line


def parse_record(kind: type[Record], line: str | bytes) -> Record:
    """Return the record of a JSON line, its types checked but not its names.

    Raises:
        UsageError: it is none; the message says which field is wrong and how.
    """
    try:
        json.loads(line, parse_constant=_not_finite, parse_float=_finite)
        return _adapter(kind).validate_json(line, strict=True)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        place = ".".join(str(part) for part in first["loc"]) or "the line"
        raise UsageError(f"{place}: {first['msg']}") from error
    except (ValueError, RecursionError) as error:
        raise UsageError(f"is not JSON ({error})") from error


def check_item(item: Item) -> None:
    """Refuse an item that no reader could use.

    Raises:
        UsageError: a name is no name, an image leaves the folder or has no sum, or the options
            are not what the task shows.
    """
    _check_names(item.item_id, item.trajectory_id)
    check_scene_id(item.scene_id)
    _check_text("the instruction", item.instruction.text)
    if item.step < 0:
        raise UsageError(f"step: is {item.step}, not 0 or more")
    if item.composition not in ("base", "extend"):
        raise UsageError(f"composition: must be base or extend, not {item.composition!r}")
    if len(item.options) < 2:
        raise UsageError(f"options: a choice has two or more, not {len(item.options)}")
    shown, hidden = ("image", "text") if item.task == "next_view" else ("text", "image")
    for option in item.options:
        _check_text(f"option {option.label}", option.text or option.label)
        if not getattr(option, shown) or getattr(option, hidden):
            raise UsageError(f"option {option.label}: of a {item.task} item has {shown} alone")
    if len(item.images) > MAX_IMAGES:
        raise UsageError(f"shows {len(item.images)} images; at most {MAX_IMAGES} are read")
    for name in item.images:
        check_image_name(name)
        _check_sum(name, item.sha256.get(name, ""))
    _check_scale(item.metres_per_block)


def check_trajectory(trajectory: Trajectory) -> None:
    """Refuse a trajectory that no reader could use. Raises UsageError."""
    _check_names(trajectory.trajectory_id)
    check_scene_id(trajectory.scene_id)
    if not trajectory.keyframes:
        raise UsageError(f"trajectory {trajectory.trajectory_id} has no keyframe")
    for keyframe in trajectory.keyframes:
        check_image_name(keyframe.image)
        if keyframe.sha256:
            _check_sum(keyframe.image, keyframe.sha256)
    for instruction in trajectory.instructions:
        _check_text("an instruction", instruction.text)
    if trajectory.path_m < 0:
        raise UsageError(f"path_m: is {trajectory.path_m}, not 0 or more")
    _check_scale(trajectory.metres_per_block)


def check_episode(episode: Episode) -> None:
    """Refuse an episode that no reader could use. Raises UsageError."""
    _check_names(episode.episode_id)
    check_scene_id(episode.scene_id)
    _check_text("the instruction", episode.instruction.text)
    if not 1 <= episode.max_steps <= 100_000:
        raise UsageError(f"max_steps: is {episode.max_steps}, not 1 to 100000")


def resolve_scene_path(scene: str, folder: Path) -> Path:
    """Return where an episode's scene lies: as its path says, or from the folder of its set.

    A set that was moved brings along the scenes that were made for it, in its ``SCENES_FOLDER``.

    Args:
        scene: the path that the episode says.
        folder: of the set.
    """
    stated = Path(scene)
    own = folder / SCENES_FOLDER / stated.name
    places = (stated, folder / stated, own)
    return next((place for place in places if place.exists()), stated)


def check_image_name(name: str) -> None:
    """Refuse a name of an image that is not a plain path under the folder of the set.

    Raises:
        UsageError: it is empty, absolute, leaves the folder, or has marks that no path of ours has.

    Example:
        >>> check_image_name("images/kitchen/t003/004.jpg")
    """
    parts = name.split("/")
    strange = any(not mark.isprintable() or mark in '\\:*?"<>|' for mark in name)
    if strange or len(name) > MAX_NAME or any(part.strip(". ") == "" for part in parts):
        raise UsageError(
            f"image {name[:80]!r}: must be a path under the set's folder, like images/room/t0/0.jpg"
        )


def check_scene_id(name: str) -> None:
    """Refuse the id of a scene that is no name of a file: exports call files by it.

    Raises:
        UsageError: it is empty, long, or has marks that no name of a file may have.
    """
    _check_names(name)
    if any(mark in '/\\:*?"<>|' for mark in name) or not name.strip(". "):
        raise UsageError(f"scene {name[:80]!r}: its id must be a name that a file could have")


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
            raise DamagedFileError(path, f"line {number}: {name(record)} was there before")
        seen.add(name(record))
        records.append(record)
    return records


def _lines(path: Path) -> Iterator[tuple[int, bytes]]:
    """Yield the lines that hold something, with their numbers from 1."""
    try:
        size = path.stat().st_size
        if size > MAX_FILE_BYTES:
            raise LimitError(path, f"has {size:,} bytes; at most {MAX_FILE_BYTES:,} are read")
        with path.open("rb") as stream:
            number = 0
            while line := stream.readline(MAX_LINE_BYTES + 1):
                number += 1
                if len(line) > MAX_LINE_BYTES:
                    raise LimitError(path, f"line {number}: has over {MAX_LINE_BYTES:,} bytes")
                if number > MAX_RECORDS:
                    raise LimitError(
                        path, f"has over {MAX_RECORDS:,} lines, the most that are read"
                    )
                if line.strip():
                    yield number, line
    except FileNotFoundError as error:
        raise InputError(path, "is not there; w2m vln build SCENE --out SET writes it") from error
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
            raise UsageError(f"{name[:80]!r} is no name: it has 1 to {MAX_NAME} printable marks")


def _check_text(what: str, text: str) -> None:
    if len(text) > MAX_TEXT:
        raise UsageError(f"{what} has {len(text):,} characters; at most {MAX_TEXT:,} are read")


def _check_sum(name: str, sum_: str) -> None:
    if not _SHA256.fullmatch(sum_):
        raise UsageError(f"sha256 of {name}: must be 64 hexadecimal digits, not {sum_[:80]!r}")


def _check_scale(metres_per_block: float) -> None:
    if not 1e-3 <= metres_per_block <= 1e3:
        raise UsageError(f"metres_per_block: is {metres_per_block}, not 0.001 to 1000")


def _finite(text: str) -> float:
    value = float(text)
    return value if math.isfinite(value) else _not_finite(text)


def _not_finite(text: str) -> NoReturn:
    raise ValueError(f"{text} is no finite number")
