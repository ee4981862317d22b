"""Throughput of data set generation.

``python -m benchmarks.check_dataset_build [--only NAME] [--json FILE]``

- ``small``: 2,000 images of 640x480 of 40 generated houses, on all cores.
- ``large``: a slice at the paper's 1920x1129, extrapolated to its 100,165 images.
- ``labels``: the same slice, labels and masks only.
- ``views``: worlds and views only, house by house in one process; runs only if named.

CPU times are sums over all processes, by stage; hours are for two cores. Houses and views of the
large slices are listed separately, since the paper's sets have many more images per house.
"""

import argparse
import resource
import tempfile
from dataclasses import replace
from pathlib import Path

from world2minecraft.core.files import write_json
from world2minecraft.core.machine import usable_cores
from world2minecraft.minecraftocc.building import TITLES, BuildReport, build_dataset
from world2minecraft.minecraftocc.building.scene_survey import SceneTask, survey_scene
from world2minecraft.minecraftocc.engine import open_engine
from world2minecraft.minecraftocc.plan import Recipe, house_scenes, plan_dataset
from world2minecraft.minecraftocc.tours import paper_camera

PAPER_IMAGES = 100_165
BUDGET_MS = {"render": 120, "encode": 65, "labels": 60}
BUDGET_ALL_MS, BUDGET_MINUTES = 285, 10
CASES = ("small", "large", "labels")
VIEWS = "views"


def built(folder: Path, houses: int, images: int, recipe: Recipe, jobs: int) -> BuildReport:
    plan = plan_dataset(house_scenes(houses), images, recipe=recipe)
    with open_engine("pool", jobs) as engine:
        return build_dataset(folder, plan, engine)


def told(title: str, report: BuildReport, images: int) -> dict[str, float]:
    """Print and return CPU milliseconds an image by stage, and hours of two cores for so many."""
    each = report.milliseconds
    print(f"{title}: {report.made:,} images in {report.seconds:.0f} s")
    for stage, name in TITLES.items():
        budget = f"   budget {BUDGET_MS[stage]}" if stage in BUDGET_MS else ""
        print(f"  {name:18} {each[stage]:7.1f} ms{budget}")
    hours = each["all"] * images / 1000 / 3600 / 2
    print(f"  {'all':18} {each['all']:7.1f} ms: {images:,} images in {hours:.2f} h on two cores")
    return {**each, "seconds": report.seconds, "hours": hours}


def looked_at(folder: Path, houses: int, images: int) -> None:
    """Print CPU milliseconds of houses and their views; the first one waits for tables, too."""
    plan, spent = plan_dataset(house_scenes(houses), images, recipe=Recipe()), []
    folder.mkdir()
    for scene in plan.scenes:
        facts, seconds = survey_scene(
            SceneTask(str(folder), scene, plan.recipe), lambda count: None
        )
        spent.append(1000 * seconds)
        print(f"{scene.scene_id}: {facts.views} views, {spent[-1]:.0f} ms, {facts.digest[:12]}")
    if houses > 1:
        views = sum(scene.images for scene in plan.scenes[1:])
        print(f"without the first house: {sum(spent[1:]) / views:.1f} ms a view")


def peak_mb() -> float:
    """Return the most that a process of this run has had, in MB."""
    most = (resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, -1))
    return max(most) / 1024


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    options.add_argument("--only", choices=(*CASES, VIEWS), action="append")
    options.add_argument("--images", type=int, default=2000, help="of small and views")
    options.add_argument("--houses", type=int, default=40, help="of small and views")
    options.add_argument("--slice", type=int, default=120, help="images of the large cases")
    options.add_argument("--jobs", type=int, default=usable_cores())
    options.add_argument("--json", type=Path, help="write the figures to this file")
    words = options.parse_args()
    cases, is_late, kept = words.only or list(CASES), False, {}
    large = Recipe(camera=paper_camera())
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        if VIEWS in cases:
            looked_at(folder / VIEWS, words.houses, words.images)
        if "small" in cases:
            report = built(folder / "small", words.houses, words.images, Recipe(), words.jobs)
            kept["small"] = told("640x480", report, words.images)
            size = sum(path.stat().st_size for path in (folder / "small").rglob("*.tar"))
            print(f"  {size / words.images / 1e3:.0f} kB an image, {peak_mb():.0f} MB a process")
            is_late = report.seconds > 60 * BUDGET_MINUTES
        if "large" in cases:
            report = built(folder / "large", 1, words.slice, large, words.jobs)
            kept["large"] = told("1920x1129", report, PAPER_IMAGES)
            size = sum(path.stat().st_size for path in (folder / "large").rglob("*.tar"))
            print(f"  {size / words.slice / 1e3:.0f} kB an image, {peak_mb():.0f} MB a process")
            is_late |= report.milliseconds["all"] > BUDGET_ALL_MS
        if "labels" in cases:
            bare = replace(large, pictures=False)
            report = built(folder / "labels", 1, words.slice, bare, words.jobs)
            kept["labels"] = told("1920x1129, labels alone", report, PAPER_IMAGES)
    if words.json:
        write_json(words.json, kept)
    return 1 if is_late else 0


if __name__ == "__main__":
    raise SystemExit(main())
