"""What episodes are walked on: a scene, its moves, its views and its ways, for one set of moves."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from world2minecraft.navigation.values import Episode, Move, MoveSet, Stance


class Ground(Protocol):
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

    def after(self, stance: Stance, move: Move) -> tuple[Stance, bool]:
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
    def imagined(self) -> "Ground":
        """The same ground for moves that are only thought of; itself, where none is for real."""
        ...

    def plan(self, stances: Sequence[Stance]) -> np.ndarray:
        """Return a plan of the scene with the way that was walked, uint8 [H, W, 3]."""
        ...


class GroundGuide:
    """What the privileged know of an episode on a ground."""

    def __init__(self, ground: Ground, episode: Episode):
        self._ground, self._goals = ground.imagined, episode.goals
        self._facing = episode.facing

    def distance_m(self, stance: Stance) -> float:
        """Return how far it is on foot to the nearest goal."""
        return self._ground.distance_m(stance, self._goals)

    def after(self, stance: Stance, move: Move) -> tuple[Stance, bool]:
        """Return where a move would lead."""
        return self._ground.after(stance, move)

    def expert(self, stance: Stance) -> tuple[Move, ...]:
        """Return the oracle's moves from here."""
        return self._ground.expert(stance, self._goals, self._facing)
