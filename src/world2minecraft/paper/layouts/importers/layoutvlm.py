"""Importer of LayoutVLM's ``layout.json`` and the scene file with its room and asset sizes.

The layout is ``{asset: {position [x, y, z], rotation [x, y, z]}}`` with centres in metres and
rotations in degrees about the axes, z up. At 0 degrees, the front faces along x. The scene file is
``{task_description, boundary {floor_vertices [[x, y, z]], wall_height}, assets {id: {...}}}``.
Sizes are in ``assetMetadata.boundingBox``, either in the scene file or in ``ID/data.json`` in the
asset folder. As in LayoutVLM, x and y are swapped when sizes are read: ``y`` is front to back.

LayoutVLM renames the assets of a layout by category (``dining_chair-1``, ``lamp_B-0``). Both these
names and those of the scene file are supported.
"""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from world2minecraft.core.errors import MALFORMED, InputError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import Layout, LayoutObject
from world2minecraft.paper.layouts.compared_scene import ComparedScene
from world2minecraft.paper.layouts.importers.value_checks import (
    FARTHEST_M,
    MAX_CORNERS,
    MAX_OBJECTS,
    USUAL_HEIGHT_M,
    Box,
    checked_count,
    clean_name,
    number,
    object_of,
    why,
)

if TYPE_CHECKING:
    from world2minecraft.paper.layouts.importers import How

METHOD = "LayoutVLM"
LAYOUT_FILE = "layout.json"
MAX_TASK_BYTES, MAX_ASSET_BYTES = 64 << 20, 1 << 20
MAX_ADJACENT_FILES = 200  # Files beside a layout that are searched.


class Format:
    """The layout format of LayoutVLM."""

    @staticmethod
    def is_mine(path: Path, data: Any) -> bool:
        """Return whether JSON data is a layout of LayoutVLM, or a folder contains one."""
        if path.is_dir():
            place = path / LAYOUT_FILE
            data = read_json(place) if place.is_file() else None
        if not isinstance(data, dict) or not data:
            return False
        first = next(iter(data.values()))
        return isinstance(first, dict) and "position" in first

    @staticmethod
    def read(path: Path, data: Any, how: "How") -> list[ComparedScene]:
        """Read the only scene of a layout.

        Raises:
            InputError: If the scene file is missing or invalid.
            ValueError: If a value is invalid.
            KeyError: If a field is missing.
            TypeError: If a field has the wrong type.
        """
        place = path / LAYOUT_FILE if path.is_dir() else path
        data = read_json(place) if data is None else data
        if len(data) > MAX_OBJECTS:
            raise ValueError(f"{len(data):,} objects exceed the limit of {MAX_OBJECTS:,}")
        task = _task(place, how.task)
        assets = dict(_assets(task, how.assets))
        objects, skipped = [], []
        for key, one in data.items():
            try:
                objects.append(_object(key, one, assets))
            except MALFORMED as error:
                skipped.append(f"{clean_name(key)}: {why(error)}")
        names = _names(task, how.assets)
        unplaced = [clean_name(name) for name, own in names if not {name, own} & set(data)]
        room = _room(task["boundary"])
        name = place.parent.name if place.name == LAYOUT_FILE else place.stem
        return [ComparedScene(name, METHOD, (room,), tuple(objects), tuple(unplaced),
                              tuple(skipped))]  # fmt: skip


FORMAT = Format()


def _task(place: Path, stated: Path | None) -> dict[str, Any]:
    """Return the given scene file, or the only one beside the layout."""
    if stated is not None:
        data = read_json(stated, MAX_TASK_BYTES)
        if not _is_task(data):
            raise InputError(stated, "not a LayoutVLM scene file: the boundary is missing")
        return data
    beside = sorted(place.parent.glob("*.json"))[:MAX_ADJACENT_FILES]
    found = [data for one in beside if one != place and _is_task(data := _try(one))]
    if len(found) != 1:
        raise InputError(
            place,
            f"{len(found)} scene files with a boundary found beside it; choose one with --task",
        )
    return found[0]


