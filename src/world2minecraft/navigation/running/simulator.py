"""Simulators, which combine a scene with a move set, a camera and the oracle."""

from collections.abc import Sequence
from functools import cached_property
from typing import Protocol

import numpy as np

from world2minecraft.core.types import Camera
from world2minecraft.navigation.moves import apply_move, forward_blocks, get_move_set
from world2minecraft.navigation.oracle import plan_expert_path
from world2minecraft.navigation.running.floor_map import PlanMap, floor_plans
from world2minecraft.navigation.scene import VlnScene, camera_of
from world2minecraft.navigation.types import Episode, Move, MoveSet, Stance

VIEW_PX = (640, 480)
VIEW_FOV_DEG = 79.0  # Horizontal; size and field of view are those of RxR's camera.


class Simulator(Protocol):
    """The interface of simulators. Feet are in world blocks, lengths in metres of the room."""

    move_set: MoveSet
    metres_per_block: float

    @property
    def step_m(self) -> float:
        """The length of a FORWARD move in metres."""
        ...

    def view(self, stance: Stance) -> np.ndarray:
        """Return the view at a stance as uint8 [H, W, 3]."""
        ...

    def step(self, stance: Stance, move: Move) -> tuple[Stance, bool]:
        """Return the stance after a move, and whether the move collided."""
        ...

    def distance_m(self, stance: Stance, goals: Sequence[tuple[float, float, float]]) -> float:
        """Return the walking distance to the nearest goal in metres, or inf if unreachable."""
        ...

    def expert(
        self,
        stance: Stance,
        goals: Sequence[tuple[float, float, float]],
        facing: tuple[float, float, float] | None = None,
    ) -> tuple[Move, ...]:
        """Return the oracle's moves, which end with turns toward ``facing`` and STOP."""
        ...

    def to_room_m(self, feet: np.ndarray) -> np.ndarray:
        """Convert block positions [N, 3] to metres of the room."""
        ...

    @property
    def offline(self) -> "Simulator":
        """Return a simulator for planning, whose moves do not affect a game server."""
        ...

    def plan(self, stances: Sequence[Stance]) -> np.ndarray:
        """Return a floor map with the walked path as uint8 [H, W, 3]."""
        ...


class SimulatorGuide:
    """A guide with full knowledge of an episode in a simulator."""

    def __init__(self, ground: Simulator, episode: Episode):
        self._ground, self._goals = ground.offline, episode.goals
        self._facing = episode.facing

    def distance_m(self, stance: Stance) -> float:
        """Return the walking distance to the nearest goal in metres."""
        return self._ground.distance_m(stance, self._goals)

    def step(self, stance: Stance, move: Move) -> tuple[Stance, bool]:
        """Return the stance after a move, and whether the move collides."""
        return self._ground.step(stance, move)

    def expert(self, stance: Stance) -> tuple[Move, ...]:
        """Return the oracle's moves from a stance."""
        return self._ground.expert(stance, self._goals, self._facing)


class SceneSimulator:
    """A simulator of a scene with one move set and one camera."""

    def __init__(
        self, scene: VlnScene, move_set: str | MoveSet = "vlnce", camera: Camera | None = None
    ):
        self.scene, self.move_set = scene, get_move_set(move_set)
        self.camera = camera_of(*VIEW_PX, VIEW_FOV_DEG) if camera is None else camera
        self.metres_per_block = scene.metres_per_block

    @property
    def step_m(self) -> float:
        """The length of a FORWARD move in metres of the room."""
        return forward_blocks(self.scene, self.move_set) * self.metres_per_block

    def view(self, stance: Stance, camera: Camera | None = None) -> np.ndarray:
        """Return the view at a stance, by another camera if one is given, as uint8 [H, W, 3]."""
        colour = self.scene.picture(stance, camera or self.camera, outputs=("colour",)).colour
        if colour is None:
            raise ValueError("the rendered view has no colour image")
        return colour

    def step(self, stance: Stance, move: Move) -> tuple[Stance, bool]:
        """Return the stance after a move, and whether the move collided."""
        return apply_move(self.scene, stance, move, self.move_set)

    def distance_m(self, stance: Stance, goals: Sequence[tuple[float, float, float]]) -> float:
        """Return the walking distance to the nearest goal in metres, or inf if unreachable."""
        return self.scene.distance_m(stance.feet, goals)

    def expert(
        self,
        stance: Stance,
        goals: Sequence[tuple[float, float, float]],
        facing: tuple[float, float, float] | None = None,
    ) -> tuple[Move, ...]:
        """Return the oracle's moves, or STOP alone if no path is found."""
        way = plan_expert_path(self.scene, stance, goals, self.move_set, facing=facing)
        return (Move.STOP,) if way is None else way.moves

    def to_room_m(self, feet: np.ndarray) -> np.ndarray:
        """Convert block positions [N, 3] to metres of the room."""
        return self.scene.to_room_m(feet)

    @property
    def offline(self) -> Simulator:
        """Return this simulator, because its moves do not affect a server."""
        return self

    @cached_property
    def plans(self) -> PlanMap:
        """The floor maps of the scene's storeys, cropped to its rooms."""
        return floor_plans(self.scene)

    def plan(self, stances: Sequence[Stance]) -> np.ndarray:
        """Return a map of the current storey with the walked path, without goals."""
        return np.asarray(self.plans.picture(stances, ()))
