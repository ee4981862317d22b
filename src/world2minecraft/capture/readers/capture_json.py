"""Reader and writer of the project's own layout: ``capture.json`` with image files.

docs/reference/plain-layout.md describes the layout. ``write_plain`` writes views in it. Reading
them returns equal views, except that depth is rounded to whole units, unless it is stored as float
metres.
"""

import io
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.capture.images import SUFFIXES
from world2minecraft.capture.readers.datasets.label_ids import FACTS_FILE, label_reading
from world2minecraft.capture.source_types import Capture, FrameFiles, as_floats
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError, UnknownNameError
from world2minecraft.core.files import read_json, write_bytes, write_json
from world2minecraft.core.types import Camera, View, checks
from world2minecraft.core.vocabulary import label_id_names

FORMAT = "world2minecraft-capture"
VERSION = 1
_KIND = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,99}")
DEPTH_KINDS = ("sensor", "stereo", "network", "exact")
SCALES = ("metric", "estimated", "unknown")
MAX_NOTES, MAX_NOTE_CHARS = 30, 400  # Number of notes, and length of each.
JPEG_QUALITY = 95
_CAMERA_FIELDS = ("width_px", "height_px", "fx_px", "fy_px", "cx_px", "cy_px")


class PlainSource:
    """A reader of folders with a ``capture.json``."""

    layout = "capture.json with colour/NAME.png, depth/NAME.png (plain layout)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder contains a ``capture.json``."""
        return (folder / "capture.json").is_file()

    def read(self, folder: AnyPath) -> Capture:
        """Read the frames of a plain capture.

        Raises:
            CaptureError: If ``capture.json`` is not valid.
        """
        path = folder / "capture.json"
        stated = read_json(path)
        if not isinstance(stated, dict) or stated.get("format") != FORMAT:
            raise CaptureError(path, f'must be a JSON object with "format": "{FORMAT}"')
        if stated.get("version") != VERSION:
            raise CaptureError(path, f'"version" must be {VERSION}, got {stated.get("version")!r}')
        entries = stated.get("frames")
        if not isinstance(entries, list) or not entries:
            raise CaptureError(path, '"frames" must be a list of {"name", "camera_to_world"}')
        unit = stated.get("depth_unit")
        if unit is not None and not isinstance(unit, str):
            raise CaptureError(path, f'"depth_unit" must be a string, got {unit!r}')
        files = _files_by_stem(folder)
        posed = any(isinstance(entry, dict) and "camera_to_world" in entry for entry in entries)
        frames = tuple(_frame(path, stated, entry, files, posed) for entry in entries)
        names = [frame.name for frame in frames]
        if len(set(names)) != len(names):
            raise CaptureError(
                path, "contains two frames with the same name; every name must be unique"
            )
        return Capture(
            folder,
            _made_from(path, stated),
            frames,
            depth_unit=unit,
            one_matrix="camera" in stated,
            notes=_notes(path, stated),
            depth_kind=_one_of(path, stated, "depth_kind", DEPTH_KINDS),
            scale=_one_of(path, stated, "scale", SCALES),
            scale_sigma=_sigma(path, stated),
            skipped=_skipped(path, stated),
            world_up=_world_up(path, stated),
            room=_room(path, stated),
            source_to_scan=_source_to_scan(path, stated),
        )


def _files_by_stem(folder: AnyPath) -> dict[str, dict[str, Any]]:
    """Return the image files of each subfolder by file stem."""
    files: dict[str, dict[str, Any]] = {
        kind: {
            found.stem: found
            for found in sorted((folder / kind).glob("*"))
            if found.suffix.lower() in (*SUFFIXES, ".npy")
        }
        for kind in ("colour", "depth", "labels", "trust")
    }
    reading = label_reading(folder / "labels")
    return files | {"labels": {name: reading(path) for name, path in files["labels"].items()}}


def _frame(
    path: AnyPath,
    stated: dict[str, Any],
    entry: Any,
    files: dict[str, dict[str, Any]],
    posed: bool,
) -> FrameFiles:
    """Return a frame; if no frame is ``posed``, its intrinsics may be missing too."""
    name = _frame_name(path, entry.get("name") if isinstance(entry, dict) else None)
    colour_path, depth_path = files["colour"].get(name), files["depth"].get(name)
    pose = _matrix(path, entry, "camera_to_world")
    merged = {**stated, **entry}
    depth_to_colour = _matrix(path, merged, "depth_to_colour")
    problem = "has no camera_to_world in capture.json" if posed and pose is None else ""
    if colour_path is None and depth_path is None:
        problem = f"has neither colour/{name}.* nor depth/{name}.*"
    return FrameFiles(
        name,
        pose,
        colour_path,
        _camera(path, merged, "colour_camera", posed) if colour_path else None,
        depth_path,
        _camera(path, merged, "depth_camera", posed) if depth_path else None,
        np.eye(4) if depth_to_colour is None else depth_to_colour,
        files["labels"].get(name),
        problem,
        files["trust"].get(name) if depth_path else None,
    )


