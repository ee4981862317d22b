"""Reader of PLY files in ASCII and binary form, as meshes or point clouds.

A file with faces is read as a mesh, other files as point clouds. Sizes are checked against the
header before memory is allocated. Vertex properties are looked up by name, including class labels.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import NoReturn

import numpy as np
from PIL import Image

from world2minecraft.capture.readers.meshes.colours_and_classes import (
    classes_of_label_ids,
    colours_of_columns,
)
from world2minecraft.capture.readers.meshes.mesh_and_cloud import (
    MAX_FACES,
    MAX_POINTS,
    MAX_VERTICES,
    LoadedGeometry,
)
from world2minecraft.capture.readers.meshes.mesh_assembly import MeshPart, join_parts, open_texture
from world2minecraft.capture.readers.meshes.text_clouds import parse_numbers
from world2minecraft.capture.readers.meshes.voxel_downsampling import VoxelDownsampler
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError
from world2minecraft.core.files import read_bytes
from world2minecraft.core.jit import njit

MAX_CORNERS = 1 << 16  # Of one polygon.
MAX_BYTES = 4 << 30
MAX_HEADER = 1 << 16
TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "float": "f4",
    "double": "f8",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "float32": "f4",
    "float64": "f8",
}
FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
Table = tuple[dict[str, np.ndarray], tuple[np.ndarray, np.ndarray]]
INDICES = ("vertex_indices", "vertex_index")
NO_LISTS = (np.zeros(0, np.int64), np.zeros(0, np.int64))
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


@njit
def locate_binary_lists(raw, rows, steps, big):
    """Find the byte offset of each property value in a sequence of rows with lists.

    Args:
        raw: The data, uint8 [B].
        rows: Number of rows.
        steps: Byte widths of each property, int64 [P, 2]: of the list count (0 for a single value)
            and of one value.
        big: Whether list counts are big-endian.

    Returns:
        The offsets and lengths as int64 [rows, P], and the number of bytes used, or -1 if the data
        is truncated.
    """
    starts = np.zeros((rows, len(steps)), np.int64)
    counts = np.ones((rows, len(steps)), np.int64)
    offset = 0
    for row in range(rows):
        for p in range(len(steps)):
            head = steps[p, 0]
            if offset + head > len(raw):
                return starts, counts, -1
            if head > 0:
                count = 0
                for b in range(head):
                    byte = raw[offset + b] if big else raw[offset + head - 1 - b]
                    count = count * 256 + byte
                if count > MAX_CORNERS:
                    return starts, counts, -1
                counts[row, p] = count
                offset += head
            starts[row, p] = offset
            offset += counts[row, p] * steps[p, 1]
            if offset > len(raw):
                return starts, counts, -1
    return starts, counts, offset


@njit
def locate_text_lists(numbers, rows, listed):
    """Find the index of each property value among the numbers of an ASCII file.

    Args:
        numbers: All numbers of the file, float64 [N].
        rows: Number of rows.
        listed: Whether each property is a list, bool [P].

    Returns:
        The indices and lengths as int64 [rows, P], and the count of numbers used, or -1 if the data
        is truncated.
    """
    starts = np.zeros((rows, len(listed)), np.int64)
    counts = np.ones((rows, len(listed)), np.int64)
    offset = 0
    for row in range(rows):
        for p in range(len(listed)):
            if offset >= len(numbers):
                return starts, counts, -1
            if listed[p]:
                if not 0 <= numbers[offset] <= MAX_CORNERS:
                    return starts, counts, -1
                counts[row, p] = int(numbers[offset])
                offset += 1
            starts[row, p] = offset
            offset += counts[row, p]
            if offset > len(numbers):
                return starts, counts, -1
    return starts, counts, offset


@njit
def gather_bytes(raw, starts, counts, width):
    """Concatenate the bytes of value runs: ``counts[i]`` values from byte ``starts[i]`` on."""
    result = np.empty(counts.sum() * width, np.uint8)
    offset = 0
    for row in range(len(starts)):
        for b in range(counts[row] * width):
            result[offset] = raw[starts[row] + b]
            offset += 1
    return result


def triangulate_fans(counts: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Divide polygons into triangles that share the first corner of the polygon.

    Args:
        counts: Number of corners of each polygon, int64 [N].
        values: Vertex indices of all polygons, one polygon after the other, int64.

    Returns:
        The triangles as int64 [T, 3], and the polygon index of each triangle as int64 [T].
    """
    if len(counts) and (counts == 3).all():
        return values.reshape(-1, 3), np.arange(len(counts))
    return _fans(counts, values, int(np.maximum(counts - 2, 0).sum()))


