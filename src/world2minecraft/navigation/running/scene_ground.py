"""A scene as the ground of episodes: its own moves, oracle, distances and pictures."""

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from world2minecraft.core.types import Camera
from world2minecraft.navigation.moves import forward_blocks, moved, named_set
from world2minecraft.navigation.oracle import expert
from world2minecraft.navigation.running.floor_map import PlanMap, plan_of
from world2minecraft.navigation.running.ground import Ground
from world2minecraft.navigation.scene import VlnScene, camera_of
from world2minecraft.navigation.values import Move, MoveSet, Stance

VIEW_PX = (640, 480)
VIEW_FOV_DEG = 79.0  # Horizontal: RxR's camera, of this size too.


class SceneGround:
    """A scene, walked by one set of moves and seen through one camera."""

    def __init__(
        self, scene: VlnScene, move_set: str | MoveSet = "vlnce", camera: Camera | None = None
    ):
        self.scene, self.move_set = scene, named_set(move_set)
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

    def after(self, stance: Stance, move: Move) -> tuple[Stance, bool]:
        """Return where a move leads, and whether something was in the way."""
        return moved(self.scene, stance, move, self.move_set)

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
        way = expert(self.scene, stance, goals, self.move_set, facing=facing)
        return (Move.STOP,) if way is None else way.moves

    def to_room_m(self, feet: np.ndarray) -> np.ndarray:
        """Return places [N, 3] in metres of the room."""
        return self.scene.to_room_m(feet)

    @property
    def imagined(self) -> Ground:
        """Itself: no move here is for real."""
        return self

    @cached_property
    def plans(self) -> PlanMap:
        """The plans of the scene's storeys, cut to its rooms."""
        return plan_of(self.scene)

    def plan(self, stances: Sequence[Stance]) -> np.ndarray:
        """Return a plan of the storey with the way that was walked, without goals."""
        return np.asarray(self.plans.picture(stances, ()))
