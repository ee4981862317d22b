"""Apple RoomPlan: the JSON of a ``CapturedRoom`` or a ``CapturedStructure``.

Swift's ``JSONEncoder`` writes Apple's structures as declared: ``walls``, ``doors``, ``windows``,
``openings``, ``floors`` and ``objects``, each a list of ``{identifier, category, dimensions,
transform, confidence, ...}``. A structure contains ``rooms`` in one common frame. ``transform`` is
a column-major 4x4 matrix in metres with y up. ``dimensions`` are along the item's own x, y and z
axes. A surface is in its x-y plane, and the front of an object faces its z axis. Enumerations are
``{"table": {}}`` or ``"table"``. This module converts everything to a frame with z up: (x, -z, y).
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path, PurePath
from typing import Any, Literal

import numpy as np

from world2minecraft.core.archives import AnyPath, ArchivePath, is_zip
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import checks

MAX_BYTES = 64 << 20  # A house of RoomPlan has under 2 MB.
MAX_PARTS = 10_000
MAX_FILES = 2_000  # Number of files that are searched for a plan.
MAX_DISTANCE_M = 1_000.0
MAX_SIZE_M = 100.0
MIN_UPRIGHT_COSINE = 0.9  # Cosine of how far a wall may lean.
CONFIDENCE = {"high": 1.0, "medium": 0.6, "low": 0.3}
Y_UP_TO_Z_UP = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]], np.float64)
Kind = Literal["window", "door", "doorway"]


@dataclass(frozen=True, eq=False)
class PlanSurface:
    """A vertical rectangle, given by the ends of its base: a wall, window, door or doorway.

    ``start_m`` and ``end_m`` are float64 [2]. The rectangle extends from ``bottom_m`` to ``top_m``.
    """

    kind: Literal["wall", "window", "door", "doorway"]
    start_m: np.ndarray
    end_m: np.ndarray
    bottom_m: float
    top_m: float
    confidence: float = 1.0

    def __post_init__(self):
        put = object.__setattr__
        put(self, "start_m", checks.floats("start_m", self.start_m, (2,)))
        put(self, "end_m", checks.floats("end_m", self.end_m, (2,)))
        if not self.bottom_m < self.top_m:
            raise ValueError(f"bottom_m must be below top_m, got {self.bottom_m} and {self.top_m}")

    @property
    def length_m(self) -> float:
        """The length of the base in metres."""
        return float(np.linalg.norm(self.end_m - self.start_m))


@dataclass(frozen=True, eq=False)
class PlanObject:
    """A piece of furniture: RoomPlan's category, its box as in LayoutObject, and attributes.

    If ``design`` names the furniture template of the object (or ``cells``), the template and the
    front are not inferred from the box and the walls.
    """

    category: str
    center_m: np.ndarray  # float64 [3]
    size_m: np.ndarray  # float64 [3]: front-to-back, side, height
    yaw_deg: float
    confidence: float = 1.0
    words: frozenset[str] = frozenset()
    design: str = ""

    def __post_init__(self):
        put = object.__setattr__
        put(self, "center_m", checks.coordinates("center_m", self.center_m, (3,)))
        put(self, "size_m", checks.lengths("size_m", self.size_m, (3,)))
        if (self.size_m <= 0).any():
            raise ValueError(f"size_m must be above 0, got {self.size_m.tolist()}")


@dataclass(frozen=True, eq=False)
class PlanRoom:
    """One room: its surfaces, its furniture, and the outlines of its floors, float64 [N, 3]."""

    name: str
    walls: tuple[PlanSurface, ...]
    openings: tuple[PlanSurface, ...]
    objects: tuple[PlanObject, ...]
    floors: tuple[np.ndarray, ...] = ()


@dataclass(frozen=True, eq=False)
class CapturedPlan:
    """All rooms of a floor plan in its own frame: metres, z up, arbitrary yaw and origin.

    ``plan_to_session`` transforms that frame to the frame of the capture session, which has y up.
    ``notes`` are sentences for the report.
    """

    rooms: tuple[PlanRoom, ...]
    notes: tuple[str, ...] = ()
    plan_to_session: np.ndarray = field(default_factory=lambda: np.linalg.inv(Y_UP_TO_Z_UP))


def find_roomplan(path: Path) -> AnyPath | None:
    """Return the JSON file of a RoomPlan capture: the path itself, or a file in a folder or a zip.

    Returns None if there is none. Of several files, those with room in their name are preferred,
    then those nearest to the top level, then the first by name.
    """
    if path.is_file():
        if is_zip(path):
            return _first_plan(ArchivePath(path))
        return path if path.suffix.lower() == ".json" and is_roomplan(path) else None
    return _first_plan(path) if path.is_dir() else None


def is_roomplan(path: AnyPath) -> bool:
    """Return whether a JSON file is a RoomPlan capture. Unreadable files are not."""
    try:
        return _document(read_json(path, MAX_BYTES)) is not None
    except InputError:
        return False


def read_roomplan(path: AnyPath) -> CapturedPlan:
    """Read a RoomPlan capture.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not a RoomPlan capture, or differs from Apple's structures.
        LimitError: If the file is too large.
    """
    document = _document(read_json(path, MAX_BYTES))
    if document is None:
        raise DamagedFileError(
            path, "is not a RoomPlan capture; expected JSON with walls, doors, windows and objects"
        )
    notes: list[str] = []
    held = document.get("rooms")
    parts = held if isinstance(held, list) and held else [document]
    rooms = [_room(path, part, number, notes) for number, part in enumerate(parts, start=1)]
    rooms = [room for room in rooms if room.walls or room.floors]
    if not rooms:
        raise DamagedFileError(path, "contains neither walls nor floors; scan the room again")
    return CapturedPlan(tuple(rooms), tuple(dict.fromkeys(notes)))


def _first_plan(folder: AnyPath) -> AnyPath | None:
    files = sorted(
        folder.rglob("*.json"),
        key=lambda place: (
            "room" not in place.name.lower(),
            len(PurePath(str(place)).parts),
            str(place),
        ),
    )
    return next((place for place in files[:MAX_FILES] if is_roomplan(place)), None)


def _document(value: Any) -> dict[str, Any] | None:
    """Return the room or structure in a file, at the top level or one level below."""
    if not isinstance(value, dict):
        return None
    for inner in (value, *value.values()):
        lists = (
            {key for key, held in inner.items() if isinstance(held, list)}
            if isinstance(inner, dict)
            else set()
        )
        if "walls" in lists and lists & {"doors", "objects", "openings"}:
            return inner
        rooms = inner.get("rooms") if isinstance(inner, dict) else None
        if isinstance(rooms, list) and rooms and all(_document(room) is room for room in rooms):
            return inner
    return None


def _room(path: AnyPath, room: Any, number: int, notes: list[str]) -> PlanRoom:
    if not isinstance(room, dict):
        raise DamagedFileError(path, f"room {number} must be an object")
    walls = [
        surface
        for item, where in _items(path, room, "walls")
        if (surface := _surface(path, item, where, "wall", notes)) is not None
    ]
    openings = [
        surface
        for name, kind in (("doors", "door"), ("windows", "window"), ("openings", "doorway"))
        for item, where in _items(path, room, name)
        if (surface := _surface(path, item, where, _kind_of(item, kind), notes)) is not None
    ]
    objects = [_object(path, item, where) for item, where in _items(path, room, "objects")]
    floors = [_floor(path, item, where) for item, where in _items(path, room, "floors")]
    name = _label(room) or f"room {number}"
    return PlanRoom(name, tuple(walls), tuple(openings), tuple(objects), tuple(floors))


def _items(path: AnyPath, room: dict[str, Any], name: str) -> Iterator[tuple[dict, str]]:
    found = room.get(name) or []
    if not isinstance(found, list):
        raise DamagedFileError(path, f"{name} must be a list, got {type(found).__name__}")
    if len(found) > MAX_PARTS:
        raise LimitError(path, f"has {len(found):,} {name}; the limit is {MAX_PARTS:,}")
    for number, item in enumerate(found):
        if not isinstance(item, dict):
            raise DamagedFileError(path, f"{name}[{number}] must be an object")
        yield item, f"{name}[{number}]"


def _surface(
    path: AnyPath, item: dict[str, Any], where: str, kind: Any, notes: list[str]
) -> PlanSurface | None:
    width, height, _ = _dimensions(path, item, where)
    pose = _transform(path, item, where)
    if abs(pose[2, 1]) < MIN_UPRIGHT_COSINE:
        notes.append("a surface that is not vertical was skipped")
        return None
    if item.get("curve"):
        notes.append("a curved wall was replaced by its chord")
    if width <= 0 or height <= 0:
        notes.append("a surface without a size was skipped")
        return None
    along, middle = pose[:2, 0] * width / 2, pose[:3, 3]
    bottom, top = middle[2] - height / 2, middle[2] + height / 2
    ends = (middle[:2] - along, middle[:2] + along)
    return PlanSurface(kind, *ends, float(bottom), float(top), _confidence(item))


def _kind_of(item: dict[str, Any], kind: str) -> str:
    """Return the kind of an opening. An open door is a doorway."""
    category = item.get("category")
    inner = category.get("door") if isinstance(category, dict) else None
    if isinstance(inner, dict) and (inner.get("isOpen") is True or inner.get("_0") is True):
        return "doorway"
    return kind


def _object(path: AnyPath, item: dict[str, Any], where: str) -> PlanObject:
    size = _dimensions(path, item, where)
    pose = _transform(path, item, where)
    front = pose[:2, 2]
    yaw = float(np.degrees(np.arctan2(front[1], front[0]))) % 360
    width, height, depth = (max(side, 0.01) for side in size)
    return PlanObject(
        category=_word(item.get("category")),
        center_m=pose[:3, 3],
        size_m=np.array([depth, width, height]),
        yaw_deg=round(yaw, 6),
        confidence=_confidence(item),
        words=frozenset(_words(item.get("attributes"))),
    )


def _floor(path: AnyPath, item: dict[str, Any], where: str) -> np.ndarray:
    """Return the outline of a floor, float64 [N, 3]."""
    pose = _transform(path, item, where)
    corners = item.get("polygonCorners") or []
    if not isinstance(corners, list) or len(corners) > MAX_PARTS:
        raise DamagedFileError(path, f"{where}.polygonCorners must be a list of corners")
    if len(corners) < 3:
        width, height, _ = _dimensions(path, item, where)
        corners = [
            [x * width / 2, y * height / 2, 0] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))
        ]
    points = np.array([_numbers(path, corner, 3, f"{where}.polygonCorners") for corner in corners])
    return points @ pose[:3, :3].T + pose[:3, 3]


def _dimensions(path: AnyPath, item: dict[str, Any], where: str) -> np.ndarray:
    sides = np.abs(_numbers(path, item.get("dimensions"), 3, f"{where}.dimensions"))
    if (sides > MAX_SIZE_M).any():
        raise DamagedFileError(
            path, f"{where} measures {sides.max():.4g} m; export the plan in metres"
        )
    return sides


def _transform(path: AnyPath, item: dict[str, Any], where: str) -> np.ndarray:
    """Return the pose of an item in the frame with z up, float64 [4, 4]."""
    held = item.get("transform")
    if isinstance(held, dict):
        held = held.get("columns")
    if isinstance(held, list) and len(held) == 4 and all(isinstance(row, list) for row in held):
        held = [value for column in held for value in column]
    columns = _numbers(path, held, 16, f"{where}.transform").reshape(4, 4)
    pose = columns.T
    if fault := checks.rigid_fault(pose, 0.02):
        raise DamagedFileError(
            path, f"{where}.transform must be a rigid transform in column-major order, but {fault}"
        )
    if np.abs(pose[:3, 3]).max() > MAX_DISTANCE_M:
        raise DamagedFileError(
            path, f"{where} is over {MAX_DISTANCE_M:g} m away; export the plan in metres"
        )
    return Y_UP_TO_Z_UP @ pose


def _numbers(path: AnyPath, value: Any, count: int, where: str) -> np.ndarray:
    good = isinstance(value, list) and len(value) == count
    good = good and all(type(one) in (int, float) and abs(one) < 1e9 for one in value)
    if not good:
        raise DamagedFileError(path, f"{where} must be {count} numbers")
    return np.array(value, np.float64)


def _word(value: Any) -> str:
    """Return the name of an enumeration's case, or "" if there is none."""
    if isinstance(value, dict):
        value = next(iter(value), "")
    return value if isinstance(value, str) and value.isidentifier() else ""


def _words(value: Any, depth: int = 0) -> Iterator[str]:
    """Yield all words in an object's attributes at any nesting level."""
    if depth > 6:
        return
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        yield from (str(key) for key in value)
        for inner in value.values():
            yield from _words(inner, depth + 1)
    elif isinstance(value, list):
        for inner in value[:MAX_FILES]:
            yield from _words(inner, depth + 1)


def _confidence(item: dict[str, Any]) -> float:
    return CONFIDENCE.get(_word(item.get("confidence")), 1.0)


def _label(room: dict[str, Any]) -> str:
    """Return the name of a room from its sections, or "" if it is ambiguous."""
    sections = room.get("sections")
    names = [
        _word(section.get("label"))
        for section in (sections if isinstance(sections, list) else [])
        if isinstance(section, dict)
    ]
    known = sorted({name for name in names if name and name != "unidentified"})
    spaced = "".join(f" {c.lower()}" if c.isupper() else c for c in known[0]) if known else ""
    return spaced if len(known) == 1 else ""
