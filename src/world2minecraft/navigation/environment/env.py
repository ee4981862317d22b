"""The environment ``world2minecraft/MinecraftVLN-v0`` for following instructions to a goal."""

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
SUCCESS_M = 1.0  # The usual 3 m is as large as a whole room.
SUCCESS_REWARD, STEP_REWARD = 2.5, -0.01  # As in Habitat; each metre closer to the goal gives 1.


class VlnEnv(gymnasium.Env):
    """A Gymnasium environment in which an agent follows an instruction through a world.

    ``reset(options={"goal": "piano"})`` samples an episode to a landmark, and
    ``reset(options={"episode": 3})`` selects an episode of the file by its index or ``episode_id``.

    Args:
        scene: The path of a world, as accepted by ``open_scene``, or an open scene.
        episodes: Episodes of this scene in order: a JSONL file, the folder of a set, or a sequence.
            None samples new episodes from the seed of ``reset``.
        split: The split of the episodes to use. None uses all.
        actions: "discrete", or "continuous" for the game's keys and mouse at 20 ticks per second.
        move_set: The discrete move set: "vlnce", "rxr", "block", or "macro" for runs of moves.
        sliding: Whether the agent slides along obstacles instead of stopping.
        observations: Some of rgb, depth, semantic, instance, pose and instruction. The default is
            rgb and pose, which every trainer supports. ``info["instruction"]`` contains the
            instruction.
        eyes: The size, field of view and lighting of the images, and the number of rendering
            threads.
        max_steps: The step limit after which an episode is truncated. None means 500 moves or 5,000
            ticks.
        success_m: The maximum walking distance from STOP to the goal for success, in metres.
        span_m: The shortest and longest path length of sampled episodes, in metres.
        render_mode: "rgb_array", or "human" to show each step in the browser at ``window.link``.
        body: The body size, as accepted by ``open_scene``.
        box: The block range to load, as accepted by ``open_scene``.
        blocks_per_metre: The scale, as accepted by ``open_scene``.

    Raises:
        UsageError: If an option is invalid.
        InputError: If the world cannot be read.
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
            raise UnknownNameError("action space", actions, ACTIONS)
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise UnknownNameError("render mode", str(render_mode), self.metadata["render_modes"])
        if max_steps is not None and max_steps < 1:
            raise UsageError(f"max_steps must be 1 or more, got {max_steps}")
        if not success_m > 0:
            raise UsageError(f"success_m must be a positive distance in metres, got {success_m:g}")
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
        """Start an episode. The class describes the options.

        The same seed samples the same new episode. With given episodes, seed N continues from the
        N-th one, so that parallel environments play different episodes.

        Raises:
            UsageError: If an option is unknown, or no such episode can be sampled.
            InputError: If no path leads from the start of a given episode to its goal.
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
        """Apply an action and return the observation, reward, termination, truncation and info.

        Raises:
            UsageError: If the action is not in the action space.
            gymnasium.error.ResetNeeded: If the episode is over.
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
        """Render the agent's view.

        Returns:
            The image as uint8 [H, W, 3] for "rgb_array". None if the view is shown in the browser,
            or if rendering is disabled.

        Raises:
            gymnasium.error.ResetNeeded: If no episode has started.
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
        """Close the browser page, if it is open."""
        if self.window:
            self.window.close()
            self.window = None

    def _make_controller(self, by_keys: bool, move_set: MoveSet, sliding: bool) -> ActionController:
        """Return the action controller. Subclasses may provide another one."""
        if by_keys:
            return ContinuousActions(self.scene)
        return DiscreteActions(self.scene, move_set, sliding)

    def _told(self) -> str:
        """Return the text that is shown beside the frame."""
        lines = [self._playing.instruction.text, f"Move {self.steps} of at most {self.max_steps}."]
        if self._is_over:
            lines.append(f"This walk is over, {self._distance_m:.2f} m from the goal.")
        return "\n".join(lines)

    @property
    def _playing(self) -> Episode:
        if self.episode is None:
            raise gymnasium.error.ResetNeeded("no episode is running; call reset() first")
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
    """Emit a DeprecationWarning for a former environment ID."""
    warnings.warn(
        f"the environment ID {former} is deprecated; use {current}",
        DeprecationWarning,
        stacklevel=4,  # This function, __init__, gymnasium.make and its caller.
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
        raise UsageError(
            "body, box and blocks_per_metre cannot be changed for a scene that is already "
            "open; omit them"
        )
    return scene