def _try(path: Path) -> Any:
    try:
        return read_json(path, MAX_TASK_BYTES)
    except InputError:
        return None


def _is_task(data: Any) -> bool:
    return isinstance(data, dict) and isinstance(data.get("boundary"), dict)


def _room(boundary: dict[str, Any]) -> Layout:
    corners = checked_count(boundary["floor_vertices"], MAX_CORNERS, "floor_vertices")
    points = np.array([[number(value, "a corner") for value in one[:2]] for one in corners])
    if points.ndim != 2 or points.shape[1] != 2 or np.abs(points).max() > FARTHEST_M:
        raise ValueError("floor_vertices must be a list of corners [x, y, z] in metres")
    if len(points) > 3 and np.allclose(points[0], points[-1]):
        points = points[:-1]
    x, y = points.T
    if x @ np.roll(y, -1) - y @ np.roll(x, -1) < 0:
        points = points[::-1]
    height = number(boundary.get("wall_height", USUAL_HEIGHT_M), "wall_height")
    return Layout(points, height)


def _assets(task: dict[str, Any], folder: Path | None) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the data of each asset under its own name and under its name in layouts."""
    assets = task.get("assets", {})
    for name, uid in _names(task, folder):
        known = _data(uid, assets.get(uid) or {}, folder)
        yield uid, known
        yield name, known


def _names(task: dict[str, Any], folder: Path | None) -> list[tuple[str, str]]:
    """Return the layout name and the original name of each asset of a scene file."""
    assets = task.get("assets", {})
    if not isinstance(assets, dict) or len(assets) > MAX_OBJECTS:
        raise ValueError(f"assets must be an object with at most {MAX_OBJECTS:,} names")
    groups: dict[str, list[str]] = {}
    for key in assets:
        groups.setdefault(_model(key), []).append(key)
    plain = {model: _category(_data(keys[0], assets[keys[0]] or {}, folder), keys[0])
             for model, keys in groups.items()}  # fmt: skip
    kinds, seen, names = Counter(plain.values()), Counter(), []
    for model, keys in groups.items():
        word = plain[model]
        seen[word] += 1
        suffix = f"_{chr(ord('A') + seen[word] - 1)}" if kinds[word] > 1 else ""
        for count, key in enumerate(keys):
            word += suffix  # Added again for each instance, as LayoutVLM does.
            names.append((f"{word}-{count}", key))
    return names


def _model(key: str) -> str:
    """Return the name of an asset without its number."""
    head, _, tail = key.rpartition("-")
    return head if head and tail.isdigit() else key


def _data(key: str, stated: dict[str, Any], folder: Path | None) -> dict[str, Any]:
    """Return the data of an asset from the scene file or the asset folder."""
    if "assetMetadata" in stated or folder is None:
        return stated
    model = _model(key)
    if model != Path(model).name or model in (".", ".."):
        return stated  # A name is no path.
    for root in (folder, folder / "test_asset_dir"):
        place = root / model / "data.json"
        if place.is_file():
            return {**read_json(place, MAX_ASSET_BYTES), **stated}
    return stated


def _category(known: dict[str, Any], key: str) -> str:
    category = known.get("category") or (known.get("annotations") or {}).get("category")
    word = clean_name(category or _model(key))
    for letter in "- '/,":
        word = word.replace(letter, "_")
    return word.lower()


def _object(key: str, one: dict[str, Any], assets: dict[str, Any]) -> LayoutObject:
    known = assets.get(key)
    if known is None:
        raise ValueError("not among the assets of the scene file")
    box = (known.get("assetMetadata") or {}).get("boundingBox")
    if not isinstance(box, dict):
        raise ValueError("size is unknown; give the asset folder with --assets")
    x, y, z = (number(value, "position") for value in one["position"])
    side, deep, high = (number(box[axis], f"size {axis}") for axis in "xyz")
    turn = one["rotation"]
    turned = number(turn[2] if isinstance(turn, list) else turn, "rotation")
    return object_of(Box(_category(known, key), (x, y, z), (deep, side, high), turned))
