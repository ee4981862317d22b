"""Names of the objects of a room or a world, by object id.

A run states them in ``objects.json``, and every world in the ``objects`` of ``scene.json``, so that
a world that was copied elsewhere keeps them: a list of ``{id, class, name, name_confidence}``.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.classes import CLASS_NAMES, class_id
from world2minecraft.core.errors import MALFORMED, DamagedFileError, World2MinecraftError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import checks
from world2minecraft.core.vocabulary import object_title


@dataclass(frozen=True)
class NamedObject:
    """The name of an object: of the vocabulary, a person's own words, or that of its class."""

    id: int
    class_id: int
    name: str
    name_confidence: float = 0.0

    def __post_init__(self):
        if not 1 <= self.id <= 65535:
            raise ValueError(f"id must be 1 to 65535, got {self.id}")
        if not checks.object_name(self.name):
            raise ValueError("name must not be empty")
        confidence = checks.fraction("name_confidence", self.name_confidence)
        object.__setattr__(self, "name_confidence", confidence)

    @property
    def title(self) -> str:
        """The text that people read."""
        return object_title(self.name, self.class_id)


def rows_of_names(objects: Iterable[NamedObject]) -> list[dict[str, Any]]:
    """Return a JSON object for each name."""
    return [
        {
            "id": one.id,
            "class": CLASS_NAMES[one.class_id],
            "name": one.name,
            "name_confidence": round(one.name_confidence, 4),
        }
        for one in objects
    ]


def names_of_rows(rows: Any, path: Path) -> tuple[NamedObject, ...]:
    """Parse the rows of ``objects.json`` or of ``objects`` in ``scene.json``; unnamed are left out.

    Raises:
        DamagedFileError: If a row is not valid.
    """
    if not isinstance(rows, list):
        raise DamagedFileError(path, f"must contain a list of objects, got {type(rows).__name__}")
    found = []
    for number, row in enumerate(rows):
        try:
            if row.get("name"):
                confidence = float(row.get("name_confidence", 0.0))
                named = (int(row["id"]), class_id(row["class"]), str(row["name"]), confidence)
                found.append(NamedObject(*named))
        except (*MALFORMED, World2MinecraftError) as error:
            raise DamagedFileError(path, f"object {number} is not valid ({error})") from error
    return tuple(found)


def read_run_names(folder: str | Path) -> tuple[NamedObject, ...]:
    """Return the names of the objects of a run folder; none in runs of former versions.

    Raises:
        DamagedFileError: If ``objects.json`` exists and cannot be read.
    """
    path = Path(folder) / "objects.json"
    return names_of_rows(read_json(path), path) if path.is_file() else ()


def read_world_names(folder: str | Path) -> tuple[NamedObject, ...]:
    """Return the names of the objects of a world: of ``scene.json``, else of the run around it.

    Args:
        folder: A run, its ``build`` folder, or any folder with ``scene.json``.

    Raises:
        DamagedFileError: If a file exists and cannot be read.
    """
    place = Path(folder)
    build = next((p for p in (place, place / "build") if (p / "scene.json").is_file()), None)
    if build is None:
        return read_run_names(place)
    raw = read_json(build / "scene.json")
    if isinstance(raw, dict) and "objects" in raw:
        return names_of_rows(raw["objects"], build / "scene.json")
    return read_run_names(build.parent)


def name_table(objects: Iterable[NamedObject]) -> Mapping[int, str]:
    """Return the name of each object by id."""
    return {one.id: one.name for one in objects}