def _frame_name(path: AnyPath, name: Any) -> str:
    """Return the name of a frame, which is the stem of its files."""
    try:
        return checks.identifier("name", name if isinstance(name, str) else "")
    except ValueError as error:
        raise CaptureError(
            path, f"a frame's name must be the stem of its files, such as 000012, got {name!r}"
        ) from error


def _notes(path: AnyPath, stated: dict[str, Any]) -> tuple[str, ...]:
    notes = stated.get("notes", [])
    if not isinstance(notes, list) or not all(isinstance(note, str) for note in notes):
        raise CaptureError(path, '"notes" must be a list of strings')
    return tuple(" ".join(note.split())[:MAX_NOTE_CHARS] for note in notes[:MAX_NOTES])


def _skipped(path: AnyPath, stated: dict[str, Any]) -> tuple[tuple[str, str], ...]:
    rows = stated.get("skipped", [])
    right = isinstance(rows, list) and all(
        isinstance(row, list) and len(row) == 2 and all(isinstance(word, str) for word in row)
        for row in rows
    )
    if not right:
        raise CaptureError(path, '"skipped" must be a list of [frame, reason]')
    return tuple((row[0], row[1]) for row in rows)


def _made_from(path: AnyPath, stated: dict[str, Any]) -> str:
    """Return the kind of capture that this capture was computed from; by default ``plain``."""
    name = stated.get("made_from", "plain")
    if not isinstance(name, str) or not _KIND.fullmatch(name):
        raise CaptureError(path, f'"made_from" must be the name of a kind of capture, got {name!r}')
    return name


