"""PLY files: a mesh where they have faces, else a cloud. ASCII and binary, of either byte order.

All is held against the header before memory is taken. Properties beside place and colour are kept
by name, so that labels can be told from them.
"""

import re
from dataclasses import dataclass, field, replace
from typing import NoReturn

import numpy as np

from world2minecraft.capture.readers.meshes.lists import (
    MOST_CORNERS,
    fans,
    gathered,
    walk_lists,
    walk_numbers,
)
from world2minecraft.capture.readers.meshes.numbers import parse_numbers
from world2minecraft.capture.readers.meshes.surface_model import MAX_FACES, MAX_POINTS, MAX_VERTICES
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import DamagedFileError, LimitError
from world2minecraft.core.files import read_bytes

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


@dataclass(frozen=True)
class Property:
    """A property: numpy's name of its type, and that of its count where it is a list."""

    name: str
    kind: str
    count_kind: str = ""


@dataclass(frozen=True)
class Element:
    """A table of the file: ``count`` rows of properties."""

    name: str
    count: int
    properties: tuple[Property, ...]

    @property
    def has_lists(self) -> bool:
        """Whether any property is a list."""
        return any(p.count_kind for p in self.properties)

    @property
    def least_bytes(self) -> int:
        """The bytes of a binary row whose lists are all empty."""
        return sum(np.dtype(p.count_kind or p.kind).itemsize for p in self.properties)


@dataclass(frozen=True, eq=False)
class PlyFile:
    """What a file holds.

    ``vertex`` and ``face`` are columns of single values by name; ``triangles`` int64 [T, 3] are
    cut from the faces that ``triangle_face`` int64 [T] names; ``comments`` are the header's.
    """

    vertex: dict[str, np.ndarray]
    triangles: np.ndarray
    triangle_face: np.ndarray
    face: dict[str, np.ndarray] = field(default_factory=dict)
    comments: tuple[str, ...] = ()


def read_ply(place: AnyPath) -> PlyFile:
    """Read a file whole.

    Raises:
        DamagedFileError: it is not what its header says. LimitError: it is too large.
    """
    data = memoryview(read_bytes(place, MAX_BYTES))
    order, elements, comments, start = _header(place, bytes(data[:MAX_HEADER]))
    counts = {element.name: element.count for element in elements}
    most_vertices = MAX_VERTICES if counts.get("face") else MAX_POINTS
    for name, most in (("vertex", most_vertices), ("face", MAX_FACES)):
        if counts.get(name, 0) > most:
            raise LimitError(
                place, f"has {counts[name]:,} {name} rows; at most {most:,} are read: thin it"
            )
    reader = _Ascii(place, data[start:]) if order == "" else _Binary(place, data[start:], order)
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
        raise DamagedFileError(place, "has no vertices with x, y and z: export it uncompressed")
    triangles, owner = fans(*lists)
    held = len(vertex["x"])
    if len(triangles) and not (triangles.min() >= 0 and triangles.max() < held):
        raise DamagedFileError(
            place, f"has faces of vertices that it lacks; it holds {held:,}: export it again"
        )
    return PlyFile(vertex, triangles, owner, face, comments)