@njit
def _fans(counts, values, total):
    triangles, owner = np.empty((total, 3), np.int64), np.empty(total, np.int64)
    offset, made = 0, 0
    for n in range(len(counts)):
        for k in range(counts[n] - 2):
            triangles[made, 0] = values[offset]
            triangles[made, 1] = values[offset + k + 1]
            triangles[made, 2] = values[offset + k + 2]
            owner[made] = n
            made += 1
        offset += counts[n]
    return triangles, owner


@dataclass(frozen=True)
class Property:
    """A property of a PLY element.

    Attributes:
        name: Name of the property.
        kind: numpy type of its values.
        count_kind: numpy type of its list count, or an empty string for a single value.
    """

    name: str
    kind: str
    count_kind: str = ""


@dataclass(frozen=True)
class Element:
    """An element of a PLY file: a table of ``count`` rows with the same properties."""

    name: str
    count: int
    properties: tuple[Property, ...]

    @property
    def has_lists(self) -> bool:
        """Whether any property is a list."""
        return any(p.count_kind for p in self.properties)

    @property
    def least_bytes(self) -> int:
        """The size in bytes of a binary row in which all lists are empty."""
        return sum(np.dtype(p.count_kind or p.kind).itemsize for p in self.properties)


@dataclass(frozen=True, eq=False)
class PlyFile:
    """The content of a PLY file.

    Attributes:
        vertex: Columns of the vertex element by property name.
        triangles: Vertex indices of the triangles, int64 [T, 3].
        triangle_face: Index of the face that each triangle is part of, int64 [T].
        face: Columns of the face element by property name, without lists.
        comments: Comments in the header.
    """

    vertex: dict[str, np.ndarray]
    triangles: np.ndarray
    triangle_face: np.ndarray
    face: dict[str, np.ndarray] = field(default_factory=dict)
    comments: tuple[str, ...] = ()


def read_ply(path: AnyPath) -> PlyFile:
    """Read the vertices and faces of a PLY file.

    Raises:
        DamagedFileError: If the file does not match its header.
        LimitError: If the file has too many vertices or faces.
    """
    data = memoryview(read_bytes(path, MAX_BYTES))
    order, elements, comments, start = _header(path, bytes(data[:MAX_HEADER]))
    counts = {element.name: element.count for element in elements}
    most_vertices = MAX_VERTICES if counts.get("face") else MAX_POINTS
    for name, most in (("vertex", most_vertices), ("face", MAX_FACES)):
        if counts.get(name, 0) > most:
            raise LimitError(
                path,
                f"contains {counts[name]:,} {name} rows, the limit is {most:,}; simplify the file",
            )
    reader = _Ascii(path, data[start:]) if order == "" else _Binary(path, data[start:], order)
    vertex: dict[str, np.ndarray] = {}
    face: dict[str, np.ndarray] = {}
    lists = (np.zeros(0, np.int64), np.zeros(0, np.int64))
    for element in elements:
        if element.name == "vertex":
            vertex, _ = reader.read(element)
        elif element.name == "face":
            face, lists = reader.read(element)
            break  # What follows is of no use here.
        else:
            reader.read(element)
    if not {"x", "y", "z"} <= set(vertex):
        raise DamagedFileError(
            path,
            "contains no vertices with x, y and z properties; export the file without compression",
        )
    triangles, owner = triangulate_fans(*lists)
    held = len(vertex["x"])
    if len(triangles) and not (triangles.min() >= 0 and triangles.max() < held):
        raise DamagedFileError(
            path,
            f"contains faces that refer to missing vertices; only {held:,} exist; "
            "export the file again",
        )
    return PlyFile(vertex, triangles, owner, face, comments)


