"""Items of scenes: wrong pictures of elsewhere come from the same split, never from another."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.navigation.data.album import Pictured
from world2minecraft.navigation.data.letters import LetterDeck
from world2minecraft.navigation.data.next_action import action_item
from world2minecraft.navigation.data.next_view import ViewQuestion, view_item
from world2minecraft.navigation.data.scene_items import MADE_BY, SceneWork
from world2minecraft.navigation.values import Item, Trajectory

TRIES = 60  # Pictures of elsewhere that are looked at for one that is as like as is wanted.


@dataclass(frozen=True)
class _Pool:
    """The pictures of a split, by scene; each with its trajectory."""

    by_scene: dict[str, list[tuple[str, Pictured]]]

    def elsewhere(self, trajectory: Trajectory, rng: np.random.Generator) -> list[Pictured]:
        own = [
            one
            for name, one in self.by_scene[trajectory.scene_id]
            if name != trajectory.trajectory_id
        ]
        return _drawn(own, rng)

    def other_scene(self, trajectory: Trajectory, rng: np.random.Generator) -> list[Pictured]:
        others = [name for name in sorted(self.by_scene) if name != trajectory.scene_id]
        if not others:
            return []
        chosen = self.by_scene[others[rng.integers(len(others))]]
        return _drawn([one for _, one in chosen], rng)


def _drawn(pictures: Sequence[Pictured], rng: np.random.Generator) -> list[Pictured]:
    return [pictures[n] for n in rng.permutation(len(pictures))[:TRIES]]


def items_of(works: Sequence[SceneWork], seed: int = 0) -> list[Item]:
    """Return the items of scenes, those of a trajectory beside each other.

    Args:
        works: of ``work_scene``, one a scene.
        seed: orders choices and letters.
    """
    pools = {split: _pool(works, split) for split in _splits(works)}
    decks = {
        task: LetterDeck(np.random.default_rng([seed, *task.encode()]))
        for task in ("next_view", "next_action")
    }
    items: list[Item] = []
    for work in works:
        views: dict[str, list[ViewQuestion]] = {}
        for question in work.views:
            views.setdefault(question.trajectory_id, []).append(question)
        for trajectory in work.trajectories:
            rng = np.random.default_rng([seed, *trajectory.trajectory_id.encode()])
            items += _views(work, trajectory, views, pools[trajectory.split], decks, rng)
            items += _actions(work, trajectory, decks, rng)
    return items


def _views(
    work: SceneWork,
    trajectory: Trajectory,
    questions: dict[str, list[ViewQuestion]],
    pool: _Pool,
    decks: dict[str, LetterDeck],
    rng: np.random.Generator,
) -> list[Item]:
    name = trajectory.trajectory_id
    items = []
    for question in questions.get(name, []):
        item = view_item(
            question, trajectory, work.spoken[name], work.pictures[name],
            pool.elsewhere(trajectory, rng), pool.other_scene(trajectory, rng),
            decks["next_view"].deal(), rng,
            composition=work.composition, oracle_version=MADE_BY,
        )  # fmt: skip
        items += [item] if item is not None else []
    return items


def _actions(
    work: SceneWork,
    trajectory: Trajectory,
    decks: dict[str, LetterDeck],
    rng: np.random.Generator,
) -> list[Item]:
    name = trajectory.trajectory_id
    return [
        action_item(
            trajectory, work.spoken[name], work.pictures[name], step, decks["next_action"].deal(),
            rng, composition=work.composition, oracle_version=MADE_BY,
        )
        for step in work.actions[name]
    ]  # fmt: skip


def _splits(works: Sequence[SceneWork]) -> list[str]:
    return sorted({one.split for work in works for one in work.trajectories})


def _pool(works: Sequence[SceneWork], split: str) -> _Pool:
    by_scene: dict[str, list[tuple[str, Pictured]]] = {}
    for work in works:
        own = [
            (one.trajectory_id, picture)
            for one in work.trajectories
            if one.split == split
            for picture in work.pictures[one.trajectory_id]
        ]
        if own:
            by_scene[work.scene_id] = own
    return _Pool(by_scene)
