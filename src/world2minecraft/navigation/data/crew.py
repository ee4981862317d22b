"""The scenes of a set, worked by one process or by several: the same comes of it in any case.

Each scene is worked by itself, its chances drawn from its own name, and what came of the scenes is
put in the order in which they were named.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from world2minecraft.core.progress import Progress, silent
from world2minecraft.minecraftocc.engine import opened_engine
from world2minecraft.navigation.data.recorded_walks import At, recorded_tours
from world2minecraft.navigation.data.scene_items import SceneWork, Tick, WorkRule, work_scene
from world2minecraft.navigation.scene import open_scene


@dataclass(frozen=True)
class SceneJob:
    """A scene to work. ``split`` is train or val_unseen; ``streams`` were recorded there."""

    path: str
    folder: str  # of the set
    composition: str
    split: str
    rule: WorkRule
    streams: tuple[str, ...] = ()
    at: At = "eye"  # what streams tell that do not say it


def work_jobs(
    jobs: Sequence[SceneJob], workers: int = 1, progress: Progress = silent
) -> list[SceneWork]:
    """Return what comes of scenes, in their order. The largest ones are begun first.

    Args:
        jobs: the scenes.
        workers: how many processes; with one it is this one.
        progress: told of the walks.

    Raises:
        InputError: a scene cannot be read. OutputError: the folder cannot be written.
        WorkerError: a process died again and again. UsageError: a number of workers that cannot be.
    """
    first = sorted(range(len(jobs)), key=lambda n: (-jobs[n].rule.trajectories, n))
    wanted = sum(job.rule.trajectories for job in jobs)
    walks, works = _Count(wanted, len(jobs), progress), dict[int, SceneWork]()
    with opened_engine("pool", min(workers, len(jobs))) as engine:
        for place, work in engine.run(_worked, [jobs[n] for n in first], walks.add):
            works[first[place]] = work
            own = jobs[first[place]].rule.trajectories
            walks.scene_done(work.scene_id, len(work.trajectories), own)
    return [works[n] for n in range(len(jobs))]


def _worked(job: SceneJob, tick: Tick) -> SceneWork:
    """Work a scene: what processes are sent to do."""
    scene = open_scene(job.path)
    recorded = recorded_tours(scene, job.streams, job.at)
    return work_scene(scene, Path(job.folder), job.composition, job.split, job.rule, tick, recorded)


class _Count:
    """How many walks there are; what a scene could not give is counted when it is done."""

    def __init__(self, wanted: int, scenes: int, progress: Progress):
        self._done, self._wanted, self._left = 0, wanted, scenes
        self._told = partial(progress, "walks")
        self._told(0, wanted)

    def add(self, count: int) -> None:
        """Count walks; the last is told with its scene."""
        self._done = min(self._done + count, self._wanted - 1)
        self._told(self._done, self._wanted)

    def scene_done(self, name: str, given: int, asked: int) -> None:
        """Count what a scene did not give."""
        self._left -= 1
        self.add(max(0, asked - given))
        done = self._done if self._left else self._wanted
        self._told(done, self._wanted, f"{name}: {given} walks")
