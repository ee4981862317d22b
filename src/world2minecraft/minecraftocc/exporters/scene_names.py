"""ScanNet-like names for our scenes and frames, with the table that maps them back.

OccScanNet's loaders cut ``scene0000_00/00000`` out of paths. A scene has the number of its first
appearance, a frame the number of its turn within the scene. The table is kept in the folder, so
that an export that goes on, or grows, keeps its names.
"""

from dataclasses import dataclass
from pathlib import Path

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_json, write_json

TABLE = "names.json"
SAVE_EVERY = 50  # Samples, or a twentieth of them: writing the table stays cheap as it grows.


@dataclass(frozen=True)
class NamedSample:
    """What a sample is called, and what lists need to know of it."""

    scene: str  # scene0000_00
    frame: str  # 00000
    split: str  # train or test
    occupied: int  # How many cells are neither empty nor unknown.
    scene_id: str  # Ours.

    @property
    def path(self) -> str:
        """The name within folders, ``scene0000_00/00000``."""
        return f"{self.scene}/{self.frame}"


class SceneNames:
    """The table of one folder. Raises DamagedFileError where the file is none of ours."""

    def __init__(self, root: Path):
        self.path = root / TABLE
        self.samples: dict[str, NamedSample] = {}
        self._unsaved = 0
        if self.path.is_file():
            self.samples = _read(self.path)
        self.scenes = {row.scene_id: row.scene for row in self.samples.values()}
        self._frames: dict[str, int] = {}
        for row in self.samples.values():
            self._frames[row.scene] = max(self._frames.get(row.scene, 0), int(row.frame) + 1)

    def name(self, key: str, scene_id: str, split: str, occupied: int) -> NamedSample:
        """Return the name of a sample, a new one where it has none."""
        if key in self.samples:
            return self.samples[key]
        scene = self.scenes.get(scene_id) or f"scene{len(self.scenes):04d}_00"
        return NamedSample(scene, f"{self._frames.get(scene, 0):05d}", split, occupied, scene_id)

    def keep(self, key: str, row: NamedSample) -> None:
        """Put a finished sample into the table."""
        self.samples[key] = row
        self.scenes[row.scene_id] = row.scene
        self._frames[row.scene] = max(self._frames.get(row.scene, 0), int(row.frame) + 1)
        self._unsaved += 1
        if self._unsaved >= max(SAVE_EVERY, len(self.samples) // 20):
            self.save()

    def save(self) -> None:
        """Write the table."""
        rows = {
            key: [row.scene, row.frame, row.split, row.occupied, row.scene_id]
            for key, row in self.samples.items()
        }
        write_json(self.path, rows)
        self._unsaved = 0


def _read(path: Path) -> dict[str, NamedSample]:
    try:
        found = {str(key): NamedSample(*row) for key, row in read_json(path).items()}
        for row in found.values():
            int(row.frame)
    except (TypeError, ValueError, AttributeError) as error:
        raise DamagedFileError(path, f"is no table of names ({error}); remove it") from error
    return dict(sorted(found.items(), key=lambda item: (item[1].scene, item[1].frame)))
