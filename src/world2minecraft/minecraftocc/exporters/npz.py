"""Exporter for plain ``.npz`` files, one per sample, with named arrays and without pickles."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.files import write_json, write_npz
from world2minecraft.minecraftocc.exporters.options import ExportRule
from world2minecraft.minecraftocc.formats.label_grids import cells_in_image, export_labels
from world2minecraft.minecraftocc.types import OccSample

SPLITS = ("train", "test", "val", "all")


class NpzExporter:
    """An exporter that writes ``SPLIT/KEY.npz`` files and ``index.json``."""

    def __init__(self, root: Path, rule: ExportRule):
        self.root, self.rule = root, rule

    def is_done(self, key: str) -> bool:
        """Return whether the file of a sample exists."""
        return any((self.root / split / f"{key}.npz").is_file() for split in SPLITS)

    def write(self, sample: OccSample) -> None:
        """Write the file of a sample."""
        write_npz(self.root / (sample.split or "all") / f"{sample.key}.npz", self._arrays(sample))

    def pause(self) -> None:
        """Do nothing, because existing files mark the finished samples."""

    def finish(self, keys: Sequence[str]) -> None:
        """Write the list of all samples in the folder, including those of earlier runs."""
        rows = {path.stem: split for split in SPLITS for path in (self.root / split).glob("*.npz")}
        write_json(self.root / "index.json", {"format": "world2minecraft-occ-npz", "keys": rows})

    def notes(self) -> list[str]:
        """Return an empty list, because the format represents all data unchanged."""
        return []

    def _arrays(self, sample: OccSample) -> dict[str, np.ndarray]:
        occ, camera, region = sample.occ, sample.camera, sample.occ.region
        lens = (camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, *camera.distortion)
        meta = {
            "key": sample.key, "scene_id": sample.scene_id, "tour_id": sample.tour_id,
            "frame": sample.frame, "split": sample.split, "region_kind": region.kind,
            "facts": sample.facts,
        }  # fmt: skip
        in_view = None
        if self.rule.in_view:
            to_camera = invert_rigid(sample.camera_to_room) @ region.region_to_room
            in_view = cells_in_image(region.shape, region.voxel_m, to_camera, camera)[0]
        arrays = {
            "labels": export_labels(occ.labels, in_view, self.rule.unknown),
            "fine": occ.fine,
            "instance": occ.instance,
            "in_frustum": occ.in_frustum,
            "hits": occ.hits,
            "free": occ.free,
            "fine_blocks": np.array([kind.block for kind in sample.fine_classes], np.str_),
            "fine_designs": np.array([kind.design for kind in sample.fine_classes], np.str_),
            "voxel_m": np.float64(region.voxel_m),
            "region_to_room": region.region_to_room,
            "camera_to_room": sample.camera_to_room,
            "camera_size_px": np.array([camera.width_px, camera.height_px], np.int64),
            "camera_lens": np.array(lens, np.float64),
            "meta": np.array(json.dumps(meta, sort_keys=True), np.str_),
        }
        if sample.colour is not None:
            arrays["colour"] = sample.colour
        if sample.depth_m is not None:
            arrays["depth_m"] = sample.depth_m
        return arrays
