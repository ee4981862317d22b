"""Exporter for EmbodiedOcc-ScanNet: complete scenes, with masks of the cells that each frame sees.

The output folder corresponds to the loader's ``data`` folder: ``occscannet/`` contains the frames,
``scene_occ/`` the scene packages and the masks. The grid of a scene is assembled cell by cell from
the boxes of its frames, which all share one coordinate system. The label of a cell comes from the
first frame in which it is known.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.errors import UsageError
from world2minecraft.core.files import write_bytes, write_text
from world2minecraft.formats.safe_pickle import dump_pickle
from world2minecraft.minecraftocc.exporters.occscannet import OccScanNetExporter
from world2minecraft.minecraftocc.exporters.options import ExportRule
from world2minecraft.minecraftocc.exporters.scene_names import NamedSample
from world2minecraft.minecraftocc.formats.label_grids import (
    SceneGrid,
    StoredFrame,
    read_stored_frame,
)
from world2minecraft.minecraftocc.types import DEFAULT_VOXEL_M, OccSample

OFFICIAL_CELLS = (200, 220, 90)  # Largest scene that EmbodiedOcc's compiled operation supports.


class EmbodiedExporter:
    """An exporter that writes frames as they arrive and scenes when all frames are written."""

    def __init__(self, root: Path, rule: ExportRule):
        self.root, self.rule = root, rule
        self.frames = OccScanNetExporter(root / "occscannet", rule, only_room=True)
        self._large: list[str] = []

    def is_done(self, key: str) -> bool:
        """Return whether a frame is finished. Scenes are written again if frames were added."""
        return self.frames.is_done(key)

    def write(self, sample: OccSample) -> None:
        """Write a frame.

        Raises the same exceptions as ``Exporter.write``.
        """
        self.frames.write(sample)

    def pause(self) -> None:
        """Write the table of scene and frame names."""
        self.frames.pause()

    def finish(self, keys: Sequence[str]) -> None:
        """Write a package for each scene, the masks of its frames, and the lists of scenes.

        Scenes without frames in this run are left unchanged and stay in the lists.
        """
        self.frames.finish(keys)
        named = self.frames.names.samples
        exported = {named[key].scene for key in keys if key in named}
        scenes: dict[str, list[NamedSample]] = {}
        for key, row in named.items():
            if row.occupied and self.frames.is_done(key):
                scenes.setdefault(row.scene, []).append(row)
        splits: dict[str, list[str]] = {"train": [], "test": []}
        for scene in sorted(scenes):
            rows = sorted(scenes[scene], key=lambda row: row.frame)
            splits[_split_of(rows)].append(scene)
            if scene in exported or not self._package_path(scene).is_file():
                self._write_scene(scene, _evenly(rows, self.rule.frames_per_scene))
        for split, names in splits.items():
            lines = "".join(f"{name}\n" for name in names)
            write_text(self.root / "scene_occ" / f"{split}_online.txt", lines)

    def notes(self) -> list[str]:
        """Return descriptions of data that the format cannot represent unchanged."""
        lines = self.frames.notes()
        if self._large:
            size = "x".join(str(side) for side in OFFICIAL_CELLS)
            lines.append(
                f"{len(self._large)} scenes exceed {size} cells, the limit of EmbodiedOcc's "
                f"own code: {', '.join(self._large[:3])}"
            )
        return lines

    def _write_scene(self, scene: str, rows: list[NamedSample]) -> None:
        """Write the masks of a scene's frames, then its package, which marks it as finished."""
        frames = [self._stored(row) for row in rows]
        grid = SceneGrid.around([frame.origin_m for frame in frames], DEFAULT_VOXEL_M)
        if any(side > most for side, most in zip(grid.shape, OFFICIAL_CELLS, strict=True)):
            self._large.append(scene)
        labels = np.full(grid.shape, UNKNOWN, np.uint8)
        seen = np.zeros(grid.shape, bool)
        for row, frame in zip(rows, frames, strict=True):
            place = grid.slices(frame.origin_m)
            part = labels[place]
            part[part == UNKNOWN] = frame.labels[part == UNKNOWN]
            mask = np.zeros(grid.shape, bool)
            mask[place] = frame.in_image
            seen |= mask
            self._write_mask(row, frame, mask)
        self._sweep_masks(scene, rows)
        write_bytes(self._package_path(scene), self._package(grid, labels, seen, rows))

    def _sweep_masks(self, scene: str, rows: list[NamedSample]) -> None:
        """Delete masks of frames that are no longer used, because they refer to another grid."""
        taken = {self._mask_path(row) for row in rows}
        for path in self._mask_path(rows[0]).parent.glob(f"{scene}_*_new.pkl"):
            if path not in taken:
                path.unlink()

    def _package_path(self, scene: str) -> Path:
        return self.root / "scene_occ" / "global_occ_package" / f"{scene}.pkl"

    def _mask_path(self, row: NamedSample) -> Path:
        folder = self.root / "scene_occ" / "streme_occ_new_package" / row.split
        return folder / f"{row.scene}_{row.frame}_new.pkl"

    def _write_mask(self, row: NamedSample, frame: StoredFrame, mask: np.ndarray) -> None:
        path = self._mask_path(row)
        stored = np.ascontiguousarray(frame.labels.transpose(1, 0, 2))
        write_bytes(path, dump_pickle({"local_label": stored, "mask_in_global": mask}))

    def _package(
        self, grid: SceneGrid, labels: np.ndarray, seen: np.ndarray, rows: list[NamedSample]
    ) -> bytes:
        return dump_pickle(
            {
                "scene_dim": list(grid.shape),
                "global_labels": labels,
                "global_pts": grid.centers_m().astype(np.float32),
                "valid_img_paths": [
                    f"{self.rule.data_root}/posed_images/{row.path}.jpg" for row in rows
                ],
                "global_mask": seen,
            }
        )

    def _stored(self, row: NamedSample) -> StoredFrame:
        return read_stored_frame(self.frames.root / "gathered_data" / f"{row.path}.pkl")


def _split_of(rows: list[NamedSample]) -> str:
    splits = {row.split for row in rows}
    if len(splits) > 1:
        raise UsageError(
            f"scene {rows[0].scene_id} has frames in train and in test; the embodied format needs "
            "each scene in one split, so change the splits of the data set"
        )
    return splits.pop()


def _evenly(rows: list[NamedSample], count: int) -> list[NamedSample]:
    """Return ``count`` evenly spaced rows, or all rows if there are fewer."""
    if not count or len(rows) <= count:
        return rows
    chosen = np.linspace(0, len(rows) - 1, count).round().astype(int)
    return [rows[index] for index in chosen]
