"""An agent that queries a vision-language model for its moves.

A reply that is still invalid after two repair attempts gives an invalid decision without moves, and
a server that does not answer gives a failed one. Neither is replaced by another move. The agent can
show the model its past positions, as text with distances from the start that odometry provides, or
as a floor plan of the building.
"""

import math
from collections.abc import Sequence
from io import BytesIO
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.external_models.chat_client import ChatModel
from world2minecraft.external_models.chat_messages import MAX_PX, Picture, check_max_px, downscale
from world2minecraft.external_models.chat_transport import BusyServerError, RefusedQuestionError
from world2minecraft.external_models.structured_replies import Attempt, ask_structured
from world2minecraft.navigation.agents.action_format import MAX_MOVES, step_form
from world2minecraft.navigation.agents.types import Decision, Observation, Task
from world2minecraft.navigation.agents.vlm_prompts import (
    MAPS,
    MAX_PAST_MOVES,
    MapKind,
    StepPrompt,
    step_turn,
    system_turn,
)
from world2minecraft.navigation.types import Move, Stance

MAX_PLACES = 12  # Positions in a text map, chosen evenly.
MIN_SPACING_M = 0.5  # Minimum distance between two positions in a text map.
JPEG_QUALITY = 85
HISTORY = 3  # Previous images, as in the paper.
MAX_HISTORY = 8
MAX_PROGRESS_CHARACTERS = 400  # Characters of its progress notes that a model is shown again.


def relative_m(start: Stance, stance: Stance, metres_per_block: float) -> tuple[float, float]:
    """Return how far a stance is ahead and to the right of the start, in metres.

    Example:
        >>> relative_m(Stance(0, 64, 0, 90), Stance(-4, 64, 0, 0), 0.25)  # Yaw 90 looks west.
        (1.0, 0.0)
    """
    yaw = math.radians(start.yaw_deg)
    x, z = stance.x - start.x, stance.z - start.z
    ahead = -math.sin(yaw) * x + math.cos(yaw) * z
    right = -math.cos(yaw) * x - math.sin(yaw) * z
    return (
        round(ahead * metres_per_block, 2) + 0.0,
        round(right * metres_per_block, 2) + 0.0,
    )


def facing(start: Stance, stance: Stance) -> str:
    """Describe a stance's heading relative to the heading at the start.

    Example:
        >>> facing(Stance(0, 0, 0, 170), Stance(0, 0, 0, -100))
        '90 degrees right of the start'
    """
    turned = (stance.yaw_deg - start.yaw_deg + 180) % 360 - 180
    if abs(turned) < 0.5:
        return "as at the start"
    if abs(turned) > 179.5:
        return "back"
    return f"{abs(turned):.0f} degrees {'right' if turned > 0 else 'left'} of the start"


def trail_text(stances: Sequence[Stance], metres_per_block: float) -> str:
    """Describe the visited positions and the current heading as text for the model."""
    start, here = stances[0], stances[-1]
    retained = [0]
    for number, stance in enumerate(stances):
        last = stances[retained[-1]]
        away = math.dist(stance.feet, last.feet) * metres_per_block
        if away >= MIN_SPACING_M:
            retained.append(number)
    if len(retained) > MAX_PLACES:
        last_index = len(retained) - 1
        retained = [retained[round(i * last_index / (MAX_PLACES - 1))] for i in range(MAX_PLACES)]
    lines = []
    for place, number in enumerate(retained):
        ahead, right = relative_m(start, stances[number], metres_per_block)
        lines.append(f"Place {place}: {_place(ahead, right)} (move {number})")
    ahead, right = relative_m(start, here, metres_per_block)
    lines.append(f"You are {_place(ahead, right)} and look {facing(start, here)}.")
    return "\n".join(lines)


def _place(ahead: float, right: float) -> str:
    if not ahead and not right:
        return "at the start"
    words = []
    if ahead:
        words.append(f"{abs(ahead):g} m {'ahead of' if ahead > 0 else 'behind'} the start")
    if right:
        words.append(f"{abs(right):g} m to its {'right' if right > 0 else 'left'}")
    return ", ".join(words)