def _header(place: AnyPath, data: bytes) -> tuple[str, list[Element], tuple[str, ...], int]:
    """Return byte order, elements, comments and where the data begin."""
    end = re.search(rb"\nend_header[ \t]*\r?\n", data)
    if not data.startswith(b"ply") or end is None:
        raise DamagedFileError(
            place, "is no PLY file (no ply ... end_header at its start): copy it again"
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
            tables[-1][2].append(_named_apart(_property(place, words), tables[-1][2]))
        elif words[0] != "obj_info":
            raise DamagedFileError(
                place, f"has a header line that is not read: {line[:60]!r}; copy it again"
            )
    if order is None:
        raise DamagedFileError(place, f"has no format line; known are {', '.join(FORMATS)}")
    elements = [Element(name, count, tuple(own)) for name, count, own in tables]
    return order, elements, tuple(comments), end.end()


def _property(place: AnyPath, words: list[str]) -> Property:
    kinds = [TYPES.get(word) for word in words[1:-1]]
    if len(words) == 3 and kinds[0]:
        return Property(words[2], kinds[0])
    if len(words) == 5 and words[1] == "list" and kinds[1] and kinds[2] and kinds[1][0] != "f":
        return Property(words[4], kinds[2], kinds[1])
    raise DamagedFileError(
        place, f"has a property that is not read: {' '.join(words)[:60]!r}; export it again"
    )


def _named_apart(new: Property, others: list[Property]) -> Property:
    """Return a property under a name of its own: some tools write two scalar fields of one name."""
    names = {other.name for other in others}
    name, count = new.name, 1
    while name in names:
        count += 1
        name = f"{new.name}.{count}"
    return replace(new, name=name)


Table = tuple[dict[str, np.ndarray], tuple[np.ndarray, np.ndarray]]
INDICES = ("vertex_indices", "vertex_index")


NO_LISTS = (np.zeros(0, np.int64), np.zeros(0, np.int64))


class _Binary:
    """Reads one table after the other; ``data`` is what is left."""

    def __init__(self, place: AnyPath, data: memoryview, order: str):
        self.place, self.data, self.order = place, data, order

    def read(self, element: Element) -> Table:
        """Return the columns of single values, and the counts and the values of the index list."""
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
        """Return the lengths of the first row's lists; all rows may have the same."""
        lengths: dict[str, int] = {}
        for own in element.properties:
            if own.count_kind:
                before = self._row_kind(element, lengths, own.name).itemsize
                width = np.dtype(own.count_kind).itemsize
                if before + width > len(self.data):
                    self._refuse(element)
                kind = self.order + own.count_kind
                lengths[own.name] = int(np.frombuffer(self.data[before:], kind, 1)[0])
                if not 0 <= lengths[own.name] <= MOST_CORNERS:
                    self._refuse(element)
        return lengths

    def _row_kind(self, element: Element, lengths: dict[str, int], until: str = "") -> np.dtype:
        """Return the type of a row whose lists have some lengths, up to a property."""
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
        """Read rows whose lists differ in length."""
        raw = np.frombuffer(self.data, np.uint8)
        steps = [
            (np.dtype(p.count_kind).itemsize if p.count_kind else 0, np.dtype(p.kind).itemsize)
            for p in element.properties
        ]
        big = self.order == ">"
        starts, counts, used = walk_lists(raw, element.count, np.array(steps, np.int64), big)
        if used < 0:
            self._refuse(element)
        self.data = self.data[used:]
        columns, lists = {}, NO_LISTS
        for index, own in enumerate(element.properties):
            if not own.count_kind or own.name in INDICES:
                width = np.dtype(own.kind).itemsize
                chosen = gathered(raw, starts[:, index], counts[:, index], width)
                values = chosen.view(self.order + own.kind)
                if own.count_kind:
                    lists = (counts[:, index].copy(), values.astype(np.int64))
                else:
                    columns[own.name] = values
        return columns, lists

    def _refuse(self, element: Element) -> NoReturn:
        raise DamagedFileError(
            self.place,
            f"is cut short or wrong: {element.count:,} {element.name} rows are due and "
            f"{len(self.data):,} bytes are there: copy it again",
        )


class _Ascii:
    """The same for text: all numbers are read at once."""

    def __init__(self, place: AnyPath, data: memoryview):
        self.place = place
        self.data = parse_numbers(place, bytes(data))

    def read(self, element: Element) -> Table:
        """Return the columns of single values, and the counts and the values of the index list."""
        width = len(element.properties)
        if width * element.count > len(self.data):
            self._refuse(element)
        if not element.has_lists:
            rows = self.data[: width * element.count].reshape(element.count, width)
            self.data = self.data[width * element.count :]
            return {p.name: rows[:, i] for i, p in enumerate(element.properties)}, NO_LISTS
        listed = np.array([bool(p.count_kind) for p in element.properties])
        starts, counts, used = walk_numbers(self.data, element.count, listed)
        if used < 0:
            self._refuse(element)
        columns, lists = {}, NO_LISTS
        for index, own in enumerate(element.properties):
            if not own.count_kind or own.name in INDICES:
                raw = np.ascontiguousarray(self.data).view(np.uint8)
                chosen = gathered(raw, starts[:, index] * 8, counts[:, index], 8).view(np.float64)
                if own.count_kind:
                    lists = (counts[:, index].copy(), chosen.astype(np.int64))
                else:
                    columns[own.name] = chosen
        self.data = self.data[used:]
        return columns, lists

    def _refuse(self, element: Element) -> NoReturn:
        raise DamagedFileError(
            self.place,
            f"is cut short or wrong: {element.count:,} {element.name} rows are due and "
            f"{len(self.data):,} numbers are there: copy it again",
        )