def _header(path: AnyPath, data: bytes) -> tuple[str, list[Element], tuple[str, ...], int]:
    """Return the byte order, elements, comments and start of the data."""
    end = re.search(rb"\nend_header[ \t]*\r?\n", data)
    if not data.startswith(b"ply") or end is None:
        raise DamagedFileError(
            path,
            "is not a PLY file (no ply ... end_header block at its start); copy the file again",
        )
    lines = data[: end.start()].decode("latin-1").splitlines()
    order, comments = None, []
    tables: list[tuple[str, int, list[Property]]] = []
    for line in lines[1:]:
        words = line.split()
        if not words:
            continue
        if words[0] == "format" and len(words) >= 2:
            order = FORMATS.get(words[1])
        elif words[0] == "comment":
            comments.append(line[len("comment ") :].strip())
        elif words[0] == "element" and len(words) == 3 and re.fullmatch(r"\d{1,12}", words[2]):
            tables.append((words[1], int(words[2]), []))
        elif words[0] == "property" and tables:
            tables[-1][2].append(_with_unique_name(_property(path, words), tables[-1][2]))
        elif words[0] != "obj_info":
            raise DamagedFileError(
                path, f"contains an unknown header line: {line[:60]!r}; copy the file again"
            )
    if order is None:
        raise DamagedFileError(
            path, f"contains no supported format line; supported formats: {', '.join(FORMATS)}"
        )
    elements = [Element(name, count, tuple(own)) for name, count, own in tables]
    return order, elements, tuple(comments), end.end()


def _property(path: AnyPath, words: list[str]) -> Property:
    kinds = [TYPES.get(word) for word in words[1:-1]]
    if len(words) == 3 and kinds[0]:
        return Property(words[2], kinds[0])
    if len(words) == 5 and words[1] == "list" and kinds[1] and kinds[2] and kinds[1][0] != "f":
        return Property(words[4], kinds[2], kinds[1])
    raise DamagedFileError(
        path, f"contains an unsupported property: {' '.join(words)[:60]!r}; export the file again"
    )


def _with_unique_name(new: Property, others: list[Property]) -> Property:
    """Return a property with a unique name; some tools write two properties with one name."""
    names = {other.name for other in others}
    name, count = new.name, 1
    while name in names:
        count += 1
        name = f"{new.name}.{count}"
    return replace(new, name=name)


class _Binary:
    """A reader of binary elements, one after the other; ``data`` is the unread remainder."""

    def __init__(self, path: AnyPath, data: memoryview, order: str):
        self.path, self.data, self.order = path, data, order

    def read(self, element: Element) -> Table:
        """Return the columns of single values, and the counts and values of the index list."""
        if not element.count or not element.properties:
            return {}, NO_LISTS
        if element.least_bytes * element.count > len(self.data):
            self._refuse(element)
        lengths = self._first_lengths(element)
        kind = self._row_kind(element, lengths)
        if kind.itemsize * element.count <= len(self.data):
            rows = np.frombuffer(self.data, kind, element.count)
            own = [p for p in element.properties if p.count_kind]
            if all((rows[f"{p.name} count"] == lengths[p.name]).all() for p in own):
                self.data = self.data[kind.itemsize * element.count :]
                return self._columns(element, rows, lengths)
        if not element.has_lists:
            self._refuse(element)
        return self._walked(element)

    def _first_lengths(self, element: Element) -> dict[str, int]:
        """Return the list lengths of the first row; often all rows have the same lengths."""
        lengths: dict[str, int] = {}
        for own in element.properties:
            if own.count_kind:
                before = self._row_kind(element, lengths, own.name).itemsize
                width = np.dtype(own.count_kind).itemsize
                if before + width > len(self.data):
                    self._refuse(element)
                kind = self.order + own.count_kind
                lengths[own.name] = int(np.frombuffer(self.data[before:], kind, 1)[0])
                if not 0 <= lengths[own.name] <= MAX_CORNERS:
                    self._refuse(element)
        return lengths

    def _row_kind(self, element: Element, lengths: dict[str, int], until: str = "") -> np.dtype:
        """Return the numpy type of a row with the given list lengths, up to a property."""
        parts: list[tuple] = []
        for own in element.properties:
            if own.name == until:
                break
            if own.count_kind:
                parts.append((f"{own.name} count", self.order + own.count_kind))
                parts.append((own.name, self.order + own.kind, (lengths[own.name],)))
            else:
                parts.append((own.name, self.order + own.kind))
        return np.dtype(parts)

    def _columns(self, element: Element, rows: np.ndarray, lengths: dict[str, int]) -> Table:
        columns = {p.name: rows[p.name] for p in element.properties if not p.count_kind}
        for own in element.properties:
            if own.count_kind and own.name in INDICES:
                counts = np.full(len(rows), lengths[own.name], np.int64)
                return columns, (counts, rows[own.name].astype(np.int64).reshape(-1))
        return columns, NO_LISTS

    def _walked(self, element: Element) -> Table:
        """Read rows whose lists have different lengths."""
        raw = np.frombuffer(self.data, np.uint8)
        steps = [
            (np.dtype(p.count_kind).itemsize if p.count_kind else 0, np.dtype(p.kind).itemsize)
            for p in element.properties
        ]
        big = self.order == ">"
        starts, counts, used = locate_binary_lists(
            raw, element.count, np.array(steps, np.int64), big
        )
        if used < 0:
            self._refuse(element)
        self.data = self.data[used:]
        columns, lists = {}, NO_LISTS
        for index, own in enumerate(element.properties):
            if not own.count_kind or own.name in INDICES:
                width = np.dtype(own.kind).itemsize
                chosen = gather_bytes(raw, starts[:, index], counts[:, index], width)
                values = chosen.view(self.order + own.kind)
                if own.count_kind:
                    lists = (counts[:, index].copy(), values.astype(np.int64))
                else:
                    columns[own.name] = values
        return columns, lists

    def _refuse(self, element: Element) -> NoReturn:
        raise DamagedFileError(
            self.path,
            f"is truncated or damaged: expected {element.count:,} {element.name} rows, found "
            f"only {len(self.data):,} bytes; copy the file again",
        )


