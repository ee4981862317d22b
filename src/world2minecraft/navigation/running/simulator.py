"""What episodes are walked on: a scene with one set of moves, one camera and the oracle's paths."""

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
VIEW_FOV_DEG = 79.0  # Horizontal: RxR's camera, of this size too.


class Simulator(Protocol):
    """What a walk needs of a scene. Feet are world blocks, lengths metres of the room."""

    move_set: MoveSet
    metres_per_block: float

    @property
    def step_m(self) -> float:
        """How far FORWARD goes."""
        ...

    def view(self, stance: Stance) -> np.ndarray:
        """Return what one who stands so sees, uint8 [H, W, 3]."""
        ...

    def step(self, stance: Stance, move: Move) -> tuple[Stance, bool]:
        """Return where a move leads, and whether something was in the way."""
        ...

    def distance_m(self, stance: Stance, goals: Sequence[tuple[float, float, float]]) -> float:
        """Return the way on foot to the nearest goal, inf where none leads."""
        ...

    def expert(
        self,
        stance: Stance,
        goals: Sequence[tuple[float, float, float]],
        facing: tuple[float, float, float] | None = None,
    ) -> tuple[Move, ...]:
        """Return the oracle's moves; they end by turning to ``facing``, and with STOP."""
        ...

    def to_room_m(self, feet: np.ndarray) -> np.ndarray:
        """Return places [N, 3] in metres of the room."""
        ...

    @property
    def offline(self) -> "Simulator":
        """The same ground for moves that are only thought of; itself, where none is for real."""
        ...

    def plan(self, stances: Sequence[Stance]) -> np.ndarray:
        """Return a plan of the scene with the way that was walked, uint8 [H, W, 3]."""
        ...


class SimulatorGuide:
    """What the privileged know of an episode on a ground."""

    def __init__(self, ground: Simulator, episode: Episode):
        self._ground, self._goals = ground.offline, episode.goals
        self._facing = episode.facing

    def distance_m(self, stance: Stance) -> float:
        """Return how far it is on foot to the nearest goal."""
        return self._ground.distance_m(stance, self._goals)

    def step(self, stance: Stance, move: Move) -> tuple[Stance, bool]:
        """Return where a move would lead."""
        return self._ground.step(stance, move)

    def expert(self, stance: Stance) -> tuple[Move, ...]:
        """Return the oracle's moves from here."""
        return self._ground.expert(stance, self._goals, self._facing)


class SceneSimulator:
    """A scene, walked by one set of moves and seen through one camera."""

    def __init__(
        self, scene: VlnScene, move_set: str | MoveSet = "vlnce", camera: Camera | None = None
    ):
        self.scene, self.move_set = scene, get_move_set(move_set)
        self.camera = camera_of(*VIEW_PX, VIEW_FOV_DEG) if camera is None else camera
        self.metres_per_block = scene.metres_per_block

    @property
    def step_m(self) -> float:
        """How far FORWARD goes, metres of the room."""
        return forward_blocks(self.scene, self.move_set) * self.metres_per_block

    def view(self, stance: Stance) -> np.ndarray:
        """Return what one who stands so sees, uint8 [H, W, 3]."""
        colour = self.scene.picture(stance, self.camera, outputs=("colour",)).colour
        if colour is None:
            raise ValueError("the picture has no colour")
        return colour

    def step(self, stance: Stance, move: Move) -> tuple[Stance, bool]:
        """Return where a move leads, and whether something was in the way."""
        return apply_move(self.scene, stance, move, self.move_set)

    def distance_m(self, stance: Stance, goals: Sequence[tuple[float, float, float]]) -> float:
        """Return the way on foot to the nearest goal, inf where none leads."""
        return self.scene.distance_m(stance.feet, goals)

    def expert(
        self,
        stance: Stance,
        goals: Sequence[tuple[float, float, float]],
        facing: tuple[float, float, float] | None = None,
    ) -> tuple[Move, ...]:
        """Return the oracle's moves; STOP alone where it knows no way."""
        way = plan_expert_path(self.scene, stance, goals, self.move_set, facing=facing)
        return (Move.STOP,) if way is None else way.moves

    def to_room_m(self, feet: np.ndarray) -> np.ndarray:
        """Return places [N, 3] in metres of the room."""
        return self.scene.to_room_m(feet)

    @property
    def offline(self) -> Simulator:
        """Itself: no move here is for real."""
        return self

    @cached_property
    def plans(self) -> PlanMap:
        """The plans of the scene's storeys, cut to its rooms."""
        return floor_plans(self.scene)

    def plan(self, stances: Sequence[Stance]) -> np.ndarray:
        """Return a plan of the storey with the way that was walked, without goals."""
        return np.asarray(self.plans.picture(stances, ()))
