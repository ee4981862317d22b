"""The agent that is a vision-language model: it looks, replies with moves, and makes them.

A reply that cannot be read after two repairs is INVALID: a decision without moves, reported as
such. A server that does not answer makes a failed one. Neither is ever replaced by a move of ours.
The agent may be shown where it has been: in words that it could have counted itself (metres ahead
of the start and to its side), which is what odometry knows, or as a plan of the building.
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
    MapKind,
    StepPrompt,
    step_turn,
    system_turn,
)
from world2minecraft.navigation.types import Move, Stance

MAX_PLACES = 12  # Of a map in words; those between are left out evenly.
MIN_SPACING_M = 0.5  # Places nearer to the last one are the same place.
JPEG_QUALITY = 85
HISTORY = 3  # Pictures before the one of now, as the paper shows them.
MAX_HISTORY = 8
MAX_PROGRESS_CHARACTERS = 400  # Characters of its own words that a model is told again.
MAX_PAST_MOVES = 16


def relative_m(start: Stance, stance: Stance, metres_per_block: float) -> tuple[float, float]:
    """Return how far a stance is ahead of the start and to its right, metres.

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
    """Return where one looks, by the direction of the start.

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
    """Return a map in words: the places that were visited, the last one where one stands."""
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
    """Asks a language model at each step.

    Args:
        model: whom to ask.
        chunk: how many moves it may give at once, 1 to 4.
        history: how many views of before it is shown, 0 to 8.
        map_kind: ``text`` tells it in words where it was; ``plan`` shows it a plan of the building
            with its way, which is more than its eyes know.
        max_px: pixels of a picture that it is shown; larger ones are made smaller.
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
            raise UsageError(f"a model gives 1 to {MAX_MOVES} moves at once, not {chunk}")
        if not 0 <= history <= MAX_HISTORY:
            raise UsageError(f"a model is shown 0 to {MAX_HISTORY} views of before, not {history}")
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
        """Take a task and forget the one before."""
        self._task = task
        self._forget()

    def decide(self, sight: Observation) -> Decision:
        """Look, ask, and return what the model does.

        Raises:
            BudgetError: a cap is reached. ServerError: the key or the address is wrong.
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
                raise UsageError("no plan of this scene can be drawn; ask for another map")
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
    """Return a picture, uint8 [H, W, 3], as JPEG."""
    stream = BytesIO()
    Image.fromarray(colour).save(stream, "JPEG", quality=JPEG_QUALITY)
    return stream.getvalue()


def describe_try(tried: Attempt) -> dict[str, Any]:
    """Return a try for the trace."""
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