class _Ascii:
    """A reader of ASCII elements, which parses all numbers of the file at once."""

    def __init__(self, path: AnyPath, data: memoryview):
        self.path = path
        self.data = parse_numbers(path, bytes(data))

    def read(self, element: Element) -> Table:
        """Return the columns of single values, and the counts and values of the index list."""
        width = len(element.properties)
        if width * element.count > len(self.data):
            self._refuse(element)
        if not element.has_lists:
            rows = self.data[: width * element.count].reshape(element.count, width)
            self.data = self.data[width * element.count :]
            return {p.name: rows[:, i] for i, p in enumerate(element.properties)}, NO_LISTS
        listed = np.array([bool(p.count_kind) for p in element.properties])
        starts, counts, used = locate_text_lists(self.data, element.count, listed)
        if used < 0:
            self._refuse(element)
        columns, lists = {}, NO_LISTS
        for index, own in enumerate(element.properties):
            if not own.count_kind or own.name in INDICES:
                raw = np.ascontiguousarray(self.data).view(np.uint8)
                chosen = gather_bytes(raw, starts[:, index] * 8, counts[:, index], 8).view(
                    np.float64
                )
                if own.count_kind:
                    lists = (counts[:, index].copy(), chosen.astype(np.int64))
                else:
                    columns[own.name] = chosen
        self.data = self.data[used:]
        return columns, lists

    def _refuse(self, element: Element) -> NoReturn:
        raise DamagedFileError(
            self.path,
            f"is truncated or damaged: expected {element.count:,} {element.name} rows, found "
            f"only {len(self.data):,} numbers; copy the file again",
        )


def load_ply(path: AnyPath) -> LoadedGeometry:
    """Load a PLY file as a mesh or point cloud.

    A second file of the same mesh with ScanNet's ``.labels`` suffix is read too, if it exists.

    Raises:
        DamagedFileError: If the file does not match its header.
        LimitError: If the file has too many vertices or faces.
    """
    file = read_ply(path)
    twin = _labels_twin(path, file)
    if len(file.triangles):
        return _load_mesh(path, file, twin)
    return _load_cloud(path, file, twin)


def _labels_twin(path: AnyPath, file: PlyFile) -> PlyFile | None:
    """Return ScanNet's second file of the same mesh, which has the labels or the colours."""
    stem = path.stem
    name = stem.removesuffix(".labels") if stem.endswith(".labels") else f"{stem}.labels"
    other = path.parent / f"{name}.ply"
    if not other.is_file():
        return None
    found = read_ply(other)
    return found if len(found.vertex["x"]) == len(file.vertex["x"]) else None


