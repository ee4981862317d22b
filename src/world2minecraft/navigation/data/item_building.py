"""Building of the items of a set, with balanced letters and optional cuts to the paper's size.

Distractors from other places are taken from the same split as the question.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.navigation.data.distractors import CHOICES
from world2minecraft.navigation.data.picture_store import StoredPicture
from world2minecraft.navigation.data.scene_items import WALK_VERSION, SceneItems
from world2minecraft.navigation.data.tasks import ViewQuestion, action_item, view_item
from world2minecraft.navigation.types import LETTERS, Item, Trajectory

# From the paper's table of instruction lengths; its table of sizes has the two rows swapped.
PAPER_SIZE: Mapping[tuple[str, str], int] = {
    ("next_action", "base"): 769,
    ("next_view", "base"): 290,
    ("next_action", "extend"): 1351,
    ("next_view", "extend"): 1132,
}
# Test items from its table of sizes, with the rows corrected.
PAPER_HELD: Mapping[tuple[str, str], int] = {
    ("next_action", "base"): 175,
    ("next_view", "base"): 41,
    ("next_action", "extend"): 309,
    ("next_view", "extend"): 230,
}
PAPER_WALKS = {"base": 360, "extend": 600}  # Of all scenes together, more than are needed.
COMPOSITIONS = ("base", "extend", "combined")
TRIES = 60  # Images from elsewhere that are compared for one distractor.


class LetterBalancer:
    """A shuffled deck of answer letters in which all letters occur equally often."""

    def __init__(self, rng: np.random.Generator):
        self._rng, self._letters = rng, LETTERS[:CHOICES]
        self._pack: list[str] = []

    def deal(self) -> str:
        """Return the next letter, reshuffling when all letters have been used."""
        if not self._pack:
            self._pack = [self._letters[n] for n in self._rng.permutation(len(self._letters))]
        return self._pack.pop()


def cut_to_paper_size(items: Sequence[Item], splits_too: bool = False) -> list[Item]:
    """Reduce the items to the paper's number of items per task and composition.

    Args:
        items: The items of a set.
        splits_too: Whether to apply the paper's numbers to training and held-out items separately.
    """
    if not splits_too:
        return cut_to_quotas(items, PAPER_SIZE)
    train = {key: PAPER_SIZE[key] - PAPER_HELD[key] for key in PAPER_SIZE}
    retained = cut_to_quotas([item for item in items if item.split == "train"], train)
    retained += cut_to_quotas([item for item in items if item.split != "train"], PAPER_HELD)
    chosen = {item.item_id for item in retained}
    return [item for item in items if item.item_id in chosen]


def cut_to_quotas(items: Sequence[Item], quotas: Mapping[tuple[str, str], int]) -> list[Item]:
    """Reduce the items of each task and composition to a quota, in their original order.

    Trajectories of all scenes are used in turn, so that every scene remains represented.

    Args:
        items: The items of a set, grouped by trajectory.
        quotas: The maximum number by task and composition. Combinations without a quota are kept.
    """
    retained: set[str] = set()
    for key in {(item.task, item.composition) for item in items}:
        own = [item for item in items if (item.task, item.composition) == key]
        retained |= {item.item_id for item in _in_turn(own)[: quotas.get(key, len(own))]}
    return [item for item in items if item.item_id in retained]


def _in_turn(items: Sequence[Item]) -> list[Item]:
    """Sort items so that the n-th trajectory of every scene precedes any (n+1)-th one."""
    turns: dict[str, dict[str, int]] = {}
    for item in items:
        own = turns.setdefault(item.scene_id, {})
        own.setdefault(item.trajectory_id, len(own))
    return sorted(items, key=lambda item: turns[item.scene_id][item.trajectory_id])


@dataclass(frozen=True)
class _Pool:
    """The images of a split by scene, each with its trajectory ID."""

    by_scene: dict[str, list[tuple[str, StoredPicture]]]

    def elsewhere(self, trajectory: Trajectory, rng: np.random.Generator) -> list[StoredPicture]:
        """Draw images of other trajectories in the same scene."""
        own = [
            one
            for name, one in self.by_scene[trajectory.scene_id]
            if name != trajectory.trajectory_id
        ]
        return _drawn(own, rng)

    def other_scene(self, trajectory: Trajectory, rng: np.random.Generator) -> list[StoredPicture]:
        """Draw images of a random other scene."""
        others = [name for name in sorted(self.by_scene) if name != trajectory.scene_id]
        if not others:
            return []
        chosen = self.by_scene[others[rng.integers(len(others))]]
        return _drawn([one for _, one in chosen], rng)


def _drawn(pictures: Sequence[StoredPicture], rng: np.random.Generator) -> list[StoredPicture]:
    return [pictures[n] for n in rng.permutation(len(pictures))[:TRIES]]


def build_items(works: Sequence[SceneItems], seed: int = 0) -> list[Item]:
    """Build the items of several scenes, grouped by trajectory.

    Args:
        works: The results of ``build_scene_items``, one per scene.
        seed: The random seed for options and letters.
    """
    pools = {split: _pool(works, split) for split in _splits(works)}
    decks = {
        task: LetterBalancer(np.random.default_rng([seed, *task.encode()]))
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
    work: SceneItems,
    trajectory: Trajectory,
    questions: dict[str, list[ViewQuestion]],
    pool: _Pool,
    decks: dict[str, LetterBalancer],
    rng: np.random.Generator,
) -> list[Item]:
    name = trajectory.trajectory_id
    items = []
    for question in questions.get(name, []):
        item = view_item(
            question, trajectory, work.spoken[name], work.pictures[name],
            pool.elsewhere(trajectory, rng), pool.other_scene(trajectory, rng),
            decks["next_view"].deal(), rng,
            composition=work.composition, oracle_version=WALK_VERSION,
        )  # fmt: skip
        items += [item] if item is not None else []
    return items


def _actions(
    work: SceneItems,
    trajectory: Trajectory,
    decks: dict[str, LetterBalancer],
    rng: np.random.Generator,
) -> list[Item]:
    name = trajectory.trajectory_id
    return [
        action_item(
            trajectory, work.spoken[name], work.pictures[name], step, decks["next_action"].deal(),
            rng, composition=work.composition, oracle_version=WALK_VERSION,
        )
        for step in work.actions[name]
    ]  # fmt: skip


def _splits(works: Sequence[SceneItems]) -> list[str]:
    return sorted({one.split for work in works for one in work.trajectories})


def _pool(works: Sequence[SceneItems], split: str) -> _Pool:
    by_scene: dict[str, list[tuple[str, StoredPicture]]] = {}
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
