"""ScanNet-like names for scenes and frames, with a table that maps them to sample keys.

The loaders of OccScanNet extract ``scene0000_00/00000`` from paths. Scenes are numbered in the
order in which they first appear, and frames in their order within the scene. The table is saved in
the output folder, so a resumed or extended export keeps its names.
"""

from dataclasses import dataclass
from pathlib import Path

from world2minecraft.core.errors import MALFORMED, DamagedFileError
from world2minecraft.core.files import read_json, write_json

TABLE = "names.json"
SAVE_EVERY = 50  # Samples, or a twentieth of the table, so that large tables are written rarely.


@dataclass(frozen=True)
class NamedSample:
    """The name of an exported sample and the facts needed for the lists.

    Attributes:
        scene: Exported scene name, such as ``scene0000_00``.
        frame: Exported frame name, such as ``00000``.
        split: ``train`` or ``test``.
        occupied: Number of cells that are neither empty nor unknown.
        scene_id: Name of the scene in the original data set.
    """

    scene: str
    frame: str
    split: str
    occupied: int
    scene_id: str

    @property
    def path(self) -> str:
        """Relative path of the sample, such as ``scene0000_00/00000``."""
        return f"{self.scene}/{self.frame}"


class SceneNames:
    """The table of exported names in a folder.

    Raises:
        DamagedFileError: If the existing table file is not valid.
    """

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
        """Return the name of a sample, assigning a new name if it has none."""
        if key in self.samples:
            return self.samples[key]
        scene = self.scenes.get(scene_id) or f"scene{len(self.scenes):04d}_00"
        return NamedSample(scene, f"{self._frames.get(scene, 0):05d}", split, occupied, scene_id)

    def keep(self, key: str, row: NamedSample) -> None:
        """Add a finished sample to the table."""
        self.samples[key] = row
        self.scenes[row.scene_id] = row.scene
        self._frames[row.scene] = max(self._frames.get(row.scene, 0), int(row.frame) + 1)
        self._unsaved += 1
        if self._unsaved >= max(SAVE_EVERY, len(self.samples) // 20):
            self.save()

    def save(self) -> None:
        """Write the table to its file."""
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
    except MALFORMED as error:
        raise DamagedFileError(
            path, f"not a valid table of names ({error}); delete the file"
        ) from error
    return dict(sorted(found.items(), key=lambda item: (item[1].scene, item[1].frame)))
