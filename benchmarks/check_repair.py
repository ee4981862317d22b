"""The headline and the objects' IoU of a finished run before and after repair by rendering.

    python -m benchmarks.check_repair RUN CAPTURE

The run must be made with ``--set repair.enabled=no``; it is not changed. The headline is that of
the report's photos. CPU seconds are those of the repair after the compilation of its kernels.
"""

import argparse
import json
import shutil
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.core.progress import no_progress
from world2minecraft.evaluation.report.finished_run import FinishedScene, read_finished
from world2minecraft.evaluation.report.photo_section import compare_with_photos
from world2minecraft.formats.objects_and_placements import read_placements
from world2minecraft.reconstruction.file_stages import built_volume
from world2minecraft.reconstruction.opening import prepare_and_open
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.pipeline import STAGES, read_registered
from world2minecraft.reconstruction.repair import RepairParameters
from world2minecraft.reconstruction.repair_run import REPAIRS, repair_run
from world2minecraft.reconstruction.resume import resume_parameters
from world2minecraft.reconstruction.retrieval.other_furniture import OtherFurniture


def mean_iou(scene: FinishedScene) -> float:
    """Return the mean IoU of the objects' cells and their furniture, 1 for own cells."""
    others = OtherFurniture(scene.grid, scene.rooms)
    fits = [
        others.fit(one, tuple(p for p in scene.placements if p.object_id == one.id)).iou
        for one in scene.instances
    ]
    return float(np.mean(fits))


def main() -> None:
    """Print the headline, the mean IoU, the changes and the CPU time."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("run", type=Path)
    parser.add_argument("capture", type=Path)
    words = parser.parse_args()
    chosen = resume_parameters(words.run, "report", STAGES, Parameters()).parameters
    chosen = replace(chosen, repair=RepairParameters())
    scan = read_registered(prepare_and_open(words.capture, words.run, chosen), words.run)
    scene = read_finished(words.run)
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "RUN"
        cpu_s = 0.0
        for _ in range(2):
            shutil.copytree(words.run, copy, dirs_exist_ok=True)
            begun = time.process_time()
            repair_run(copy, scan, chosen, no_progress)
            cpu_s = time.process_time() - begun
        placements = read_placements(copy / "placements.json")
        after = replace(scene, placements=placements, volume=built_volume(copy, chosen))
        facts = json.loads((copy / REPAIRS).read_text("utf-8"))
    headlines = [compare_with_photos(one, scan)[0] for one in (scene, after)]
    shown = " -> ".join("none" if one is None else f"{one.headline:.3f}" for one in headlines)
    print(
        f"headline {shown}, own photos {facts['headline_before']:.3f} -> "
        f"{facts['headline_after']:.3f}, IoU {mean_iou(scene):.3f} -> {mean_iou(after):.3f}, "
        f"{len(facts['changes'])} of {facts['tried']} exchanged, {cpu_s:.1f} s"
    )
    for row in facts["changes"]:
        before, made = (
            ", ".join(one["template"] for one in row[when]) for when in ("before", "after")
        )
        print(
            f"  object {row['id']} {row['name']}: {before} -> {made}, agreement "
            f"{row['agreement_before']:.2f} -> {row['agreement_after']:.2f}, "
            f"IoU {row['iou_before']:.2f} -> {row['iou_after']:.2f}"
        )


if __name__ == "__main__":
    main()
