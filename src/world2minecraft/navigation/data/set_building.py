"""Building of a navigation set from several scenes.

The output folder contains::

    OUT/dataset.json      the scenes and options of the set
    OUT/items.jsonl       questions
    OUT/trajectories.jsonl, OUT/episodes.jsonl
    OUT/README.md         the card for Hugging Face
    OUT/checksums.json    the size and SHA-256 of every file
    OUT/images/SCENE/TRAJECTORY/NNN.jpg

The result does not depend on the number of worker processes: the random seeds derive from the names
of the scenes, and results are kept in the order in which the scenes were given.
"""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

from world2minecraft import __version__
from world2minecraft.core.checksums import CHECKSUMS
from world2minecraft.core.errors import UsageError
from world2minecraft.core.files import write_json
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.minecraftocc.engine import open_engine
from world2minecraft.minecraftocc.scene_sources import scene_id_of
from world2minecraft.navigation.data.item_building import (
    COMPOSITIONS,
    PAPER_WALKS,
    build_items,
    cut_to_paper_size,
)
from world2minecraft.navigation.data.recorded_walks import At, assign_streams, recorded_tours
from world2minecraft.navigation.data.rewording import annotate_set
from world2minecraft.navigation.data.scene_items import (
    WALK_VERSION,
    SceneItems,
    SceneRule,
    WalkCallback,
    build_scene_items,
)
from world2minecraft.navigation.data.set_files import finish_set
from world2minecraft.navigation.data.splits import (
    UNSEEN_SHARE,
    Leaks,
    find_leaks,
    paper_splits,
    scene_splits,
    seen_splits,
    without_shared_pictures,
)
from world2minecraft.navigation.records import (
    ABOUT,
    EPISODES,
    ITEMS,
    TRAJECTORIES,
    write_episodes,
    write_items,
    write_trajectories,
)
from world2minecraft.navigation.scene import open_scene
from world2minecraft.navigation.types import Item, Trajectory

WALKS_PER_SCENE = {"base": 30, "extend": 110}  # Trajectories for a set of the paper's size.
RECONSTRUCTED = ("room.npz", "placements.json")  # Files of a run folder.


@dataclass(frozen=True)
class SceneJob:
    """A scene to process for a set.

    Attributes:
        path: The path of the scene.
        folder: The folder of the set.
        composition: "base" or "extend".
        split: "train" or "val_unseen".
        rule: The options.
        streams: Files with walks that were recorded in the scene.
        at: Whether recorded positions are feet or eye positions if the lines do not state it.
    """

    path: str
    folder: str
    composition: str
    split: str
    rule: SceneRule
    streams: tuple[str, ...] = ()
    at: At = "eye"


def run_scene_jobs(
    jobs: Sequence[SceneJob], workers: int = 1, progress: Progress = no_progress
) -> list[SceneItems]:
    """Process scenes, the largest ones first, and return the results in the order of the jobs.

    Args:
        jobs: The scenes to process.
        workers: The number of processes. With 1, the current process does the work.
        progress: Called after each walk.

    Raises:
        InputError: If a scene cannot be read.
        OutputError: If the folder cannot be written.
        WorkerError: If a worker process keeps failing.
        UsageError: If the number of workers is out of range.
    """
    first = sorted(range(len(jobs)), key=lambda n: (-jobs[n].rule.trajectories, n))
    wanted = sum(job.rule.trajectories for job in jobs)
    walks, works = _WalkCounter(wanted, len(jobs), progress), dict[int, SceneItems]()
    with open_engine("pool", min(workers, len(jobs))) as engine:
        for place, work in engine.run(_run_job, [jobs[n] for n in first], walks.add):
            works[first[place]] = work
            own = jobs[first[place]].rule.trajectories
            walks.scene_done(work.scene_id, len(work.trajectories), own)
    return [works[n] for n in range(len(jobs))]


def _run_job(job: SceneJob, tick: WalkCallback) -> SceneItems:
    """Process one scene in a worker process."""
    scene = open_scene(job.path)
    recorded = recorded_tours(scene, job.streams, job.at)
    return build_scene_items(
        scene, Path(job.folder), job.composition, job.split, job.rule, tick, recorded
    )


