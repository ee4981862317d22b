"""Fine names of the objects of generated rooms of eight kinds, scanned with noise.

``python -m benchmarks.check_names --keep DIR [--seeds 2] [--kinds bathroom ...]
[--furnishing full] [--labels] [--json FILE]``

Each room is scanned without label images and reconstructed with the votes of the segmentation
network; with ``--labels``, it is scanned with images of names, a tenth of whose patches are wrong.
Printed are, for each room, precision, recall and F1 of the names;
then the means, the calibration error of the names, and for
bathrooms and kitchens how often toilet, basin and bath or shower, and oven or stove, sink and
refrigerator are built as such. Finished rooms are not repeated.
"""

import argparse
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.train_names import calibration_error
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.vocabulary import read_vocabulary
from world2minecraft.evaluation.metrics.objects import match_objects
from world2minecraft.evaluation.scoring.object_scores import GENERIC_NAMES, name_facts
from world2minecraft.evaluation.scoring.score import see_truth
from world2minecraft.evaluation.scoring.used_frames import truth_of_run, used_frames
from world2minecraft.formats.objects_and_placements import read_objects, read_placements
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.procgen import generate_room, scan_room
from world2minecraft.procgen.rooms.full_furnishing import FURNISHINGS
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.pipeline import reconstruct

FIRST_SEED, OBJS = 8_700, 11
LABEL_ERROR = 0.1
ROOMS = ("bathroom", "kitchen", "bed", "study", "living", "dining", "children", "hall")
FITTINGS = {
    "bathroom": (("toilet",), ("washbasin", "sink"), ("bathtub", "shower")),
    "kitchen": (("oven", "stove"), ("sink", "washbasin"), ("refrigerator",)),
}


def scored(folder: Path, kind: str, seed: int, furnishing: str, labels: bool) -> dict[str, Any]:
    """Scan and reconstruct a room if that was not done before, and return its figures."""
    capture, out, facts = folder / "capture", folder / "run", folder / "facts.json"
    if not (capture / "truth.json").is_file():
        room = generate_room(seed, kind=kind, clutter=0.4, furnishing=furnishing)
        shown = {"with_labels": labels, "label_error": LABEL_ERROR * labels, "label_names": labels}
        scan_room(room, capture, seed=seed, **shown)
    if not facts.is_file():
        reconstruct(capture, out, Parameters())
        write_json(facts, _figures(out, capture))
    return {"kind": kind, "seed": seed, **read_json(facts)}


def _figures(out: Path, capture: Path) -> dict[str, Any]:
    """Return the scores, each name's confidence and whether it is right, and what was built."""
    vocabulary = read_vocabulary()
    known = truth_of_run(out, capture)
    grid, scan_to_room = read_room(out / "room.npz")
    room = see_truth(known, used_frames(out, known), scan_to_room, grid.voxel_m)
    objects = read_objects(out / "objects.json", grid)
    places = [replace(item, class_id=OBJS) for item in objects]
    true_places = [replace(item, class_id=OBJS) for item in room.objects.objects]
    sure = []
    for found, wanted in match_objects(places, true_places):
        entry = vocabulary.find(true_places[wanted].name.replace("_", " "))
        name = objects[found].name
        if entry is not None and name in vocabulary.names and name not in GENERIC_NAMES:
            sure.append([objects[found].name_confidence, float(name == entry.name)])
    placed: dict[int, set[str]] = {}
    for one in read_placements(out / "placements.json"):
        placed.setdefault(one.object_id, set()).add(one.template)
    built = {
        name
        for name, entry in vocabulary.names.items()
        if any(templates & set(entry.templates) for templates in placed.values())
    }
    asked = []
    for found, wanted in match_objects(places, true_places):
        entry = vocabulary.find(true_places[wanted].name.replace("_", " "))
        if entry is not None and entry.templates:
            asked.append(bool(placed.get(objects[found].id, set()) & set(entry.templates)))
    return name_facts(objects, room.objects) | {
        "sure": sure,
        "built": sorted(built),
        "built_right": sum(asked),
        "built_asked": len(asked),
    }


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--keep", type=Path, required=True, metavar="DIR")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--kinds", nargs="+", default=list(ROOMS), choices=ROOMS)
    parser.add_argument("--furnishing", default="basic", choices=FURNISHINGS)
    parser.add_argument("--labels", action="store_true", help="scan with images of names")
    parser.add_argument("--json", type=Path)
    chosen = parser.parse_args()
    rows = []
    for kind in chosen.kinds:
        for seed in range(FIRST_SEED, FIRST_SEED + chosen.seeds):
            mark = "" if chosen.furnishing == "basic" else f"-{chosen.furnishing}"
            folder = chosen.keep / f"{kind}-{seed}{mark}"
            row = scored(folder, kind, seed, chosen.furnishing, chosen.labels)
            rows.append(row)
            figures = " ".join(f"{row[name]:.3f}" for name in ("precision", "recall", "f1"))
            print(f"{kind} {seed}: {figures}, {row['matched']} of {row['true']}", flush=True)
    for name in ("precision", "recall", "f1"):
        print(f"{name} {np.mean([row[name] for row in rows]):.3f}")
    right, wanted = (sum(row[name] for row in rows) for name in ("built_right", "built_asked"))
    print(f"furniture of the right name {right} of {wanted} ({right / max(wanted, 1):.3f})")
    sure = np.array([pair for row in rows for pair in row["sure"]]).reshape(-1, 2)
    if len(sure):
        print(f"calibration error {calibration_error(sure[:, 0], sure[:, 1] > 0):.3f}")
    for kind, fittings in FITTINGS.items():
        mine = [row for row in rows if row["kind"] == kind]
        for names in fittings:
            built = sum(any(name in row["built"] for name in names) for row in mine)
            print(f"{kind}: {' or '.join(names)} built in {built} of {len(mine)}")
    if chosen.json:
        write_json(chosen.json, rows)


if __name__ == "__main__":
    main()
