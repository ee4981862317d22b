"""Build or resume a complete data set from its plan.

A build surveys the scenes, allocates images to them, renders the shards and writes the index. Each
scene gets an equal share of the images. If a scene has too few views, its missing images are
allocated to scenes that still have views. The allocation depends only on the number of views found,
so an interrupted build produces the same data set when it is resumed. Only one process can build in
a folder at a time.
"""

import json
import shutil
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import ConflictError, UsageError
from world2minecraft.core.files import write_json
from world2minecraft.core.output_folders import output_folder
from world2minecraft.core.precompile import compile_kernels
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.minecraftocc.building.cpu_clock import (
    STAGES,
    milliseconds_per_image,
)
from world2minecraft.minecraftocc.building.process_registry import remove_registry, wait_for_others
from world2minecraft.minecraftocc.building.scene_survey import SceneFacts, SceneTask, survey_scene
from world2minecraft.minecraftocc.building.shard_rendering import (
    in_order,
    index_shard,
    render_shard,
    shard_tasks,
)
from world2minecraft.minecraftocc.engine import Engine
from world2minecraft.minecraftocc.plan import DatasetPlan, SceneSpec
from world2minecraft.minecraftocc.store.folder import (
    CLASSES,
    DATASET,
    INDEX,
    KIND,
    META,
    SHARDS,
    SPLITS,
    leftovers,
    read_meta,
    write_classes,
)
from world2minecraft.minecraftocc.store.index import arrow_modules
from world2minecraft.minecraftocc.store.sample_files import FORMAT, FineTable
from world2minecraft.minecraftocc.store.shard import PART
from world2minecraft.minecraftocc.store.writer import ShardContents, finish_store
from world2minecraft.minecraftocc.types import FineClass

MAX_ROUNDS = 6
CountViews = Callable[[list[SceneSpec]], Iterable[int]]  # Returns the views of each scene.
EMPTY = FineClass("minecraft:air")


def allocate_views(scenes: Iterable[SceneSpec], look: CountViews) -> list[SceneSpec]:
    """Allocate images to scenes according to the number of views that each scene has.

    Args:
        scenes: Scenes of any splits, each with its requested number of images.
        look: Function that surveys scenes and returns the number of views found in each of them.

    Returns:
        The scenes in their original order with their allocated numbers of images. Each split has
        the requested total, or fewer images if its scenes do not have enough views.
    """
    requested = {scene.scene_id: scene for scene in scenes}
    wanted = {scene.split: 0 for scene in requested.values()}
    for scene in requested.values():
        wanted[scene.split] += scene.images
    found: dict[str, int] = {}
    todo = list(requested.values())
    for _ in range(MAX_ROUNDS):
        views = look(todo)
        found |= {scene.scene_id: got for scene, got in zip(todo, views, strict=True)}
        todo = [
            one
            for split, count in wanted.items()
            for one in _further_requests(requested, found, split, count)
        ]
        requested |= {scene.scene_id: scene for scene in todo}
        if not todo:
            break
    return [replace(scene, images=found[scene.scene_id]) for scene in requested.values()]


def _further_requests(
    requested: dict[str, SceneSpec], found: dict[str, int], split: str, wanted: int
) -> list[SceneSpec]:
    """Return the scenes of a split that may have more views, with their next requested numbers."""
    mine = [scene for scene in requested.values() if scene.split == split]
    short = wanted - sum(found[scene.scene_id] for scene in mine)
    rich = [scene for scene in mine if found[scene.scene_id] >= scene.images]
    if short <= 0 or not rich:
        return []
    each, more = divmod(short, len(rich))
    return [
        replace(scene, images=scene.images + each + (number < more))
        for number, scene in enumerate(rich)
        if each + (number < more)
    ]


@dataclass(frozen=True)
class BuildReport:
    """The outcome of a build: the images in each split, the work done and the time spent.

    Attributes:
        images: Number of images in each split.
        made: Number of images rendered by this run.
        shards: Number of shards in the data set.
        sha256: SHA-256 of all samples of the data set.
        seconds: Elapsed time of this run in seconds.
        cpu_seconds: CPU seconds for each stage.
        notes: Remarks for the user, such as a shortage of views.
        milliseconds: CPU milliseconds per image for each stage and in total.
    """

    images: dict[str, int]
    made: int
    shards: int
    sha256: str
    seconds: float
    cpu_seconds: dict[str, float]
    notes: tuple[str, ...] = ()
    milliseconds: dict[str, float] = field(default_factory=dict)