def _labels(path: AnyPath, columns: Mapping[str, np.ndarray]) -> tuple[np.ndarray | None, str]:
    """Return the class ids of the label column and a note, or None without a label column."""
    by_name = {name.lower(): values for name, values in columns.items()}
    for name in LABEL_NAMES:
        if name in by_name:
            return classes_of_label_ids(path, name, by_name[name])
    return None, ""


def _vertex_positions(file: PlyFile) -> np.ndarray:
    return np.stack([file.vertex[axis] for axis in "xyz"], axis=1).astype(np.float64)


def _vertex_attributes(
    path: AnyPath, file: PlyFile, twin: PlyFile | None
) -> tuple[np.ndarray | None, np.ndarray | None, str]:
    """Return the colours and labels of the vertices, and a note."""
    labels, note = _labels(path, file.vertex)
    colour = colours_of_columns(file.vertex)
    if twin is not None:
        own_colours = path.stem.endswith(".labels")
        colour = colours_of_columns(twin.vertex) if own_colours else colour
        if labels is None:
            labels, note = _labels(path, twin.vertex)
    elif path.stem.endswith(".labels"):
        colour = None  # Those of the classes, which are nothing's own.
    return colour, labels, note


def _load_mesh(path: AnyPath, file: PlyFile, twin: PlyFile | None) -> LoadedGeometry:
    colour, labels, note = _vertex_attributes(path, file, twin)
    face_labels = None
    if labels is not None:
        face_labels = _majority_label(labels[file.triangles])
    else:
        own, more = _labels(path, file.face)
        note = note or more
        face_labels = None if own is None else own[file.triangle_face]
    vertices, triangles = _vertex_positions(file), file.triangles
    if colour is None and (face_colour := colours_of_columns(file.face)) is not None:
        vertices = vertices[triangles.reshape(-1)]
        colour = np.repeat(face_colour[file.triangle_face], 3, axis=0)
        triangles = np.arange(3 * len(triangles)).reshape(-1, 3)
    picture, uv = _picture(path, file)
    label = 255 if face_labels is None else face_labels
    mesh, offset = join_parts(
        path, [MeshPart(vertices, triangles, colour, picture, uv, label=label)]
    )
    return LoadedGeometry(mesh, "PLY", offset, notes=(note,) if note else ())


def _majority_label(corners: np.ndarray) -> np.ndarray:
    """Return the label shared by two corners of a triangle, or else that of the first corner."""
    first, second, third = corners.T
    return np.where(second == third, second, first).astype(np.uint8)


def _picture(path: AnyPath, file: PlyFile) -> tuple[Image.Image | None, np.ndarray | None]:
    """Return the texture image named in a comment, and the texture coordinates of the vertices."""
    names = [c.split(None, 1)[1] for c in file.comments if c.lower().startswith("texturefile ")]
    axes = next((pair for pair in PICTURE_AXES if set(pair) <= set(file.vertex)), None)
    if not names or axes is None:
        return None, None
    found = path.parent / names[0].strip().replace("\\", "/").rpartition("/")[2]
    try:
        data = read_bytes(found, 1 << 30)
    except InputError:
        return None, None
    u, v = (file.vertex[axis].astype(np.float64) for axis in axes)
    return open_texture(path, data), np.stack([u, 1 - v], axis=1)


def _load_cloud(path: AnyPath, file: PlyFile, twin: PlyFile | None) -> LoadedGeometry:
    colour, labels, note = _vertex_attributes(path, file, twin)
    thinner = VoxelDownsampler()
    count = len(file.vertex["x"])
    opaque = np.ones(count, bool)
    if "opacity" in file.vertex and "f_dc_0" in file.vertex:  # Gaussian splats: the firm ones.
        opaque = np.asarray(file.vertex["opacity"]) > 0
    for start in range(0, count, CHUNK):
        rows = np.flatnonzero(opaque[start : start + CHUNK]) + start
        points = np.stack([file.vertex[axis][rows] for axis in "xyz"], axis=1).astype(np.float64)
        thinner.add(
            points,
            None if colour is None else colour[rows],
            None if labels is None else labels[rows],
        )
    if count and thinner.offset is None:
        raise DamagedFileError(
            path,
            "contains no point with finite coordinates (NaN or infinite values); "
            "export the file again",
        )
    offset = np.zeros(3) if thinner.offset is None else thinner.offset
    notes = (note,) if note else ()
    return LoadedGeometry(thinner.cloud(), "PLY", offset, notes=notes, read=thinner.read)