def _room(path: AnyPath, stated: dict[str, Any]) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the stated position and size of the room, for captures without depth."""
    room = stated.get("room")
    if room is None:
        return None
    matrix = _matrix(path, room, "scan_to_room") if isinstance(room, dict) else None
    size = room.get("size_m") if isinstance(room, dict) else None
    if matrix is None or not isinstance(size, list) or len(size) != 3:
        raise CaptureError(
            path, '"room" must contain "scan_to_room" and "size_m" with three numbers'
        )
    size_m = as_floats(size)
    if size_m.shape != (3,) or not ((size_m > 0) & (size_m < 1000)).all():
        raise CaptureError(path, f'"size_m" must contain lengths in metres above 0, got {size}')
    return matrix, size_m


def _source_to_scan(path: AnyPath, stated: dict[str, Any]) -> np.ndarray:
    matrix = _matrix(path, stated, "source_to_scan")
    if matrix is not None and not np.isfinite(matrix).all():
        raise CaptureError(path, '"source_to_scan" must be a 4x4 matrix of finite numbers')
    return np.eye(4) if matrix is None else matrix


def _world_up(path: AnyPath, stated: dict[str, Any]) -> np.ndarray | None:
    if stated.get("world_up") is None:
        return None
    up = as_floats(stated["world_up"])
    length = float(np.linalg.norm(up))
    if up.shape != (3,) or not 0.5 < length < 2:
        raise CaptureError(path, '"world_up" must be three numbers, such as [0, 1, 0]')
    return up / length


def _one_of(path: AnyPath, stated: dict[str, Any], key: str, known: tuple[str, ...]) -> Any:
    value = stated.get(key, known[0])
    if value not in known:
        raise CaptureError(path, f'"{key}" must be one of {", ".join(known)}, got {value!r}')
    return value


def _sigma(path: AnyPath, stated: dict[str, Any]) -> float:
    value = stated.get("scale_sigma", 0.0)
    if not isinstance(value, int | float) or not 0 <= value < 10:
        raise CaptureError(
            path, f'"scale_sigma" must be a relative error such as 0.1, got {value!r}'
        )
    return float(value)


def _camera(path: AnyPath, stated: dict[str, Any], key: str, needed: bool) -> Camera | None:
    value = stated.get(key, stated.get("camera"))  # "camera" stands for both.
    if value is None and not needed:
        return None  # It is found with the poses.
    if not isinstance(value, dict):
        raise CaptureError(
            path, f'must contain "{key}", an object with {", ".join(_CAMERA_FIELDS)}'
        )
    try:
        sizes = [value[field] for field in _CAMERA_FIELDS]
        for field, number in zip(_CAMERA_FIELDS, sizes, strict=True):
            if not isinstance(number, int | float):
                raise TypeError(f"{field} must be a number, got {number!r}")
        return Camera(*sizes, distortion=tuple(value.get("distortion", (0.0,) * 5)))
    except KeyError as error:
        raise CaptureError(path, f'"{key}" does not contain {error.args[0]}') from error
    except (TypeError, ValueError, OverflowError) as error:
        raise CaptureError(path, f'"{key}": {error}') from error


def _matrix(path: AnyPath, stated: dict[str, Any], key: str) -> np.ndarray | None:
    value = stated.get(key)
    if value is None:
        return None
    matrix = as_floats(value)
    if matrix.shape != (4, 4):
        raise CaptureError(path, f'"{key}" must be a 4x4 matrix')
    return matrix


def write_plain(
    folder: str | Path,
    views: Iterable[View],
    *,
    depth_unit: str = "mm",
    extra: Mapping[str, Any] | None = None,
    stated: Mapping[str, Any] | None = None,
    jpeg: bool = False,
) -> None:
    """Write views as a plain capture, one at a time. The output is deterministic.

    Args:
        folder: Output folder, created if missing. Files with the same names are replaced.
        views: Views in output order. ``camera_to_scan`` is written as ``camera_to_world``.
        depth_unit: ``"mm"`` or metres per unit such as ``"0.0002"`` (16-bit PNG, rounded), or
            ``"m"`` (float32 ``.npy``, exact).
        extra: JSON values to store under ``"extra"``, which readers ignore.
        stated: Further fields of ``capture.json``, such as ``depth_kind``, ``scale`` or ``notes``.
        jpeg: Whether to write colour as high-quality JPEG, a fifth of the size of PNG.

    Raises:
        OutputError: If the folder cannot be written.
        UnknownNameError: If the depth unit is not valid.
    """
    unit_m = _unit_m(depth_unit)
    root = Path(folder)
    more, stated = stated or {}, {"format": FORMAT, "version": VERSION, "depth_unit": depth_unit}
    stated |= more
    entries = []
    with_ids = False
    for view in views:
        _write_images(root, view, unit_m, jpeg)
        entry: dict[str, Any] = {"name": view.name, "camera_to_world": view.camera_to_scan.tolist()}
        for key, value in _shared_values(view).items():
            if stated.setdefault(key, value) != value:
                entry[key] = value
        entries.append(entry)
        with_ids |= view.label_ids is not None
    if with_ids:
        names = {str(number): name for number, name in enumerate(label_id_names()) if name}
        write_json(root / "labels" / FACTS_FILE, {"classes": names})
    stated["frames"] = entries
    if extra:
        stated["extra"] = dict(extra)
    write_json(root / "capture.json", stated)


def _shared_values(view: View) -> dict[str, Any]:
    """Return the values that most captures state once for all frames."""
    values: dict[str, Any] = {"depth_to_colour": view.depth_to_colour.tolist()}
    for key in ("colour_camera", "depth_camera"):
        camera: Camera | None = getattr(view, key)
        if camera is not None:
            values[key] = {field: getattr(camera, field) for field in _CAMERA_FIELDS}
            values[key]["distortion"] = list(camera.distortion)
    return values


def _unit_m(depth_unit: str) -> float | None:
    """Return metres per unit of a 16-bit image, or None for float metres."""
    if depth_unit in ("mm", "m"):
        return 0.001 if depth_unit == "mm" else None
    try:
        unit_m = float(depth_unit)
    except ValueError:
        unit_m = 0.0
    if not 0 < unit_m < 1:
        raise UnknownNameError("depth unit", depth_unit, ("mm", "m", "METRES_PER_UNIT"))
    return unit_m


def _write_images(root: Path, view: View, unit_m: float | None, jpeg: bool) -> None:
    if view.colour is not None and jpeg:
        _write_jpeg(root / "colour" / f"{view.name}.jpg", view.colour)
    elif view.colour is not None:
        _write_png(root / "colour" / f"{view.name}.png", view.colour)
    if view.label_ids is not None:
        _write_png(root / "labels" / f"{view.name}.png", view.label_ids)
    elif view.labels is not None:
        _write_png(root / "labels" / f"{view.name}.png", view.labels)
    if view.trust is not None:
        _write_png(root / "trust" / f"{view.name}.png", view.trust)
    if view.depth_m is None:
        return
    if unit_m is not None:
        steps = np.round(view.depth_m.astype(np.float64) / unit_m)
        steps[steps > 65534] = 0  # Beyond what 16 bits hold it is a hole.
        _write_png(root / "depth" / f"{view.name}.png", steps.astype(np.uint16))
    else:
        buffer = io.BytesIO()
        np.save(buffer, np.ascontiguousarray(view.depth_m))
        write_bytes(root / "depth" / f"{view.name}.npy", buffer.getvalue())


def _write_png(path: Path, pixels: np.ndarray) -> None:
    buffer = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(pixels)).save(buffer, "PNG", compress_level=3)
    write_bytes(path, buffer.getvalue())


def _write_jpeg(path: Path, pixels: np.ndarray) -> None:
    buffer = io.BytesIO()
    image = Image.fromarray(np.ascontiguousarray(pixels))
    image.save(buffer, "JPEG", quality=JPEG_QUALITY, subsampling=0)
    write_bytes(path, buffer.getvalue())