def build_dataset(
    folder: str | Path,
    plan: DatasetPlan,
    engine: Engine,
    progress: Progress = no_progress,
    force: bool = False,
) -> BuildReport:
    """Build a data set, or complete one whose build was interrupted.

    Args:
        folder: Output folder. If it contains an unfinished build of the same plan, the build is
            resumed.
        plan: Scenes, numbers of images and settings of the data set.
        engine: Engine that runs the tasks, such as a process pool.
        progress: Callback that reports progress on scenes, images and the index.
        force: Whether to write into a folder that contains other files.

    Raises:
        ConflictError: If the folder contains another data set, or if another process is building
            there.
        UsageError: If the scenes have too few views for a preset, or if the folder contains other
            files without ``force``.
        OutputError: If the disk is full.
        InputError: If a scene cannot be read.
        WorkerError: If worker processes exit repeatedly.
    """
    root, began = Path(folder), time.monotonic()
    arrow_modules()
    with output_folder(root, DATASET, "built", force=force):
        wait_for_others(root)
        begin_dataset(root, plan)
        remove_leftovers(root)
        report = _finished_report(root) or complete_dataset(root, plan, engine, progress)
        remove_registry(root)
    return replace(report, seconds=time.monotonic() - began)


def complete_dataset(
    folder: Path, plan: DatasetPlan, engine: Engine, progress: Progress = no_progress
) -> BuildReport:
    """Make the files that a folder lacks of the data set of a plan. The caller holds its lock.

    Raises:
        World2MinecraftError: As ``build_dataset``.
    """
    return _Build(folder, plan, engine, progress).run()


def begin_dataset(folder: Path, plan: DatasetPlan) -> None:
    """Write the plan to the folder, or check that the folder was created with the same plan.

    Raises:
        ConflictError: If the folder contains a different data set.
    """
    facts = plan.facts()
    if not (folder / META).exists():
        if (folder / SHARDS).exists():
            raise ConflictError(
                folder, "contains shards but no dataset.json; choose another folder"
            )
        write_json(
            folder / META, {"kind": KIND, "format": FORMAT, "complete": False, "plan": facts}
        )
        return
    before = read_meta(folder, finished=False).get("plan")
    if not isinstance(before, dict):
        raise ConflictError(
            folder, "contains a data set without a build plan; choose another folder"
        )
    wrong = _differences(before, facts)
    if wrong:
        raise ConflictError(
            folder,
            f"contains a data set with a different {', '.join(wrong)}; choose another folder",
        )


def remove_leftovers(folder: Path) -> None:
    """Delete temporary files of an interrupted build, except for unfinished shards."""
    for name in leftovers(folder):
        path = folder / name
        shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)
    for path in (folder / SHARDS).glob(f"*/*{PART}"):
        if path.with_name(path.name.removesuffix(PART)).exists():
            path.unlink(missing_ok=True)


def _finished_report(folder: Path) -> BuildReport | None:
    """Return the report of a complete data set, or None. The contents of files are not checked."""
    meta = read_meta(folder, finished=False)
    shards = meta.get("shards") if meta.get("complete") else None
    if not shards or not all((folder / name).is_file() for name in (*shards, INDEX, CLASSES)):
        return None
    images = {split: meta["images"][split] for split in SPLITS if split in meta["images"]}
    return BuildReport(images, 0, len(shards), str(meta["sha256"]), 0.0, {})


