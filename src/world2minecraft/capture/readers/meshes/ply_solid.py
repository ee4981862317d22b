"""A PLY file as a solid: its colours, its pictures and its labels."""

import io
from collections.abc import Mapping

import numpy as np
from PIL import Image, UnidentifiedImageError

from world2minecraft.capture.readers.meshes.mesh_assembly import Part, joined
from world2minecraft.capture.readers.meshes.numbering import classes_of_numbers
from world2minecraft.capture.readers.meshes.ply import PlyFile, read_ply
from world2minecraft.capture.readers.meshes.surface_model import Loaded
from world2minecraft.capture.readers.meshes.thinning import Thinner
from world2minecraft.capture.readers.meshes.tinting import colour_of
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.files import read_bytes

LABEL_NAMES = (
    "label",
    "class",
    "class_id",
    "semantic",
    "semantic_label",
    "segment",
    "category",
    "scalar_label",
    "scalar_class",
    "scalar_classification",
    "scalar_scalar_label",
)
PICTURE_AXES = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"))
CHUNK = 1 << 20


def load_ply(place: AnyPath) -> Loaded:
    """Read a mesh or a cloud. Raises what ``read_ply`` raises."""
    file = read_ply(place)
    twin = _twin(place, file)
    if len(file.triangles):
        return _mesh(place, file, twin)
    return _cloud(place, file, twin)


def _twin(place: AnyPath, file: PlyFile) -> PlyFile | None:
    """Return ScanNet's other file of the same mesh: the labels of colours, or the other way."""
    stem = place.stem
    name = stem.removesuffix(".labels") if stem.endswith(".labels") else f"{stem}.labels"
    other = place.parent / f"{name}.ply"
    if not other.is_file():
        return None
    found = read_ply(other)
    return found if len(found.vertex["x"]) == len(file.vertex["x"]) else None


def _labels(place: AnyPath, columns: Mapping[str, np.ndarray]) -> tuple[np.ndarray | None, str]:
    """Return uint8 classes of the column that holds labels, and what to tell; None for none."""
    by_name = {name.lower(): values for name, values in columns.items()}
    for name in LABEL_NAMES:
        if name in by_name:
            return classes_of_numbers(place, name, by_name[name])
    return None, ""


def _places(file: PlyFile) -> np.ndarray:
    return np.stack([file.vertex[axis] for axis in "xyz"], axis=1).astype(np.float64)


def _looks(
    place: AnyPath, file: PlyFile, twin: PlyFile | None
) -> tuple[np.ndarray | None, np.ndarray | None, str]:
    """Return colours and labels of the vertices, and what to tell."""
    labels, told = _labels(place, file.vertex)
    colour = colour_of(file.vertex)
    if twin is not None:
        own_colours = place.stem.endswith(".labels")
        colour = colour_of(twin.vertex) if own_colours else colour
        if labels is None:
            labels, told = _labels(place, twin.vertex)
    elif place.stem.endswith(".labels"):
        colour = None  # Those of the classes, which are nothing's own.
    return colour, labels, told


def _mesh(place: AnyPath, file: PlyFile, twin: PlyFile | None) -> Loaded:
    colour, labels, told = _looks(place, file, twin)
    face_labels = None
    if labels is not None:
        face_labels = _voted(labels[file.triangles])
    else:
        own, more = _labels(place, file.face)
        told = told or more
        face_labels = None if own is None else own[file.triangle_face]
    vertices, triangles = _places(file), file.triangles
    if colour is None and (face_colour := colour_of(file.face)) is not None:
        vertices = vertices[triangles.reshape(-1)]
        colour = np.repeat(face_colour[file.triangle_face], 3, axis=0)
        triangles = np.arange(3 * len(triangles)).reshape(-1, 3)
    picture, uv = _picture(place, file)
    label = 255 if face_labels is None else face_labels
    mesh, offset = joined(place, [Part(vertices, triangles, colour, picture, uv, label=label)])
    return Loaded(mesh, "PLY", offset, notes=(told,) if told else ())


def _voted(corners: np.ndarray) -> np.ndarray:
    """Return the label that two corners of a triangle share, else the first one's."""
    first, second, third = corners.T
    return np.where(second == third, second, first).astype(np.uint8)


def _picture(place: AnyPath, file: PlyFile) -> tuple[Image.Image | None, np.ndarray | None]:
    """Return the picture that a comment names, and where on it each vertex lies."""
    names = [c.split(None, 1)[1] for c in file.comments if c.lower().startswith("texturefile ")]
    axes = next((pair for pair in PICTURE_AXES if set(pair) <= set(file.vertex)), None)
    if not names or axes is None:
        return None, None
    found = place.parent / names[0].strip().replace("\\", "/").rpartition("/")[2]
    try:
        picture = Image.open(io.BytesIO(read_bytes(found, 1 << 30)))
    except (InputError, UnidentifiedImageError, OSError):
        return None, None
    u, v = (file.vertex[axis].astype(np.float64) for axis in axes)
    return picture, np.stack([u, 1 - v], axis=1)


def _cloud(place: AnyPath, file: PlyFile, twin: PlyFile | None) -> Loaded:
    colour, labels, told = _looks(place, file, twin)
    thinner = Thinner()
    count = len(file.vertex["x"])
    solid = np.ones(count, bool)
    if "opacity" in file.vertex and "f_dc_0" in file.vertex:  # Gaussian splats: the firm ones.
        solid = np.asarray(file.vertex["opacity"]) > 0
    for start in range(0, count, CHUNK):
        rows = np.flatnonzero(solid[start : start + CHUNK]) + start
        points = np.stack([file.vertex[axis][rows] for axis in "xyz"], axis=1).astype(np.float64)
        thinner.add(
            points,
            None if colour is None else colour[rows],
            None if labels is None else labels[rows],
        )
    if count and thinner.offset is None:
        raise DamagedFileError(
            place, "has places that are no numbers (NaN, infinity): export it again"
        )
    offset = np.zeros(3) if thinner.offset is None else thinner.offset
    notes = (told,) if told else ()
    return Loaded(thinner.cloud(), "PLY", offset, notes=notes, read=thinner.read)
