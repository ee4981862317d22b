"""Selection of the next episode: from a file, to a requested goal, or random."""

import operator
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.navigation.episodes import Target, random_episode, target_of, targets_of
from world2minecraft.navigation.records import read_episodes
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.types import Episode

OPTIONS = ("episode", "goal")


class EpisodeSampler:
    """The sequence of episodes that an environment plays in a scene.

    Args:
        scene: The scene.
        episodes: A file, a folder or a sequence of episodes. None samples new episodes.
        split: The split of the given episodes to use. None uses all.
        move_set: The move set of new episodes.
        span_m: The shortest and longest path length of new episodes, in metres.

    Raises:
        UsageError: If no episode belongs to the scene, or ``span_m`` is invalid.
    """

    def __init__(
        self,
        scene: VlnScene,
        episodes: str | Path | Sequence[Episode] | None,
        split: str | None,
        move_set: str,
        span_m: tuple[float, float],
    ):
        if not 0 <= span_m[0] < span_m[1]:
            raise UsageError(
                f"span_m must be the shortest and longest path length in metres, got {span_m}"
            )
        self.scene, self.move_set, self.span_m = scene, move_set, span_m
        self.given = None if episodes is None else _of_scene(scene, episodes, split)
        self._next = 0
        self._targets: tuple[Target, ...] | None = None

    @property
    def texts(self) -> tuple[str, ...]:
        """The instructions of the given episodes, and all names that may occur in new ones."""
        given = [episode.instruction.text for episode in self.given or ()]
        things = [one.name for one in (*self.scene.landmarks, *self.scene.rooms)]
        return (*given, *things)

    def rewind(self, seed: int) -> None:
        """Continue with the given episode whose index is the seed modulo their number."""
        self._next = seed % len(self.given) if self.given else 0

    def sample(self, rng: np.random.Generator, options: Mapping[str, Any]) -> Episode:
        """Return the next episode.

        Raises:
            UsageError: If an option is unknown, or no such episode exists.
        """
        for name in options:
            if name not in OPTIONS:
                raise UnknownNameError("reset option", str(name), OPTIONS)
        if "goal" in options:
            return self._new(rng, [self._target(str(options["goal"]))])
        if "episode" in options:
            return self._asked(options["episode"])
        if self.given is None:
            return self._new(rng, self.targets)
        episode = self.given[self._next % len(self.given)]
        self._next += 1
        return episode

    @property
    def targets(self) -> tuple[Target, ...]:
        """The possible goals of new episodes."""
        if self._targets is None:
            self._targets = targets_of(self.scene)
        return self._targets

    def _new(self, rng: np.random.Generator, targets: Sequence[Target]) -> Episode:
        name = f"{self.scene.scene_id}-{int(rng.integers(1 << 31)):08x}"
        return random_episode(
            self.scene, rng, targets, name, move_set=self.move_set, span_m=self.span_m
        )

    def _target(self, name: str) -> Target:
        landmark = self.scene.landmark(name)
        goals = self.scene.goals_at(landmark)
        if not goals:
            raise UsageError(
                f"the {landmark.name} has no walkable floor in front of it; choose another goal"
            )
        return target_of(self.scene, landmark, goals)

    def _asked(self, wanted: Any) -> Episode:
        if self.given is None:
            raise UsageError(
                "the reset option 'episode' requires an episode file; create the "
                "environment with episodes=FILE"
            )
        if isinstance(wanted, str):
            names = {episode.episode_id: episode for episode in self.given}
            if wanted not in names:
                raise UnknownNameError("episode", wanted, names)
            return names[wanted]
        try:
            number = operator.index(wanted)
        except TypeError:
            number = -1
        if not 0 <= number < len(self.given):
            most = len(self.given) - 1
            raise UsageError(
                f"the reset option 'episode' must be an index from 0 to {most} or an episode "
                f"ID, got {wanted!r}"
            )
        self._next = number + 1
        return self.given[number]


def _of_scene(
    scene: VlnScene, episodes: str | Path | Sequence[Episode], split: str | None
) -> list[Episode]:
    every = read_episodes(episodes) if isinstance(episodes, str | Path) else list(episodes)
    own = [one for one in every if one.scene_id == scene.scene_id and split in (None, one.split)]
    if not own:
        scenes = ", ".join(sorted({one.scene_id for one in every})) or "nothing"
        which = f"of split {split!r} " if split else ""
        raise UsageError(
            f"none of the {len(every)} episodes {which}belongs to scene "
            f"{scene.scene_id!r}; they belong to {scenes}"
        )
    return own