@dataclass(eq=False)
class _Build:
    """A build in progress."""

    folder: Path
    plan: DatasetPlan
    engine: Engine
    progress: Progress
    cpu: dict[str, float] = field(default_factory=lambda: dict.fromkeys(STAGES, 0.0))
    notes: list[str] = field(default_factory=list)

    def run(self) -> BuildReport:
        """Survey the scenes, render the shards and write the index."""
        facts: dict[str, SceneFacts] = {}
        compile_kernels("dataset", self.progress)
        scenes = self._settled(allocate_views(self.plan.scenes, partial(self._look, facts)))
        _refuse_duplicate_worlds(scenes, facts)
        plan = replace(self.plan, scenes=scenes)
        classes = {one for fact in facts.values() for one in fact.fine} - {EMPTY}
        write_classes(self.folder, FineTable((EMPTY, *sorted(classes))))
        units, total = shard_tasks(self.folder, plan), sum(plan.images.values())
        made = 0
        tick = self._ticker("images", total)
        for _, (count, seconds) in self.engine.run(render_shard, units, tick):
            made += count
            for stage, value in seconds.items():
                self.cpu[stage] += value
        meta = {
            "images": plan.images,
            "scenes": [_scene_json(scene, facts[scene.scene_id]) for scene in scenes],
            "plan": self.plan.facts(),
        }
        found = in_order(self.engine.run(index_shard, units, self._ticker("index", total)))
        whole = finish_store(
            self.folder, [unit.name for unit in units], meta, (self._counted(one) for one in found)
        )
        return BuildReport(
            images=plan.images,
            made=made,
            shards=len(units),
            sha256=whole["sha256"],
            seconds=0.0,
            cpu_seconds=dict(self.cpu),
            notes=(*self.notes, *self.engine.notes),
            milliseconds=milliseconds_per_image(self.cpu, made),
        )

    def _look(self, facts: dict[str, SceneFacts], scenes: list[SceneSpec]) -> list[int]:
        """Survey scenes and return the number of views found in each of them."""
        tasks = [SceneTask(str(self.folder), scene, self.plan.recipe) for scene in scenes]
        found = [0] * len(tasks)
        for number, (fact, seconds) in self.engine.run(
            survey_scene, tasks, self._ticker("scenes", len(tasks))
        ):
            facts[fact.scene_id] = fact
            found[number] = fact.found(scenes[number].images) or 0
            self.cpu["scenes"] += seconds
        return found

    def _settled(self, scenes: list[SceneSpec]) -> tuple[SceneSpec, ...]:
        """Remove scenes without views, and check that there are enough views.

        Raises:
            UsageError: If there are too few views for a preset, or none.
        """
        for split, wanted in self.plan.images.items():
            found = sum(scene.images for scene in scenes if scene.split == split)
            if found < wanted:
                shortage = (
                    f"the {split} scenes have only {found:,} usable views for {wanted:,} images; "
                    "add more scenes"
                )
                if self.plan.preset:
                    raise UsageError(shortage)
                self.notes.append(f"{shortage[0].upper()}{shortage[1:]}.")
        if not any(scene.images for scene in scenes):
            raise UsageError("the scenes have no usable views; choose other scenes")
        return tuple(scene for scene in scenes if scene.images)

    def _ticker(self, stage: str, total: int) -> Callable[[int], None]:
        """Return a function that counts finished images and reports progress and speed."""
        done, began, first = 0, time.monotonic(), 0
        self.progress(stage, 0, total)

        def tick(count: int) -> None:
            """Report the samples completed so far and their rate."""
            nonlocal done, first
            if done == 0 and count > 1:
                first = count  # Samples of an earlier run, which took no time.
            done += count
            seconds = time.monotonic() - began
            rate = (done - first) / seconds if seconds > 0 else 0.0
            self.progress(stage, done, total, f"{rate:.1f} per second" if rate else "")

        return tick

    def _counted(self, result: tuple[ShardContents, float]) -> ShardContents:
        contents, seconds = result
        self.cpu["write"] += seconds
        return contents


def _refuse_duplicate_worlds(scenes: Sequence[SceneSpec], facts: Mapping[str, SceneFacts]) -> None:
    """Check that no world is used for both training and testing under two names.

    Raises:
        UsageError: If a world is used in both splits.
    """
    first: dict[str, SceneSpec] = {}
    for scene in scenes:
        twin = first.setdefault(facts[scene.scene_id].digest, scene)
        if twin.split != scene.split:
            raise UsageError(
                f"{twin.path} (for {twin.split}) and {scene.path} (for {scene.split}) contain "
                "identical blocks; remove one of them"
            )


def _differences(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Return the names of the settings in which two plans differ."""
    old, new = before.get("recipe", {}), now["recipe"]
    wrong = [key for key in new if old.get(key) != _as_json(new[key])]
    if before.get("scenes") != _as_json(now["scenes"]):
        wrong.append("set of scenes or number of images")
    return wrong


def _as_json(value: Any) -> Any:
    """Return a value as it would be read back from JSON."""
    return json.loads(json.dumps(value))


def _scene_json(scene: SceneSpec, facts: SceneFacts) -> dict[str, Any]:
    return {
        "scene_id": scene.scene_id,
        "source": scene.path,
        "split": scene.split,
        "images": scene.images,
        "blocks": list(facts.blocks),
        "metres_per_block": facts.metres_per_block,
        "digest": facts.digest,
    }
