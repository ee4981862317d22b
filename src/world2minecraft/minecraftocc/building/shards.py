"""The unit of work: one shard, made of one scene, by whatever process is told to.

What is made depends on the unit alone. Samples that lie in the shard already, from an earlier try,
are kept as they are.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.minecraftocc.building.cpu_clock import StageClock
from world2minecraft.minecraftocc.building.process_registry import of_the_crew
from world2minecraft.minecraftocc.building.studio import studio_of
from world2minecraft.minecraftocc.plan import DatasetPlan, Recipe, SceneSpec
from world2minecraft.minecraftocc.store.folder import read_classes, shard_name
from world2minecraft.minecraftocc.store.index import shard_rows
from world2minecraft.minecraftocc.store.sample_files import pack_sample
from world2minecraft.minecraftocc.store.shard import ShardWriter
from world2minecraft.minecraftocc.store.writer import SHARD_SAMPLES


@dataclass(frozen=True)
class Unit:
    """A shard to make: the views ``first`` to ``last``, the last not included, of a scene."""

    folder: str
    name: str
    spec: SceneSpec
    recipe: Recipe
    first: int
    last: int


def units_of(folder: Path, plan: DatasetPlan) -> list[Unit]:
    """Return the units of a plan, in the order of the data set: split, scene, view."""
    scenes = sorted(plan.scenes, key=lambda scene: list(plan.images).index(scene.split))
    return [
        Unit(
            str(folder),
            shard_name(scene.split, scene.scene_id, number),
            scene,
            plan.recipe,
            first,
            min(first + SHARD_SAMPLES, scene.images),
        )
        for scene in scenes
        for number, first in enumerate(range(0, scene.images, SHARD_SAMPLES))
    ]


@of_the_crew
def make_shard(unit: Unit, tick: Callable[[int], None]) -> tuple[int, dict[str, float]]:
    """Make a shard, or what is missing of it; return how many samples were made, and CPU seconds.

    Raises:
        OutputError: the disk is full. ConflictError: another process writes it, or the scene has
        changed. InputError: the scene cannot be read.
    """
    path, clock, count = Path(unit.folder) / unit.name, StageClock(), unit.last - unit.first
    if path.exists():
        tick(count)
        return 0, {}
    with clock.of("scenes"):
        studio = studio_of(unit.folder, unit.spec, unit.recipe)
        table = read_classes(Path(unit.folder))
    numbers = range(unit.first, unit.last)
    with ShardWriter(path, [studio.key(number) for number in numbers]) as shard:
        found = shard.done
        tick(found)
        for number in numbers[found:]:
            sample = studio.sample(number, clock)
            with clock.of("encode"):
                members = pack_sample(sample, table, unit.recipe.files)
            with clock.of("write"):
                shard.append(members)
            tick(1)
        with clock.of("write"):
            shard.finish()
    return count - found, dict(clock.seconds)


def index_shard(unit: Unit, tick: Callable[[int], None]) -> tuple[list[dict[str, Any]], float]:
    """Return the index rows of a finished shard, and CPU seconds."""
    clock = StageClock()
    with clock.of("write"):
        rows = shard_rows(Path(unit.folder) / unit.name, unit.name)
    tick(len(rows))
    return rows, clock.seconds["write"]


def in_order(results: Iterator[tuple[int, Any]]) -> Iterator[Any]:
    """Give results by their numbers, though they come as they are done."""
    held: dict[int, Any] = {}
    following = 0
    for number, result in results:
        held[number] = result
        while following in held:
            yield held.pop(following)
            following += 1
