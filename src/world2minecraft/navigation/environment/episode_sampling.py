"""Which episode comes next: of a file in its order, to a thing that was asked for, or any."""

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
    """The episodes of a scene that an environment plays.

    Args:
        scene: where they are.
        episodes: a file, a folder, values, or None for new ones.
        split: of the given ones, those of one split.
        move_set: of new ones.
        span_m: of new ones, the shortest and the longest way.

    Raises:
        UsageError: none of them is of the scene, or the ways cannot be.
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
            raise UsageError(f"span_m is the shortest and the longest way in metres, not {span_m}")
        self.scene, self.move_set, self.span_m = scene, move_set, span_m
        self.given = None if episodes is None else _of_scene(scene, episodes, split)
        self._next = 0
        self._targets: tuple[Target, ...] | None = None

    @property
    def texts(self) -> tuple[str, ...]:
        """The instructions of the given episodes, and all names that new ones may have."""
        given = [episode.instruction.text for episode in self.given or ()]
        things = [one.name for one in (*self.scene.landmarks, *self.scene.rooms)]
        return (*given, *things)

    def rewind(self, seed: int) -> None:
        """Go on from the given episode of a number, counted round."""
        self._next = seed % len(self.given) if self.given else 0

    def sample(self, rng: np.random.Generator, options: Mapping[str, Any]) -> Episode:
        """Return the next episode.

        Raises:
            UsageError: an option is not known, or no such episode is.
        """
        for name in options:
            if name not in OPTIONS:
                raise UnknownNameError("option of reset", str(name), OPTIONS)
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
        """What one can be sent to."""
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
            raise UsageError(f"no floor is before the {landmark.name}; name another goal")
        return target_of(self.scene, landmark, goals)

    def _asked(self, wanted: Any) -> Episode:
        if self.given is None:
            raise UsageError(
                "the option 'episode' needs episodes; make the environment with episodes=FILE"
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
            raise UsageError(f"an episode is 0 to {most}, or an episode_id, not {wanted!r}")
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
            f"none of {len(every)} episodes {which}is of the scene {scene.scene_id!r}; "
            f"they are of {scenes}"
        )
    return own
