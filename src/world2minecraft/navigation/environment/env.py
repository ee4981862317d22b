"""``world2minecraft/MinecraftVLN-v0``: walk through a world as instructed and STOP at the goal."""

import warnings
from collections.abc import Collection, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.navigation.browser_window import Window
from world2minecraft.navigation.environment.action_spaces import (
    ActionController,
    ContinuousActions,
    DiscreteActions,
)
from world2minecraft.navigation.environment.episode_sampling import EpisodeSampler
from world2minecraft.navigation.environment.observations import (
    DEFAULT_SENSORS,
    FORMER_SENSORS,
    Eyes,
    SensorSuite,
)
from world2minecraft.navigation.episodes import score_walk
from world2minecraft.navigation.gymnasium_plugin import ENV_ID
from world2minecraft.navigation.moves import get_move_set
from world2minecraft.navigation.scene import VlnScene, open_scene
from world2minecraft.navigation.types import Episode, MoveSet, Stance, check_reachable

ACTIONS = ("discrete", "continuous")
DEFAULT_MAX_STEPS = {"discrete": 500, "continuous": 5_000}  # Habitat's 500; 250 s of the game.
SUCCESS_M = 1.0  # The usual 3 m is as far as a whole room is wide.
SUCCESS_REWARD, STEP_REWARD = 2.5, -0.01  # As in Habitat's navigation; and each metre nearer is 1.


