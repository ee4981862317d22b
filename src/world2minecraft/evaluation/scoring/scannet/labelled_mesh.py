"""What ScanNet publishes of a scene's truth: the labelled mesh, its segments, their groups.

In: a folder with ``SCENE_vh_clean_2.labels.ply`` (``label`` of each vertex is an NYU40 number),
``SCENE_vh_clean_2.0.010000.segs.json`` (``segIndices``: the segment of each vertex),
``SCENE.aggregation.json`` (``segGroups``: which segments are one thing) and ``SCENE.txt``
(``axisAlignment``). Out: one value, upright, with the floor at z = 0.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.capture.readers.datasets.nyu40_labels import (
    LABEL_TABLE,
    find_label_table,
    nyu40_classes,
    raw_id_classes,
)
from world2minecraft.capture.readers.datasets.scannet_metadata import (
    axis_alignment,
    read_scene_info,
)
from world2minecraft.capture.readers.meshes.ply import read_ply
from world2minecraft.core.classes import CLASS_COUNT, OBJECT_CLASSES, UNKNOWN, SemanticClass
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.errors import CaptureError, DamagedFileError, InputError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import LayoutObject

LABELLED = "_vh_clean_2.labels.ply"
NYU40_NUMBERS = 40
MAX_OBJECTS = 65_535
MIN_SIDE_M = 0.01  # A picture that is scanned as a plane still has a box.
# Parts of walls, though they are called objs: a run tells them as openings, not as objects.
OPENINGS = ("door", "doorframe", "doorway", "window")


@dataclass(frozen=True, eq=False)
class LabelledMesh:
    """A scene's surface in the truth's frame: z up, walls along the axes, the floor at z = 0.

    ``instance`` is 0, or n for the n-th of ``objects``. Objects are boxes along the axes around
    what was scanned of them; which way they look, nobody knows.
    """

    name: str
    vertices_m: np.ndarray  # float64 [V, 3]
    triangles: np.ndarray  # int64 [T, 3]
    classes: np.ndarray  # uint8 [V], 255 where nobody annotated it
    instance: np.ndarray  # uint16 [V]
    objects: tuple[LayoutObject, ...]
    truth_to_scan: np.ndarray  # float64 [4, 4]


def labelled_meshes(scene: Path) -> list[Path]:
    """Return the labelled meshes of a folder, none where it is no scene."""
    return sorted(scene.glob(f"*{LABELLED}")) if scene.is_dir() else []


def read_labelled_mesh(scene: Path) -> LabelledMesh:
    """Read a scene's labelled mesh and its objects.

    Raises:
        InputError: a file is missing. DamagedFileError: two of them do not belong together.
        CaptureError: the scene states no ``axisAlignment``, or labels that are not known.
    """
    path = _the_mesh(scene)
    name = path.name.removesuffix(LABELLED)
    file = read_ply(path)
    if not len(file.triangles):
        raise DamagedFileError(path, "has no faces; copy it again")
    places = np.stack([file.vertex[axis] for axis in "xyz"], axis=1).astype(np.float64)
    if not np.isfinite(places).all():
        raise DamagedFileError(path, "has places that are no numbers (NaN, infinity)")
    classes = _classes(path, scene, file.vertex)
    scan_to_truth = _alignment(scene / f"{name}.txt")
    upright = apply(scan_to_truth, places)
    floor = classes == SemanticClass.FLOOR
    if floor.any():
        shift = np.eye(4)
        shift[2, 3] = -float(np.median(upright[floor, 2]))
        scan_to_truth = shift @ scan_to_truth
        upright = apply(scan_to_truth, places)
    groups = _groups(scene, name, len(places))
    instance, objects = _objects(groups, upright, classes)
    return LabelledMesh(
        name, upright, file.triangles, classes, instance, objects, invert_rigid(scan_to_truth)
    )


def _the_mesh(scene: Path) -> Path:
    found = labelled_meshes(scene)
    if len(found) != 1:
        held = "several" if found else "no"
        raise InputError(
            scene, f"holds {held} *{LABELLED}; give one scene of ScanNet's train or val split"
        )
    return found[0]


def _classes(path: Path, scene: Path, columns: dict[str, np.ndarray]) -> np.ndarray:
    """Return uint8 [V] classes: of NYU40 numbers, or of raw ids through ScanNet's table."""
    if "label" not in columns:
        raise DamagedFileError(path, "has no column label; take the mesh that ends with labels.ply")
    values = np.nan_to_num(np.asarray(columns["label"], np.float64), nan=0, posinf=0, neginf=0)
    numbers = np.clip(values, 0, 65_535).astype(np.int64)
    most = int(numbers.max(initial=0))
    if most <= NYU40_NUMBERS:
        return nyu40_classes()[numbers]
    table = find_label_table([scene, scene.parent, scene.parent.parent])
    if table is None:
        raise CaptureError(
            path, f"has labels up to {most}, ScanNet's raw ids: put {LABEL_TABLE} beside the scene"
        )
    return raw_id_classes(table)[numbers]


