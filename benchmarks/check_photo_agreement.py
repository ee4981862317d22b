"""The report's headline for a finished run, as built and with its furniture exchanged on purpose.

    python -m benchmarks.check_photo_agreement RUN CAPTURE [--json FILE]

Each piece of furniture takes the template of the next smaller piece of another class. A headline
that cannot be fooled falls below half.
"""

import argparse
import json
import shutil
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.core.progress import no_progress
from world2minecraft.core.types import Placement
from world2minecraft.evaluation.report.finished_run import read_finished
from world2minecraft.evaluation.report.photo_section import agreement_facts, compare_with_photos
from world2minecraft.formats.objects_and_placements import write_placements
from world2minecraft.reconstruction.file_stages import built_volume
from world2minecraft.reconstruction.opening import prepare_and_open
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.pipeline import STAGES, read_registered
from world2minecraft.reconstruction.resume import resume_parameters


def exchanged(placements: Sequence[Placement]) -> tuple[Placement, ...]:
    """Return the placements with the templates of other classes, in the same places."""
    order = sorted(range(len(placements)), key=lambda n: -float(np.prod(placements[n].size_m)))
    result = list(placements)
    for rank, number in enumerate(order):
        one = placements[number]
        for other in (placements[n] for n in (*order[rank + 1 :], *order[:rank])):
            if other.class_id != one.class_id and other.template != "cells":
                result[number] = replace(one, template=other.template, parameters=other.parameters)
                break
    return tuple(result)


def compare(run: Path, capture: Path) -> dict[str, dict]:
    """Return ``photo_agreement`` of the run as built and with exchanged furniture."""
    chosen = resume_parameters(run, "report", STAGES, Parameters()).parameters
    scan = read_registered(prepare_and_open(capture, run, chosen, None, no_progress), run)
    scene = read_finished(run)
    built = agreement_facts(*compare_with_photos(scene, scan))
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "RUN"
        shutil.copytree(run, copy)
        others = exchanged(scene.placements)
        write_placements(copy / "placements.json", others)
        spoiled = replace(scene, placements=others, volume=built_volume(copy, chosen))
    return {"built": built, "exchanged": agreement_facts(*compare_with_photos(spoiled, scan))}


def main() -> None:
    """Print both headlines, and what fails."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=Path)
    parser.add_argument("capture", type=Path)
    parser.add_argument("--json", type=Path)
    words = parser.parse_args()
    found = compare(words.run, words.capture)
    for name, facts in found.items():
        if facts["headline"] is None:
            print(f"{name:10} not compared: {facts['reason']}")
            continue
        fails = ", ".join(f"{what} {share:.3f}" for what, share in facts["fails"].items())
        objects = facts["objects_right"]
        print(
            f"{name:10} headline {facts['headline']:.3f} +- {facts['standard_error'] or 0:.3f}, "
            f"objects {'none' if objects is None else f'{objects:.3f}'}; {fails}"
        )
    if words.json:
        words.json.write_text(json.dumps(found, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