class VlnEnv(gymnasium.Env):
    """An agent in a world, with an instruction.

    Args:
        scene: the path of any world, as ``open_scene`` takes it, or an open scene.
        episodes: of this scene: a JSONL file, a set's folder, or values, taken in their order;
            None draws new ones by the seed of ``reset``.
        split: of the episodes, those of one split alone.
        actions: "discrete", or "continuous" for the game's keys and mouse at 20 ticks a second.
        move_set: of discrete actions: "vlnce", "rxr", "block", or "macro" for runs of moves.
        sliding: whether one goes on along what is in the way.
        observations: some of rgb, depth, semantic, instance, pose, instruction; rgb and pose by
            default, which every trainer reads. ``info["instruction"]`` holds the instruction.
        eyes: size and field of view of the pictures, the light, and threads to draw with.
        max_steps: then the episode is truncated; 500 moves or 5,000 ticks where None.
        success_m: STOP nearer to the goal, on foot, is a success: of the reward and of SPL.
        span_m: the shortest and the longest way of drawn episodes.
        render_mode: "rgb_array", or "human": each step is shown at ``window.link`` in the browser.
        body: as ``open_scene`` takes it, ``box`` and ``blocks_per_metre`` too.

    ``reset(options={"goal": "piano"})`` draws an episode to a thing; ``{"episode": 3}``, a number
    or an ``episode_id``, takes one of the file.

    Raises:
        UsageError: an option cannot be. InputError: the world cannot be read.
    """

    metadata = {"render_modes": ["rgb_array", "human"], "render_fps": 8}  # noqa: RUF012

    def __init__(
        self,
        scene: str | Path | VlnScene,
        *,
        episodes: str | Path | Sequence[Episode] | None = None,
        split: str | None = None,
        actions: str = "discrete",
        move_set: str = "vlnce",
        sliding: bool = False,
        observations: Collection[str] = DEFAULT_SENSORS,
        eyes: Eyes | None = None,
        max_steps: int | None = None,
        success_m: float = SUCCESS_M,
        span_m: tuple[float, float] = (1.0, 25.0),
        render_mode: str | None = None,
        body: float | None = None,
        box: Sequence[int] | None = None,
        blocks_per_metre: float | None = None,
    ):
        if actions not in ACTIONS:
            raise UnknownNameError("kind of actions", actions, ACTIONS)
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise UnknownNameError("render mode", str(render_mode), self.metadata["render_modes"])
        if max_steps is not None and max_steps < 1:
            raise UsageError(f"max_steps is 1 or more, not {max_steps}")
        if not success_m > 0:
            raise UsageError(f"success_m is a length above 0, in metres, not {success_m:g}")
        self.scene = _opened(scene, body, box, blocks_per_metre)
        self.sampler = EpisodeSampler(
            self.scene, episodes, split, get_move_set(move_set).name, span_m
        )
        texts = self.sampler.texts if "instruction" in observations else ()
        self.sensors = SensorSuite(self.scene, observations, eyes or Eyes(), texts)
        self.controller: ActionController = self._make_controller(
            actions == "continuous", get_move_set(move_set), sliding
        )
        self.observation_space, self.action_space = self.sensors.space, self.controller.space
        self.max_steps, self.success_m = max_steps or DEFAULT_MAX_STEPS[actions], success_m
        self.render_mode = render_mode
        self.window: Window | None = None
        self.episode: Episode | None = None
        self.path: list[Stance] = []
        self.steps = self.collisions = 0
        self._distance_m = np.inf
        self._is_over = True

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begin an episode, see the class for the options.

        The same seed draws the same new episode; of given ones seed N goes on from the N-th, so
        that environments side by side play different ones.

        Raises:
            UsageError: an option is not known, or no such episode can be drawn.
            InputError: no way leads from the start of a given episode to its goal.
        """
        super().reset(seed=seed)
        if seed is not None:
            self.sampler.rewind(seed)
        episode = self.sampler.sample(self.np_random, options or {})
        check_reachable(episode, self.scene.distance_m(episode.start.feet, episode.goals))
        self.episode = episode
        self.controller.begin(self.episode.start)
        self.path, self.steps, self.collisions = [self.episode.start], 0, 0
        self._distance_m = self.scene.distance_m(self.episode.start.feet, self.episode.goals)
        self._is_over = False
        return self._look(), self._info(collided=False)

    def step(self, action: Any) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Act; see the class.

        Raises:
            UsageError: the action is not one of the space.
            gymnasium.error.ResetNeeded: the episode is over.
        """
        if self._is_over:
            raise gymnasium.error.ResetNeeded("the episode is over; call reset() before step()")
        stopped, gone, collided = self.controller.act(action)
        self.path += gone
        self.steps, self.collisions = self.steps + 1, self.collisions + collided
        before = self._distance_m
        self._distance_m = self.scene.distance_m(self.controller.stance.feet, self._playing.goals)
        nearer = before - self._distance_m if np.isfinite([before, self._distance_m]).all() else 0.0
        success = stopped and self._distance_m < self.success_m
        truncated = not stopped and self.steps >= self.max_steps
        self._is_over = stopped or truncated
        info = self._info(collided)
        if self._is_over:
            info |= {"success": success, "score": self._score(stopped)}
        reward = float(nearer + STEP_REWARD + SUCCESS_REWARD * success)
        return self._look(), reward, stopped, truncated, info

    def render(self) -> np.ndarray | None:
        """Return what the agent sees, uint8 [H, W, 3]; None where it is shown, or not asked for.

        Raises:
            gymnasium.error.ResetNeeded: no episode has begun.
        """
        if self.render_mode is None or not self._playing:
            return None
        frame = self.sensors.rgb(self.controller.stance)
        if self.render_mode == "rgb_array":
            return frame
        self.window = self.window or Window(frame.shape[1])
        self.window.show(frame, self._told())
        return None

    def close(self) -> None:
        """Close the window, where there is one."""
        if self.window:
            self.window.close()
            self.window = None

    def _make_controller(self, by_keys: bool, move_set: MoveSet, sliding: bool) -> ActionController:
        """Return what takes the actions; a body elsewhere has its own."""
        if by_keys:
            return ContinuousActions(self.scene)
        return DiscreteActions(self.scene, move_set, sliding)

    def _told(self) -> str:
        """Return what is said beside the frame."""
        lines = [self._playing.instruction.text, f"Move {self.steps} of at most {self.max_steps}."]
        if self._is_over:
            lines.append(f"This walk is over, {self._distance_m:.2f} m from the goal.")
        return "\n".join(lines)

    @property
    def _playing(self) -> Episode:
        if self.episode is None:
            raise gymnasium.error.ResetNeeded("no episode has begun; call reset() first")
        return self.episode

    def _look(self) -> dict[str, Any]:
        if self.render_mode == "human":
            self.render()
        return self.sensors.look(self.controller.stance, self._playing.instruction.text)

    def _info(self, collided: bool) -> dict[str, Any]:
        return {
            "episode_id": self._playing.episode_id,
            "scene_id": self.scene.scene_id,
            "goal": self._playing.goal_name,
            "instruction": self._playing.instruction.text,
            "distance_m": float(self._distance_m),
            "collided": bool(collided),
            "collisions": self.collisions,
            "steps": self.steps,
        }

    def _score(self, stopped: bool) -> dict[str, Any]:
        found = score_walk(
            self.scene, self._playing, self.path, stopped=stopped, steps=self.steps,
            collisions=self.collisions, radius_m=self.success_m,
        )  # fmt: skip
        return asdict(found)


class FormerIdEnv(VlnEnv):
    """The environment under its former id, with the default observations of that version."""

    def __init__(self, *args: Any, **options: Any):
        warn_of_former_id("World2Minecraft-VLN-v0", ENV_ID)
        super().__init__(*args, **{"observations": FORMER_SENSORS, **options})


def warn_of_former_id(former: str, current: str) -> None:
    """Warn whoever calls ``gymnasium.make`` with a former id."""
    warnings.warn(
        f"the environment id {former} is deprecated; use {current}",
        DeprecationWarning,
        stacklevel=4,  # This function, __init__, gymnasium.make, and who called it.
    )


def _opened(
    scene: str | Path | VlnScene,
    body: float | None,
    box: Sequence[int] | None,
    blocks_per_metre: float | None,
) -> VlnScene:
    if not isinstance(scene, VlnScene):
        return open_scene(scene, body=body, box=box, blocks_per_metre=blocks_per_metre)
    if not body is box is blocks_per_metre is None:
        raise UsageError("an open scene has its body, box and scale; leave them out")
    return scene
