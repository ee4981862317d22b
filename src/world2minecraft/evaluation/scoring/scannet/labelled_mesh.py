"""Reading of ScanNet's annotations of a scene: the labelled mesh, its segments and their groups.

The folder of a scene must contain ``SCENE_vh_clean_2.labels.ply`` (the NYU40 ``label`` of each
vertex), ``SCENE_vh_clean_2.0.010000.segs.json`` (``segIndices``, the segment of each vertex),
``SCENE.aggregation.json`` (``segGroups``, the segments of each object) and ``SCENE.txt``
(``axisAlignment``). The result is upright, with the floor at z = 0.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.capture.readers.datasets.label_ids import (
    LABEL_TABLE,
    find_label_table,
    raw_id_labels,
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
from world2minecraft.core.vocabulary import label_id_classes, nyu40_classes

LABELLED = "_vh_clean_2.labels.ply"
NYU40_NUMBERS = 40
MAX_OBJECTS = 65_535
MIN_SIDE_M = 0.01  # A picture that is scanned as a plane still has a box.
# Parts of walls with the class objs: a run reports them as openings, not as objects.
OPENINGS = ("door", "doorframe", "doorway", "window")


@dataclass(frozen=True, eq=False)
class LabelledMesh:
    """The labelled surface of a scene: z up, walls along the axes, floor at z = 0.

    Attributes:
        name: The name of the scene.
        vertices_m: The vertices in metres as float64 [V, 3].
        triangles: The vertex indices of the triangles as int64 [T, 3].
        classes: The class of each vertex as uint8 [V], or 255 without an annotation.
        instance: The number of each vertex's object in ``objects`` from 1, or 0, as uint16 [V].
        objects: The axis-aligned boxes around the scanned parts of objects, without orientation.
        truth_to_scan: The transform to the frame of the scan as float64 [4, 4].
    """

    name: str
    vertices_m: np.ndarray
    triangles: np.ndarray
    classes: np.ndarray
    instance: np.ndarray
    objects: tuple[LayoutObject, ...]
    truth_to_scan: np.ndarray


def labelled_meshes(scene: Path) -> list[Path]:
    """Return the labelled meshes in a folder."""
    return sorted(scene.glob(f"*{LABELLED}")) if scene.is_dir() else []


def read_labelled_mesh(scene: Path) -> LabelledMesh:
    """Read the labelled mesh of a scene, and its objects.

    Raises:
        InputError: If a file is missing.
        DamagedFileError: If a file is invalid, or files do not belong together.
        CaptureError: If the scene has no ``axisAlignment``, or has unknown labels.
    """
    path = _the_mesh(scene)
    name = path.name.removesuffix(LABELLED)
    file = read_ply(path)
    if not len(file.triangles):
        raise DamagedFileError(path, "the mesh has no faces; copy the file again")
    places = np.stack([file.vertex[axis] for axis in "xyz"], axis=1).astype(np.float64)
    if not np.isfinite(places).all():
        raise DamagedFileError(
            path, "the mesh has vertex positions that are NaN or infinite; copy the file again"
        )
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
            scene,
            f"found {held} *{LABELLED} files, expected one; give a scene of ScanNet's "
            "train or val split",
        )
    return found[0]


def _classes(path: Path, scene: Path, columns: dict[str, np.ndarray]) -> np.ndarray:
    """Return the classes as uint8 [V], from NYU40 numbers or from raw IDs with ScanNet's table."""
    if "label" not in columns:
        raise DamagedFileError(
            path,
            "the vertices have no property 'label'; use the mesh whose name ends with labels.ply",
        )
    values = np.nan_to_num(np.asarray(columns["label"], np.float64), nan=0, posinf=0, neginf=0)
    numbers = np.clip(values, 0, 65_535).astype(np.int64)
    most = int(numbers.max(initial=0))
    if most <= NYU40_NUMBERS:
        return nyu40_classes()[numbers]
    table = find_label_table([scene, scene.parent, scene.parent.parent])
    if table is None:
        raise CaptureError(
            path,
            f"labels up to {most} are raw ScanNet IDs: put {LABEL_TABLE} beside the scene "
            "to map them",
        )
    return label_id_classes()[raw_id_labels(table)[numbers]]


def _alignment(path: Path) -> np.ndarray:
    found = axis_alignment(path, read_scene_info(path))
    if found is None:
        raise CaptureError(
            path, "axisAlignment not found; scenes of the train and val splits contain it"
        )
    return found


def _groups(scene: Path, name: str, vertices: int) -> list[tuple[str, np.ndarray]]:
    """Return the name of each group, and its vertices as bool [V]."""
    segments_path, groups_path = _segments_file(scene, name), scene / f"{name}.aggregation.json"
    for path in (segments_path, groups_path):
        if not path.is_file():
            raise InputError(
                path,
                "not found; download it with download-scannet.py --type "
                f"{path.name.removeprefix(name)}",
            )
    segment = _whole_numbers(segments_path, _field(segments_path, read_json(segments_path)))
    if len(segment) != vertices:
        raise DamagedFileError(
            segments_path,
            f"segIndices has {len(segment):,} entries, but the mesh has {vertices:,} vertices",
        )
    stated = read_json(groups_path)
    rows = stated.get("segGroups") if isinstance(stated, dict) else None
    if not isinstance(rows, list) or len(rows) > MAX_OBJECTS:
        raise DamagedFileError(groups_path, "the list segGroups is missing; copy the file again")
    groups = []
    for number, row in enumerate(rows):
        held = row.get("segments") if isinstance(row, dict) else None
        if held is None:
            raise DamagedFileError(
                groups_path, f"group {number} has no segments; copy the file again"
            )
        own = np.isin(segment, _whole_numbers(groups_path, held))
        if len(held) and not own.any():
            raise DamagedFileError(
                groups_path,
                f"group {number} refers to segments that {segments_path.name} does not contain",
            )
        groups.append((str(row.get("label", "")), own))
    return groups


def _segments_file(scene: Path, name: str) -> Path:
    """Return the segments file of the labelled mesh."""
    found = sorted(scene.glob(f"{name}_vh_clean_2.*.segs.json"))
    return found[0] if found else scene / f"{name}_vh_clean_2.0.010000.segs.json"


def _field(path: Path, stated: Any) -> Any:
    if not isinstance(stated, dict) or "segIndices" not in stated:
        raise DamagedFileError(path, "the list segIndices is missing; copy the file again")
    return stated["segIndices"]


def _whole_numbers(path: Path, values: Any) -> np.ndarray:
    try:
        return np.asarray(values, np.int64).reshape(-1)
    except (ValueError, TypeError, OverflowError) as error:
        raise DamagedFileError(path, "segment IDs must be integers") from error


def _objects(
    groups: list[tuple[str, np.ndarray]], places_m: np.ndarray, classes: np.ndarray
) -> tuple[np.ndarray, tuple[LayoutObject, ...]]:
    """Return the object of each vertex as uint16 [V], and the objects without structure."""
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
