"""Layout scores of other methods and of our runs by the same rules.

``python -m benchmarks.check_layouts [--layoutgpt FILE] [--runs DIR] [--json FILE]``

``--layoutgpt`` scores LayoutGPT's published layouts and compares them with an independent
reading, by the rule of its script at 7.3 pixels and with boxes rotated as the script does:
bedrooms 0.138 (object OOB), 0.511 (scenes) and 1.57 (overlapping pairs per scene), living rooms
0.203, 0.660 and 4.13. ``--runs`` scores finished trials of ``python -m benchmarks.check_faithful
--keep DIR`` against their true rooms. The exit code is 1 if a figure of LayoutGPT is not
reproduced or a target of ours is missed.
"""

import argparse
import sys
import time
from dataclasses import replace
from pathlib import Path

from world2minecraft.core.files import write_json
from world2minecraft.navigation.running.result_tables import format_markdown, format_text
from world2minecraft.paper.layouts import ComparedScene, score_scene, summary_of
from world2minecraft.paper.layouts.importers import How, read_layouts_of
from world2minecraft.paper.layouts.reference_scene import true_scene
from world2minecraft.paper.layouts.score_table import NOTES, layout_table, other_table

EXPECTED = {  # By what the published file's name says.
    "bedroom": {"reaching_out": 0.138, "scenes_reaching_out": 0.511, "overlaps": 1.57},
    "livingroom": {"reaching_out": 0.203, "scenes_reaching_out": 0.660, "overlaps": 4.13},
}
PLACES = {"reaching_out": 3, "scenes_reaching_out": 3, "overlaps": 2}
LEAST_INTEGRITY = 0.95
WAYS = {"labels": "ours, with label images", "none": "ours, geometry alone"}


def main(words: list[str]) -> int:
    """Print the tables and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--layoutgpt", type=Path)
    parser.add_argument("--runs", type=Path)
    parser.add_argument("--clean", action="store_true", help="the clean trials, too")
    parser.add_argument("--markdown", action="store_true")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    options = parser.parse_args(words)
    told, missed = {}, 0
    if options.layoutgpt:
        scenes = read_layouts_of(options.layoutgpt)
        began = time.perf_counter()
        told["LayoutGPT"] = summary_of([score_scene(one) for one in scenes])
        taken_ms = 1000 * (time.perf_counter() - began) / len(scenes)
        print(f"{len(scenes)} layouts of LayoutGPT, {taken_ms:.0f} ms each")
        missed += check_layoutgpt(options.layoutgpt.name, scenes)
    if options.runs:
        found = runs_by_way(options.runs, options.clean)
        told |= found
        missed += sum(check_ours(name, row) for name, row in found.items())
    if not told:
        parser.error("give --layoutgpt FILE or --runs DIR")
    if options.json:
        write_json(options.json, told)
    write = format_markdown if options.markdown else format_text
    print(write(layout_table(told)), write(other_table(told)), "\n".join(NOTES), sep="\n\n")
    return int(missed > 0)


def turned_as_its_script(scene: ComparedScene) -> ComparedScene:
    """Turn boxes the other way, as LayoutGPT's script does and its renderer does not."""
    objects = [replace(item, yaw_deg=-item.yaw_deg - 180) for item in scene.objects]  # type: ignore[call-arg]
    return replace(scene, objects=tuple(objects))


def check_layoutgpt(file: str, scenes: list[ComparedScene]) -> int:
    """Print the figures by the rule of LayoutGPT's script, and return how many are missed."""
    expected = next((told for room, told in EXPECTED.items() if room in file), None)
    if expected is None:
        print(f"{file}: nothing is expected of it, whose name has no {' or '.join(EXPECTED)}")
        return 0
    found = summary_of([score_scene(turned_as_its_script(one)) for one in scenes])
    missed = 0
    for name, wanted in expected.items():
        met = round(found[name], PLACES[name]) == wanted
        missed += not met
        print(f"{name}: {found[name]:.4f}, expected {wanted}: {'met' if met else 'MISSED'}")
    return missed


def runs_by_way(folder: Path, clean: bool) -> dict[str, dict]:
    """Return the summary of kept trials, by what they were labelled from."""
    told = {}
    trials = [one for one in sorted(folder.iterdir()) if (one / "capture").is_dir()]
    trials = [one for one in trials if clean or not one.name.endswith("-clean")]
    for way, name in WAYS.items():
        done = [one for one in trials if (one / way / "placements.json").is_file()]
        if done:
            scores, true = zip(*(scored(one, way) for one in done), strict=True)
            told[name] = summary_of(scores, true)
    return told


def scored(trial: Path, way: str):
    """Return the scores of a run and of its truth."""
    (scene,) = read_layouts_of(trial / way, How(truth=trial / "capture"))
    return score_scene(scene), score_scene(true_scene(trial / "capture"))


def check_ours(name: str, told: dict) -> int:
    """Print which aims a row of ours misses, and return how many."""
    aims = {
        "out of bounds 0": told["out_of_bounds"] == 0,
        "solid collisions 0": told["solid_collisions"] == 0,
        f"semantic integrity {LEAST_INTEGRITY}": told["semantic_integrity"] >= LEAST_INTEGRITY,
    }
    missed = [aim for aim, met in aims.items() if not met]
    print(f"{name}: {'all aims met' if not missed else 'missed: ' + ', '.join(missed)}")
    return len(missed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