class VlmAgent:
    """An agent that queries a vision-language model at each step.

    Args:
        model: The model to query.
        chunk: The maximum number of moves per reply, 1 to 4.
        history: The number of previous views to show, 0 to 8.
        map_kind: "none", "text" for a description of the visited positions, or "plan" for a floor
            plan of the building with the path so far, which contains more than the agent has seen.
        max_px: The maximum number of pixels of an image. Larger images are downscaled.
    """

    is_privileged = is_blind = False

    def __init__(
        self,
        model: ChatModel,
        *,
        chunk: int = MAX_MOVES,
        history: int = HISTORY,
        map_kind: MapKind = "none",
        max_px: int = MAX_PX,
    ):
        if not 1 <= chunk <= MAX_MOVES:
            raise UsageError(f"chunk must be 1 to {MAX_MOVES} moves, got {chunk}")
        if not 0 <= history <= MAX_HISTORY:
            raise UsageError(f"history must be 0 to {MAX_HISTORY} images, got {history}")
        if map_kind not in MAPS:
            raise UnknownNameError("map", map_kind, MAPS)
        check_max_px(max_px)
        self.name, self.model = model.name, model
        self.chunk, self.history, self.map_kind = chunk, history, map_kind
        self.max_px = max_px
        self._form = step_form(chunk)
        self._task: Task | None = None
        self._forget()

    def begin(self, task: Task) -> None:
        """Start a task and discard the history of the previous one."""
        self._task = task
        self._forget()

    def decide(self, sight: Observation) -> Decision:
        """Query the model with the current view and return its decision.

        Raises:
            BudgetError: If the limit on calls or cost is reached.
            ServerError: If the API key or the server address is wrong.
        """
        task = self._task
        if task is None:
            raise UsageError("call begin(task) before decide(sight)")
        self._stances.append(sight.stance)
        self._done = (self._done + list(sight.done))[-MAX_PAST_MOVES:]
        moment = self._moment(task, sight)
        turns = (system_turn(task, self.chunk), step_turn(task, moment))
        self._views = [*self._views, moment.view][-self.history :] if self.history else []
        try:
            formed = ask_structured(self.model, turns, self._form)
        except (BusyServerError, RefusedQuestionError) as error:
            return Decision((), outcome="failed", details={"problem": str(error)})
        details = {"raw": formed.raw, "tries": [describe_try(one) for one in formed.tries]}
        if formed.value is None:
            self._rejected = formed.problem
            return Decision((), outcome="invalid", details={**details, "problem": formed.problem})
        self._rejected = ""
        self._progress = formed.value.progress[:MAX_PROGRESS_CHARACTERS] or self._progress
        step = formed.value
        return Decision(step.moves, step.thought, step.progress, details=details)

    def _moment(self, task: Task, sight: Observation) -> StepPrompt:
        map_text = ""
        if self.map_kind == "text":
            map_text = trail_text(self._stances, task.metres_per_block)
        plan = None
        if self.map_kind == "plan":
            if task.plan is None:
                raise UsageError(
                    "a floor plan is not available for this scene; choose another map kind"
                )
            plan = self._picture(task.plan(self._stances))
        return StepPrompt(
            sight.step, self._picture(sight.colour), tuple(self._views), tuple(self._done),
            self._progress, map_text, self._rejected, plan,
        )  # fmt: skip

    def _picture(self, colour: np.ndarray) -> Picture:
        return Picture(encode_jpeg(downscale(colour, self.max_px)))

    def _forget(self) -> None:
        self._views: list[Picture] = []
        self._stances: list[Stance] = []
        self._done: list[tuple[Move, bool]] = []
        self._progress = self._rejected = ""


def encode_jpeg(colour: np.ndarray) -> bytes:
    """Encode an image, uint8 [H, W, 3], as JPEG."""
    stream = BytesIO()
    Image.fromarray(colour).save(stream, "JPEG", quality=JPEG_QUALITY)
    return stream.getvalue()


def describe_try(tried: Attempt) -> dict[str, Any]:
    """Return the trace record of one query attempt as JSON data."""
    reply = tried.reply
    details: dict[str, Any] = {"rung": tried.rung, "key": tried.key, "problem": tried.problem}
    if reply is not None:
        details |= {
            "raw": reply.text,
            "tokens": [reply.prompt_tokens, reply.completion_tokens],
            "latency_s": reply.latency_s,
            "attempts": reply.attempts,
            "is_replayed": reply.is_replayed,
        }
    return details
