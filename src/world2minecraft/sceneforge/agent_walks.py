"""Walks of a model through the room as it is edited, one decision at a time.

The model sees what ``w2m vln run`` shows it: a view, the last views and the sentence. The page asks
for one decision after another, so a walk ends when nobody watches it.
"""

import os
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import apply, invert
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.external_models.chat_client import ChatModel, open_chat
from world2minecraft.external_models.chat_costs import find_price, read_prices
from world2minecraft.external_models.chat_transport import ENDPOINTS, resolve_endpoint
from world2minecraft.navigation.agents.types import Agent, Decision, Observation, Task
from world2minecraft.navigation.agents.vlm_agent import VlmAgent
from world2minecraft.navigation.running.episode_runner import MAX_SILENT_DECISIONS
from world2minecraft.navigation.running.simulator import SceneSimulator
from world2minecraft.navigation.types import Move, Stance
from world2minecraft.sceneforge.walk_guide import REACH_M, WalkGuide, goals_of

MAX_USD = 0.25  # For all walks of one editor, unless a limit is given.
MAX_CALLS = 500  # The same, for models without a known price.
MAX_STEPS = 120
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class WalkAgents:
    """The models that may walk in an editor.

    Attributes:
        names: The servers, as ``resolve_endpoint`` reads them.
        max_usd: The cost limit of each of them in US dollars, for as long as the editor runs. None
            sets ``MAX_USD``, or ``MAX_CALLS`` for a model without a known price.
    """

    names: tuple[str, ...] = ()
    max_usd: float | None = None

    def __post_init__(self):
        for name in self.names:
            resolve_endpoint(name)
        if self.max_usd is not None and not self.max_usd >= 0:
            raise UsageError(f"--max-usd must be 0 or more, got {self.max_usd}")

    @staticmethod
    def configured(chosen: str = "", max_usd: float | None = None) -> "WalkAgents":
        """Return the chosen model, and the cloud services whose API keys are set.

        Raises:
            UsageError: If the name or the limit is invalid.
            UnknownNameError: If the name is unknown.
        """
        keyed = [
            name for name, one in ENDPOINTS.items() if os.environ.get(one.key_name, "").strip()
        ]
        first = [chosen] if chosen else []
        return WalkAgents((*first, *(name for name in keyed if name != chosen)), max_usd)

    def open(self, name: str) -> ChatModel:
        """Open a model with its cost limit.

        Raises:
            UsageError: If the name is none of ``names``, or the limit cannot be enforced.
            ServerError: If the server cannot be reached or has several models.
        """
        if name not in self.names:
            known = ", ".join(self.names) or "none; start the editor with --agent NAME"
            raise UsageError(f"no model {name!r} is configured (configured: {known})")
        has_price = find_price(resolve_endpoint(name).model, read_prices()) is not None
        usd = MAX_USD if self.max_usd is None and has_price else self.max_usd
        return open_chat(name, max_usd=usd, max_calls=None if usd is not None else MAX_CALLS)