class _WalkCounter:
    """A progress counter of walks, which counts missing walks when their scene is finished."""

    def __init__(self, wanted: int, scenes: int, progress: Progress):
        self._done, self._wanted, self._left = 0, wanted, scenes
        self._told = partial(progress, "walks")
        self._told(0, wanted)

    def add(self, count: int) -> None:
        """Count walks. The last one is reported when its scene is finished."""
        self._done = min(self._done + count, self._wanted - 1)
        self._told(self._done, self._wanted)

    def scene_done(self, name: str, given: int, requested: int) -> None:
        """Count the walks that a finished scene could not provide."""
        self._left -= 1
        self.add(max(0, requested - given))
        done = self._done if self._left else self._wanted
        self._told(done, self._wanted, f"{name}: {given} walks")


@dataclass(frozen=True)
class BuildRule:
    """The options for building a set.

    Attributes:
        composition: "base" for reconstructed rooms, "extend" for other worlds, or "combined".
        trajectories: The number of trajectories per scene. None uses ``WALKS_PER_SCENE``.
        paper_size: Whether to reduce the set to the paper's number of items.
        paper_split: Whether to hold out walks of the same scenes, as the paper does.
        unseen_share: The share of scenes to hold out otherwise.
        streams: Files with recorded walks. Scenes with recorded walks use only those.
        at: Whether recorded positions are feet or eye positions if the lines do not state it.
        rooms: The number of rooms that were generated for the set.
        houses: The number of houses that were generated for the set.
        work: The options for each scene.
    """

    composition: str = "combined"
    trajectories: int | None = None
    paper_size: bool = False
    paper_split: bool = False
    unseen_share: float = UNSEEN_SHARE
    streams: tuple[str, ...] = ()
    at: At = "eye"
    rooms: int = 0
    houses: int = 0
    work: SceneRule = field(default_factory=SceneRule)

    def __post_init__(self):
        if self.composition not in COMPOSITIONS:
            raise UsageError(
                f"composition must be base, extend or combined, got {self.composition!r}"
            )
        if self.trajectories is not None and self.trajectories < 1:
            raise UsageError(f"trajectories must be 1 or more, got {self.trajectories}")
        if self.paper_split and self.unseen_share not in (0, UNSEEN_SHARE):
            raise UsageError(
                "the paper's split does not hold out any scenes; omit the unseen share "
                "(--unseen-share)"
            )

    def walks_of(self, kinds: Mapping[str, str]) -> dict[str, int]:
        """Return the number of walks to request from each scene.

        Args:
            kinds: The composition of each scene by its name.
        """
        scenes = Counter(kinds.values())
        share = {kind: -(-PAPER_WALKS[kind] // scenes[kind]) for kind in scenes}
        usual = share if self.paper_size else WALKS_PER_SCENE
        return {name: self.trajectories or usual[kind] for name, kind in kinds.items()}


@dataclass(frozen=True)
class BuiltSet:
    """The result of building a set.

    Attributes:
        items: The questions.
        works: The results by scene.
        leaks: The overlap between training and held-out items.
        left_out: The scenes that do not belong to the requested composition.
    """

    items: list[Item]
    works: list[SceneItems]
    leaks: Leaks
    left_out: list[str]


def composition_of(path: str | Path) -> str:
    """Return "base" for the folder of a reconstruction run, and "extend" for any other world."""
    folder = Path(path)
    places = (folder, folder.parent, folder.parent.parent)
    found = any(all((place / name).is_file() for name in RECONSTRUCTED) for place in places)
    return "base" if found else "extend"


def build_navigation_set(
    paths: Sequence[str | Path],
    out: str | Path,
    rule: BuildRule | None = None,
    progress: Progress = no_progress,
    workers: int = 1,
    *,
    annotations: str | Path | None = None,
    home: Path | None = None,
    recorded: Mapping[str, str] | None = None,
) -> BuiltSet:
    """Build a navigation set from scenes.

    Args:
        paths: The scenes, as accepted by ``open_scene``.
        out: The output folder. The same options and seed give identical files.
        rule: The options. None uses the defaults.
        progress: Called after each walk.
        workers: The number of processes, which does not affect the result.
        annotations: File with instructions written by people, which items then use.
        home: The folder that the set will be moved to, with the scenes that were generated for it.
            None means ``out``.
        recorded: The paths to record for scenes, if other than those given.

    Raises:
        UsageError: If no scene has the composition, two scenes have the same name, or no items
            result.
        InputError: If a scene cannot be read.
        OutputError: If the folder cannot be written.
    """
    how = rule or BuildRule()
    kinds = {str(path): composition_of(path) for path in paths}
    wanted = {path: kind for path, kind in kinds.items() if how.composition in ("combined", kind)}
    if not wanted:
        raise UsageError(
            f"none of the {len(kinds)} scenes has the composition {how.composition!r}: "
            "'base' means runs of w2m reconstruct, 'extend' all other worlds"
        )
    scene_of = _names(list(wanted))
    unseen = 0.0 if how.paper_split else how.unseen_share
    named = {scene_of[path]: kind for path, kind in wanted.items()}
    splits, walks = scene_splits(named, how.work.seed, unseen), how.walks_of(named)
    streams = assign_streams(how.streams, list(named))
    jobs = [
        SceneJob(
            path, str(out), kind, splits[scene_of[path]],
            replace(how.work, trajectories=walks[scene_of[path]]),
            streams.get(scene_of[path], ()), how.at,
        )
        for path, kind in wanted.items()
    ]  # fmt: skip
    works = run_scene_jobs(jobs, workers, progress)
    _split_walks(works, paper_splits if how.paper_split else seen_splits, how.work.seed)
    items = without_shared_pictures(build_items(works, how.work.seed))
    items = cut_to_paper_size(items, how.paper_split) if how.paper_size else items
    if not items:
        raise UsageError(
            "no items could be built: the scenes lack landmarks or walkable floor; choose "
            "furnished scenes, or generate some (--rooms 3)"
        )
    stated = {path: (recorded or {}).get(path, path) for path in wanted}
    _state_paths(works, {scene_of[path]: (path, stated[path]) for path in wanted})
    _write(Path(out), how, works, items, splits, {scene_of[path]: stated[path] for path in wanted})
    if annotations is not None:
        annotate_set(out, annotations)
    finish_set(Path(out), home)
    return BuiltSet(items, works, find_leaks(items), [path for path in kinds if path not in wanted])


def _state_paths(works: Sequence[SceneItems], paths: Mapping[str, tuple[str, str]]) -> None:
    """Replace the paths of scenes in their episodes by those to record."""
    for work in works:
        actual, stated = paths[work.scene_id]
        if actual != stated:
            work.episodes = [
                replace(one, scene=f"{stated}{one.scene.removeprefix(actual)}")
                for one in work.episodes
            ]


def _split_walks(
    works: Sequence[SceneItems],
    split: Callable[[Sequence[Trajectory], int], dict[str, str]],
    seed: int,
) -> None:
    """Assign the trajectories and episodes of each composition to splits."""
    for kind in {work.composition for work in works}:
        own = [work for work in works if work.composition == kind]
        splits = split([one for work in own for one in work.trajectories], seed)
        for work in own:
            work.trajectories = [
                replace(one, split=splits[one.trajectory_id]) for one in work.trajectories
            ]
            work.episodes = [replace(one, split=splits[one.trajectory_id]) for one in work.episodes]


def _names(paths: Sequence[str]) -> dict[str, str]:
    names = {path: scene_id_of(Path(path)) for path in paths}
    twice = [name for name in names.values() if list(names.values()).count(name) > 1]
    if twice:
        raise UsageError(f"two scene folders have the same name {twice[0]!r}; rename one of them")
    return names


def _write(
    out: Path,
    how: BuildRule,
    works: Sequence[SceneItems],
    items: Sequence[Item],
    splits: Mapping[str, str],
    paths: Mapping[str, str],
) -> None:
    write_items(out / ITEMS, items)
    write_trajectories(out / TRAJECTORIES, [one for work in works for one in work.trajectories])
    write_episodes(out / EPISODES, [one for work in works for one in work.episodes])
    about: dict[str, Any] = {
        "format": "minecraftvln-1",
        "checksums": CHECKSUMS,
        "build": {
            name: value
            for name, value in asdict(how).items()
            if name not in ("composition", "streams", "work")
        },
        "version": __version__,
        "oracle_version": WALK_VERSION,
        "composition": how.composition,
        "rule": asdict(how.work),
        "streams": list(how.streams),
        "scenes": [
            {
                "scene_id": work.scene_id,
                "path": paths[work.scene_id],
                "composition": work.composition,
                "split": "by walk" if how.paper_split else splits[work.scene_id],
                "metres_per_block": work.metres_per_block,
                "tours": work.tours,
                "trajectories": len(work.trajectories),
                "landmarks": list(work.names),
                "refused": dict(sorted(work.refused.items())),
            }
            for work in works
        ],
        "items": len(items),
    }
    write_json(out / ABOUT, about)
