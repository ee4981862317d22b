"""Exporter for the OccScanNet layout read by ISO, EmbodiedOcc and GPOcc.

The folder contains ``gathered_data/SCENE/NNNNN.pkl``, ``posed_images/SCENE/NNNNN.jpg`` and
``.png``, and the lists of samples. Labels are stored as [y, x, z]: EmbodiedOcc and GPOcc swap the
first two axes when they load them, and the projected cells then match the image. ISO does not swap
them; ``ExportRule(axes="iso")`` stores them as [x, y, z] for its loader.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import InputError
from world2minecraft.core.files import write_bytes, write_text
from world2minecraft.core.types import Camera
from world2minecraft.formats.safe_pickle import dump_pickle
from world2minecraft.formats.sscnet import downsample_labels
from world2minecraft.minecraftocc.exporters.options import (
    AXES_CHOICES,
    ExportRule,
    encode_jpeg,
    export_split,
    require_colour,
)
from world2minecraft.minecraftocc.exporters.scene_names import NamedSample, SceneNames
from world2minecraft.minecraftocc.formats.image_conventions import (
    HALF_PX,
    Resampler,
    encode_depth,
    vga_camera,
)
from world2minecraft.minecraftocc.formats.label_grids import (
    LabelledBox,
    box_cells_in_image,
    check_standard_region,
    export_labels,
    region_box,
    room_box,
)
from world2minecraft.minecraftocc.types import OccSample

ORIGIN_DECIMALS = 4  # As EmbodiedOcc's loader rounds, so that all loaders use the same box.
LISTS = {
    "train": ("train_subscenes.txt", "train_final.txt"),
    "test": ("val_subscenes.txt", "test_final.txt"),
}


class OccScanNetExporter:
    """An exporter that writes the OccScanNet layout."""

    def __init__(self, root: Path, rule: ExportRule, *, only_room: bool = False):
        self.root, self.rule, self._only_room = root, rule, only_room
        self.names = SceneNames(root)
        self._resampled = self._turned = self._no_depth = 0

    def is_done(self, key: str) -> bool:
        """Return whether a sample is in the table and its pickle exists, which is written last."""
        row = self.names.samples.get(key)
        return row is not None and (self.root / "gathered_data" / f"{row.path}.pkl").is_file()

    def write(self, sample: OccSample) -> None:
        """Write the three files of a sample.

        Raises the same exceptions as ``Exporter.write``.
        """
        check_standard_region(sample)
        camera = vga_camera(sample.camera)
        resampler = Resampler(sample.key, sample.camera, camera)
        camera = sample.camera if resampler.same else camera
        box = self._box(sample)
        in_image = box_cells_in_image(box, camera) if self.rule.in_view else None
        labels = export_labels(box.labels, in_image, self.rule.unknown)
        occupied = int(np.count_nonzero((labels > 0) & (labels < 255)))
        row = self.names.name(sample.key, sample.scene_id, export_split(sample), occupied)
        picture = self.root / "posed_images" / row.path
        write_bytes(
            picture.with_suffix(".jpg"), encode_jpeg(resampler.colour(require_colour(sample)))
        )
        if sample.depth_m is not None:
            depth = resampler.depth(sample.depth_m)
            write_bytes(picture.with_suffix(".png"), encode_depth(depth, "mm"))
        data = self._pickle(row, labels, box, camera)
        write_bytes(self.root / "gathered_data" / f"{row.path}.pkl", data)
        self.names.keep(sample.key, row)
        self._resampled += not resampler.same
        self._no_depth += sample.depth_m is None

    def pause(self) -> None:
        """Write the table of scene and frame names."""
        self.names.save()

    def finish(self, keys: Sequence[str]) -> None:
        """Write the table of names and the sample lists of ISO and EmbodiedOcc.

        The lists contain all samples in the folder, so splits can be exported one after another.
        """
        self.names.save()
        rows = [row for key, row in self.names.samples.items() if self.is_done(key)]
        rows.sort(key=lambda row: row.path)
        for split, (all_frames, with_content) in LISTS.items():
            of_split = [row for row in rows if row.split == split]
            self._write_list(all_frames, of_split)
            self._write_list(with_content, [row for row in of_split if row.occupied])

    def notes(self) -> list[str]:
        """Return descriptions of data that the format cannot represent unchanged."""
        texts = {
            "images were cropped and resampled to 640x480 pixels": self._resampled,
            "samples have no depth, which every loader of this format requires": self._no_depth,
            "regions are rotated with the view, each with its own coordinate system": self._turned,
        }
        return [f"{count} {words}" for words, count in texts.items() if count]

    def _box(self, sample: OccSample) -> LabelledBox:
        """Return the box along the room axes, so that all frames of a scene share one world."""
        box = room_box(sample)
        if box is None:
            if self._only_room:
                raise InputError(
                    sample.key,
                    "the region is rotated with the view, but scene packages need "
                    "regions along the "
                    "room axes; build the data set with the region paper (--region paper)",
                )
            self._turned += 1
            box = region_box(sample)
        return LabelledBox(box.labels, np.round(box.origin_m, ORIGIN_DECIMALS), box.camera_to_world)

    def _pickle(
        self, row: NamedSample, labels: np.ndarray, box: LabelledBox, camera: Camera
    ) -> bytes:
        stored = np.ascontiguousarray(labels.transpose(AXES_CHOICES[self.rule.axes]))
        intrinsic = np.eye(4)
        intrinsic[:3, :3] = camera.matrix
        intrinsic[:2, 2] -= HALF_PX
        picture = f"{self.rule.data_root}/posed_images/{row.path}"
        return dump_pickle(
            {
                "img": f"{picture}.jpg",
                "depth_gt": f"{picture}.png",
                "cam_pose": box.camera_to_world.astype(np.float64),
                "intrinsic": intrinsic,
                "voxel_origin": box.origin_m,
                "target_1_4": stored,
                "target_1_16": downsample_labels(stored, 4),
            }
        )

    def _write_list(self, name: str, rows: list[NamedSample]) -> None:
        lines = "".join(f"gathered_data/{row.path}.pkl\n" for row in rows)
        write_text(self.root / name, lines)