@dataclass(eq=False)
class AgentWalk:
    """One walk of an agent after a sentence.

    Attributes:
        guide: The room that is walked through.
        agent: The agent.
        sentence: What the agent is asked to do.
        feet_m: Where it starts, in metres of the room.
        look_m: The direction in which it looks first, in the axes of the room.

    Raises:
        InputError: If there is no floor near the start.
    """

    guide: WalkGuide
    agent: Agent
    sentence: str
    feet_m: Vector
    look_m: Vector
    steps: int = field(default=0, init=False)
    _silent: int = field(default=0, init=False)
    _done: tuple[tuple[Move, bool], ...] = field(default=(), init=False)

    def __post_init__(self):
        scene = self.guide.scene
        self._ground = SceneSimulator(scene)
        self._stance = self._first_stance()
        self.agent.begin(
            Task(
                self.sentence, self._ground.move_set, self._ground.step_m, MAX_STEPS,
                scene.metres_per_block, plan=self._ground.plan,
            )
        )  # fmt: skip

    def decide(self) -> dict[str, Any]:
        """Let the agent decide once, and return ``AgentStep`` of ``web/src/walk/agent.ts``.

        Raises:
            BudgetError: If the cost limit is reached.
            ServerError: If the model cannot be asked.
        """
        sight = Observation(self.steps, self._ground.view(self._stance), self._stance, self._done)
        decision = self.agent.decide(sight)
        stances, end = self._make(decision)
        return {
            "stances": [self._told(one) for one in stances],
            "thought": decision.thought or str(decision.details.get("problem", "")),
            "end": end,
            "steps": self.steps,
            "goal": self._goal() if end else None,
        }

    def _make(self, decision: Decision) -> tuple[list[Stance], str]:
        """Make the moves of a decision; return the stances after them, and how the walk ended."""
        stances, made = list[Stance](), list[tuple[Move, bool]]()
        self._silent = 0 if decision.moves else self._silent + 1
        self.steps += not decision.moves
        end = "gave up" if self._silent >= MAX_SILENT_DECISIONS else ""
        for move in decision.moves:
            if move == Move.STOP:
                end = "stopped"
                break
            self.steps += 1
            self._stance, collided = self._ground.step(self._stance, move)
            stances.append(self._stance)
            made.append((move, collided))
            if collided or self.steps >= MAX_STEPS:
                break
        self._done = tuple(made)
        return stances, end or ("out of steps" if self.steps >= MAX_STEPS else "")

    def _first_stance(self) -> Stance:
        scene = self.guide.scene
        to_blocks = invert(scene.volume.block_to_room)
        feet = apply(to_blocks, np.array([self.feet_m], np.float64))[0]
        graph = scene.corner_graph.feet
        away = np.linalg.norm((graph - feet) * scene.metres_per_block * [1, 2, 1], axis=1)
        if away.min() > REACH_M:
            raise InputError(scene.path, "nobody can stand there; walk to the floor first")
        x, _, z = to_blocks[:3, :3] @ np.array(self.look_m, np.float64)
        yaw_deg = float(np.degrees(np.arctan2(-x, z)))
        near = graph[away.argmin()]
        return Stance(float(near[0]), float(near[1]), float(near[2]), yaw_deg)

    def _told(self, stance: Stance) -> dict[str, Any]:
        yaw = np.radians(stance.yaw_deg)
        ahead = np.add(stance.feet, [-np.sin(yaw), 0, np.cos(yaw)])
        feet_m, ahead_m = self.guide.scene.to_room_m(np.array([stance.feet, ahead]))
        return {
            "feet_m": np.round(feet_m, 4).tolist(),
            "ahead_m": np.round(ahead_m, 4).tolist(),
        }

    def _goal(self) -> dict[str, Any] | None:
        """Return the nearest thing that the sentence names, and how far away it is."""
        scene, best = self.guide.scene, None
        for one in self.guide.named(self.sentence):
            away_m = scene.distance_m(self._stance.feet, goals_of(scene, one))
            if np.isfinite(away_m) and (best is None or away_m < best["away_m"]):
                best = {"id": one.number, "name": one.name, "away_m": round(away_m, 2)}
        return best


class WalkingModels:
    """The models of an editor, opened on first use, and the walk that is under way.

    Args:
        agents: The models that may walk.
    """

    def __init__(self, agents: WalkAgents):
        self.agents = agents
        self._models: dict[str, ChatModel] = {}
        self._walk: tuple[int, str, AgentWalk] | None = None
        self._number = 0

    def begin(
        self, guide: WalkGuide, name: str, sentence: str, feet_m: Vector, look_m: Vector
    ) -> int:
        """Begin a walk, which ends the one before it, and return its number."""
        if name not in self._models:
            self._models[name] = self.agents.open(name)
        agent = VlmAgent(self._models[name])
        self._number += 1
        self._walk = (self._number, name, AgentWalk(guide, agent, sentence, feet_m, look_m))
        return self._number

    def decide(self, number: int) -> dict[str, Any]:
        """Let the agent of a walk decide once; the cost so far stands beside its decision.

        Raises:
            UsageError: If the walk has ended or another one began.
            BudgetError: If the cost limit is reached.
            ServerError: If the model cannot be asked.
        """
        if self._walk is None or self._walk[0] != number:
            raise UsageError("this walk has ended; ask again to begin another one")
        _, name, walk = self._walk
        step = walk.decide()
        if step["end"]:
            self._walk = None
        ledger = self._models[name].ledger
        return {**step, "usd": ledger.usd, "calls": ledger.calls}
