"""Metadata of ScanNet scenes: ``SCENE.txt``, label images and the table of raw label ids."""

from pathlib import Path

import numpy as np

from world2minecraft.capture.images import read_header
from world2minecraft.capture.readers.datasets.label_ids import (
    LABEL_TABLE,
    MappedLabels,
    find_label_table,
)
from world2minecraft.capture.readers.datasets.text_tables import (
    files_with_suffix,
    numbered_files,
    to_floats,
)
from world2minecraft.core.archives import AnyPath, ArchivePath, is_zip
from world2minecraft.core.errors import CaptureError, InputError
from world2minecraft.core.files import read_bytes
from world2minecraft.geometry.rotations import nearest_rigid

LABEL_KINDS = ("label-filt", "label")  # The filtered ones have fewer slips at edges.
NO_TABLE_NOTE = f"label images are ignored; put {LABEL_TABLE} (from the data set) next to the scene"


def read_scene_info(path: AnyPath) -> dict[str, np.ndarray]:
    """Return the numeric fields of a ``SCENE.txt`` by name."""
    if not path.is_file():
        return {}
    facts = {}
    for line in read_bytes(path, 1 << 20).decode("utf-8", "replace").splitlines():
        key, _, value = line.partition("=")
        try:
            facts[key.strip()] = to_floats(path, value.split())
        except CaptureError:
            continue  # Such as sceneType = Apartment.
    return facts


def axis_alignment(path: AnyPath, facts: dict[str, np.ndarray]) -> np.ndarray | None:
    """Return the transform from the world frame of the poses to one with z up.

    Returns:
        The rigid transform as float64 [4, 4], or None if it is not stated, as in test scenes.

    Raises:
        CaptureError: If the stated matrix is not a rigid transform.
    """
    if "axisAlignment" not in facts:
        return None
    values = facts["axisAlignment"]
    stated = values.reshape(4, 4) if len(values) == 16 else np.full((4, 4), np.nan)
    rotation = stated[:3, :3]
    is_turn = np.abs(rotation @ rotation.T - np.eye(3)).max() < 1e-3
    if not is_turn or np.linalg.det(rotation) < 0 or not np.isfinite(stated).all():
        raise CaptureError(path, "axisAlignment must contain 16 numbers, a 4x4 rigid transform")
    return nearest_rigid(stated)  # It is stated with six digits.


def up_vector(path: AnyPath, facts: dict[str, np.ndarray]) -> np.ndarray | None:
    """Return the stated up direction in the world frame of the poses as a unit vector, or None."""
    aligned = axis_alignment(path, facts)
    return None if aligned is None else aligned[2, :3].copy()


def stated_lens(facts: dict[str, np.ndarray], kind: str) -> tuple[float, ...] | None:
    """Return fx, fy, cx and cy of the ``color`` or ``depth`` camera, or None if not stated."""
    keys = [f"{name}_{kind}" for name in ("fx", "fy", "mx", "my")]
    if not all(len(facts.get(key, ())) == 1 for key in keys):
        return None
    return tuple(float(facts[key][0]) for key in keys)


def find_labels(scene: AnyPath, name: str) -> tuple[dict[int, MappedLabels], tuple[str, ...]]:
    """Return label images by frame number, and notes about label images that cannot be used.

    Args:
        scene: Folder of the scene.
        name: Name of the scene, such as ``scene0000_00``, which its zip archives start with.
    """
    notes: list[str] = []
    for place in [place for kind in LABEL_KINDS for place in _label_places(scene, name, kind)]:
        try:
            images = numbered_files(files_with_suffix(place, (".png",)))
        except InputError as error:  # A broken zip of labels must not stop a scan.
            broken = place.path if isinstance(place, ArchivePath) else place
            notes.append(f"ignoring {broken.name}: it {error.reason}")
            continue
        if images:
            mapped, more = _map_labels(scene, images)
            return mapped, (*notes, *more)
    return {}, tuple(dict.fromkeys(notes))


def _label_places(scene: AnyPath, name: str, kind: str) -> list[AnyPath]:
    """Return possible places of label images of a kind: a folder or the published zip archive."""
    places: list[AnyPath] = [scene / kind]
    zipped = scene / f"{name}_2d-{kind}.zip"
    if isinstance(zipped, Path) and is_zip(zipped):
        places += [ArchivePath(zipped, kind), ArchivePath(zipped)]
    return places


def _map_labels(
    scene: AnyPath, images: dict[int, AnyPath]
) -> tuple[dict[int, MappedLabels], tuple[str, ...]]:
    table = find_label_table([scene, scene.parent, scene.parent.parent])
    if table is None:
        try:
            mode = read_header(images[min(images)]).mode
        except InputError:
            return {}, (NO_TABLE_NOTE,)
        if mode not in ("L", "P"):
            return {}, (NO_TABLE_NOTE,)
    return {number: MappedLabels(path, table) for number, path in images.items()}, ()
