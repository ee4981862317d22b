"""A ScanNet scene becomes ``truth.npz`` and ``truth.json``."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from world2minecraft.capture.sources import SOURCES
from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.errors import CaptureError, InputError
from world2minecraft.core.files import write_json, write_npz
from world2minecraft.core.progress import Progress, silent
from world2minecraft.evaluation.scoring.scannet.labelled_mesh import (
    labelled_meshes,
    read_labelled_mesh,
)
from world2minecraft.evaluation.scoring.scannet.seen import seen_free
from world2minecraft.evaluation.scoring.scannet.surface import surface_voxels
from world2minecraft.evaluation.scoring.truth import Truth
from world2minecraft.procgen.capture import stated_object

RECORDINGS = ("scannet_sens", "scannet_folder")
VOXEL_M = 0.02  # As the truth of generated rooms: a quarter of a cell.


@dataclass(frozen=True)
class TruthMade:
    """What a truth holds: sides in metres, surface in voxels, and how much of it has a class."""

    name: str
    size_m: tuple[float, float, float]
    surface: int
    annotated_share: float
    free: int
    objects: int


def scenes_in(place: Path) -> list[Path]:
    """Return the scene at a place, or the scenes in it, by name.

    Raises:
        InputError: there are none.
    """
    if labelled_meshes(place):
        return [place]
    inner = sorted(place.iterdir()) if place.is_dir() else []
    found = [folder for folder in inner if labelled_meshes(folder)]
    if not found:
        raise InputError(
            place, "is no ScanNet scene, nor a folder of them: no *_vh_clean_2.labels.ply is there"
        )
    return found


def write_scannet_truth(
    scene: Path, out: Path | None = None, progress: Progress = silent
) -> TruthMade:
    """Write the truth of a scene.

    Args:
        scene: the folder with the ``.sens`` or exported frames and the labelled mesh.
        out: where to write; None for the scene's own folder.
        progress: told of the stages ``mesh`` and ``seen``.

    Raises:
        InputError: a file of the scene is missing or damaged. OutputError: ``out`` cannot be
            written.
    """
    progress("mesh", 0, 1, scene.name)
    mesh = read_labelled_mesh(scene)
    # Asked first: a mesh alone is a capture too, of another kind.
    if not any(SOURCES.load(name)().recognise(scene) for name in RECORDINGS):
        raise CaptureError(
            scene, f"holds no frames; put {mesh.name}.sens or exported color/ depth/ pose/ there"
        )
    voxels = surface_voxels(mesh, VOXEL_M)
    progress("mesh", 1, 1, scene.name)
    truth = Truth(
        folder=scene if out is None else out,
        labels=voxels.labels,
        voxel_m=VOXEL_M,
        origin_m=voxels.origin_m,
        truth_to_scan=mesh.truth_to_scan,
        objects=mesh.objects,
        surface=voxels.surface,
        capture=scene,
    )
    free = seen_free(truth, progress) & ~voxels.surface
    truth = replace(truth, labels=np.where(free, 0, truth.labels).astype(np.uint8))
    _write(truth, voxels.instance, mesh.name)
    return _told(mesh.name, truth, free)


def _write(truth: Truth, instance: np.ndarray, name: str) -> None:
    arrays = {
        "labels": truth.labels,
        "instance": instance,
        "surface": np.asarray(truth.surface),
        "voxel_m": np.array(truth.voxel_m),
        "origin_m": truth.origin_m,
        "truth_room_to_scan": truth.truth_to_scan,
    }
    write_npz(truth.folder / "truth.npz", arrays)
    apart = truth.capture.resolve() != truth.folder.resolve()
    stated = {
        "kind": "scannet",
        "scene": name,
        "objects": [stated_object(n, item) for n, item in enumerate(truth.objects, start=1)],
        "layouts": [],
    }
    where = {"capture": str(truth.capture.resolve())} if apart else {}
    write_json(truth.folder / "truth.json", stated | where)


def _told(name: str, truth: Truth, free: np.ndarray) -> TruthMade:
    surface = np.asarray(truth.surface)
    held = np.argwhere(surface)
    size = (held.max(axis=0) + 1 - held.min(axis=0)) * truth.voxel_m
    classed = int((surface & (truth.labels != UNKNOWN)).sum())
    return TruthMade(
        name=name,
        size_m=(float(size[0]), float(size[1]), float(size[2])),
        surface=len(held),
        annotated_share=classed / len(held),
        free=int(free.sum()),
        objects=len(truth.objects),
    )