def _alignment(path: Path) -> np.ndarray:
    found = axis_alignment(path, read_scene_info(path))
    if found is None:
        raise CaptureError(
            path, "states no axisAlignment; scenes of the train and val splits have one"
        )
    return found


def _groups(scene: Path, name: str, vertices: int) -> list[tuple[str, np.ndarray]]:
    """Return each group's name and its vertices, bool [V]."""
    segments_path, groups_path = _segments_file(scene, name), scene / f"{name}.aggregation.json"
    for path in (segments_path, groups_path):
        if not path.is_file():
            raise InputError(
                path, f"is not there; download-scannet.py --type {path.name.removeprefix(name)}"
            )
    segment = _whole_numbers(segments_path, _field(segments_path, read_json(segments_path)))
    if len(segment) != vertices:
        raise DamagedFileError(
            segments_path, f"tells {len(segment):,} vertices, and the mesh has {vertices:,}"
        )
    stated = read_json(groups_path)
    rows = stated.get("segGroups") if isinstance(stated, dict) else None
    if not isinstance(rows, list) or len(rows) > MAX_OBJECTS:
        raise DamagedFileError(groups_path, "has no list segGroups; copy it again")
    groups = []
    for number, row in enumerate(rows):
        held = row.get("segments") if isinstance(row, dict) else None
        if held is None:
            raise DamagedFileError(groups_path, f"group {number} has no segments; copy it again")
        own = np.isin(segment, _whole_numbers(groups_path, held))
        if len(held) and not own.any():
            raise DamagedFileError(
                groups_path, f"group {number} names segments that {segments_path.name} lacks"
            )
        groups.append((str(row.get("label", "")), own))
    return groups


def _segments_file(scene: Path, name: str) -> Path:
    """Return the segments of the labelled mesh; the number in its name is how they were cut."""
    found = sorted(scene.glob(f"{name}_vh_clean_2.*.segs.json"))
    return found[0] if found else scene / f"{name}_vh_clean_2.0.010000.segs.json"


def _field(path: Path, stated: Any) -> Any:
    if not isinstance(stated, dict) or "segIndices" not in stated:
        raise DamagedFileError(path, "has no list segIndices; copy it again")
    return stated["segIndices"]


def _whole_numbers(path: Path, values: Any) -> np.ndarray:
    try:
        return np.asarray(values, np.int64).reshape(-1)
    except (ValueError, TypeError, OverflowError) as error:
        raise DamagedFileError(path, "has segments that are no whole numbers") from error


def _objects(
    groups: list[tuple[str, np.ndarray]], places_m: np.ndarray, classes: np.ndarray
) -> tuple[np.ndarray, tuple[LayoutObject, ...]]:
    """Return the object of each vertex, uint16 [V], and the objects; structure is none."""
    instance, objects = np.zeros(len(classes), np.uint16), []
    for name, own in groups:
        known = classes[own & (classes != UNKNOWN)]
        if not len(known) or _is_opening(name):
            continue
        most = int(np.bincount(known, minlength=CLASS_COUNT).argmax())
        if most not in OBJECT_CLASSES:
            continue
        low, high = places_m[own].min(axis=0), places_m[own].max(axis=0)
        size = np.maximum(high - low, MIN_SIDE_M)
        objects.append(LayoutObject(most, (low + high) / 2, size, 0.0, name))
        instance[own] = len(objects)
    return instance, tuple(objects)


def _is_opening(name: str) -> bool:
    words = name.lower().split()
    return bool(words) and words[-1].removesuffix("s") in OPENINGS
