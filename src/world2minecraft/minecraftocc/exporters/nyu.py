"""Exporter for the NYUv2 layout read by MonoScene, NDC-Scene, ISO and Symphonies.

``NYUtrain/`` and ``NYUtest/`` contain NAME_color.jpg, NAME.png and NAME.bin; ``base/NYUtrain/`` and
``base/NYUtest/`` contain NAME.pkl. The world coordinates in each file are those of its region, with
z up and the minimum corner at 0. With this origin, the loaders' own arithmetic (a division that is
rounded up) always results in 60 cells for 4.8 m, whatever the machine.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from world2minecraft.core.files import write_bytes
from world2minecraft.formats.safe_pickle import dump_pickle
from world2minecraft.formats.sscnet import HEADER_BYTES, downsample_labels, encode_bin
from world2minecraft.minecraftocc.exporters.options import (
    ExportRule,
    encode_jpeg,
    export_split,
    require_colour,
)
from world2minecraft.minecraftocc.formats.image_conventions import (
    NYU_CAMERA,
    Resampler,
    encode_depth,
)
from world2minecraft.minecraftocc.formats.label_grids import (
    LabelledBox,
    box_cells_in_image,
    check_standard_region,
    export_labels,
    region_box,
)
from world2minecraft.minecraftocc.types import OccSample

FOLDERS = {"train": "NYUtrain", "test": "NYUtest"}
AXES = (0, 2, 1)  # From x, y, z to x, z, y and back.


class NyuExporter:
    """An exporter that writes the NYUv2 layout."""

    def __init__(self, root: Path, rule: ExportRule):
        self.root, self.rule = root, rule
        self._counts = {"resampled": 0, "no depth": 0, "no split": 0}

    def is_done(self, key: str) -> bool:
        """Return whether the ``.bin`` file of a sample exists, which is written last."""
        return any((self.root / folder / f"{key}.bin").is_file() for folder in FOLDERS.values())

    def write(self, sample: OccSample) -> None:
        """Write the four files of a sample.

        Raises the same exceptions as ``Exporter.write``.
        """
        check_standard_region(sample)
        resampler = Resampler(sample.key, sample.camera, NYU_CAMERA)
        folder = FOLDERS[export_split(sample)]
        stem = self.root / folder / sample.key
        jpeg = encode_jpeg(resampler.colour(require_colour(sample)))
        write_bytes(stem.with_name(f"{sample.key}_color.jpg"), jpeg)
        if sample.depth_m is not None:
            depth = resampler.depth(sample.depth_m)
            write_bytes(stem.with_name(f"{sample.key}.png"), encode_depth(depth, "nyu"))
        box = region_box(sample)
        in_image = box_cells_in_image(box, NYU_CAMERA) if self.rule.in_view else None
        labels = export_labels(box.labels, in_image, self.rule.unknown).transpose(AXES)
        labels = np.ascontiguousarray(labels)
        write_bytes(
            self.root / "base" / folder / f"{sample.key}.pkl", _pickle(sample.key, labels, box)
        )
        data = encode_bin(labels, box.origin_m, box.camera_to_world)
        if self.rule.short_bin:
            data = data[:HEADER_BYTES]
        write_bytes(stem.with_name(f"{sample.key}.bin"), data)
        self._count(sample, resampler)

    def pause(self) -> None:
        """Do nothing, because existing files mark the finished samples."""

    def finish(self, keys: Sequence[str]) -> None:
        """Do nothing, because the loaders list the folders themselves."""

    def notes(self) -> list[str]:
        """Return descriptions of data that the format cannot represent unchanged."""
        texts = {
            "resampled": "images were resampled to 640x480 pixels with f = 518.8579",
            "no depth": "samples have no depth: MonoScene and NDC-Scene can read them, "
            "ISO and Symphonies cannot",
            "no split": "samples have no split and were written to NYUtrain",
        }
        return [f"{count} {texts[name]}" for name, count in self._counts.items() if count]

    def _count(self, sample: OccSample, resampler: Resampler) -> None:
        self._counts["resampled"] += not resampler.same
        self._counts["no depth"] += sample.depth_m is None
        self._counts["no split"] += not sample.split


def _pickle(name: str, labels: np.ndarray, box: LabelledBox) -> bytes:
    """Return the content of the pickle that MonoScene's preprocessing creates from the ``.bin``.

    The 32 cm grid is computed from the 8 cm grid. This gives the same result as computing it from 2
    cm voxels, because each cell consists of equal voxels.
    """
    return dump_pickle(
        {
            "cam_pose": box.camera_to_world.astype(np.float32),
            "voxel_origin": box.origin_m.astype(np.float32),
            "name": name,
            "target_1_4": labels,
            "target_1_16": downsample_labels(labels, 4),
        }
    )
