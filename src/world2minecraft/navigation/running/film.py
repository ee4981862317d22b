"""The video of a walk: the agent's view, with instruction, plan and thoughts laid over it.

The camera eases from one stance to the next, and turns to the goal at the end. Characters that the
font does not contain are shown as question marks, and texts that do not fit are truncated.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont
from scipy.ndimage import gaussian_filter1d

from world2minecraft.navigation.agents.types import Decision, Observation
from world2minecraft.navigation.agents.vlm_prompts import MOVE_NAMES
from world2minecraft.navigation.running.episode_runner import EpisodeWalk
from world2minecraft.navigation.running.floor_map import PlanMap, printable
from world2minecraft.navigation.running.simulator import SceneSimulator
from world2minecraft.navigation.scene import camera_of
from world2minecraft.navigation.types import Episode, Move, Stance
from world2minecraft.rendering.output.animation import animation_writer

FILM_FILE = "walk.mp4"
SIZE_PX, FOV_DEG = (960, 540), 79.0  # The horizontal field of view of agents.
RATE_HZ = 20.0
WALK_S, TURN_S, WAIT_S = 0.3, 0.25, 0.15  # A step, a turn, and a move that changes nothing.
EASE_S = 0.12  # Standard deviation of the smoothing in time.
HOLD_S = 2.0  # Duration of the first and the last frame.
LOOK_S, LOOK_M = 1.0, 3.0  # Time of the final turn to a goal, and its maximum distance.
MAX_PITCH_DEG = 40.0
PLAN_PX, EDGE_PX = 190, 12
INK, PAPER, BAD = (24, 26, 30), (248, 247, 244), (255, 130, 120)
VEIL = (18, 20, 24, 165)  # Background of texts.
TEXT_PX, SMALL_PX = 21, 15


@dataclass(frozen=True)
class Moment:
    """A stance of a walk, the seconds that lead to it, and the texts at it.

    ``caption`` has lines with a heading, which may be empty, and a text.
    """

    stance: Stance
    seconds: float
    caption: tuple[tuple[str, str], ...]


class Film:
    """An observer that writes the video of an episode when the walk has ended."""

    def __init__(self, path: Path, ground: SceneSimulator, plan: PlanMap, rate_hz: float = RATE_HZ):
        self.path, self.ground, self.plan, self.rate_hz = path, ground, plan, rate_hz
        self._moments: list[Moment] = []
        self._episode: Episode | None = None
        self._agent = ""

    def on_begin(self, episode: Episode, agent: str) -> None:
        """Begin the film of an episode."""
        self._episode, self._agent, self._moments = episode, agent, []

    def on_decision(
        self, sight: Observation, decision: Decision, made: Sequence[tuple[Move, bool]]
    ) -> None:
        """Ignore the decision, because each move has a moment."""

    def on_stance(
        self, stance: Stance, step: int, decision: Decision | None, move: Move | None
    ) -> None:
        """Add a stance."""
        if self._episode is None:
            return
        before = self._moments[-1].stance if self._moments else None
        seconds = HOLD_S if before is None else _seconds(before, stance)
        caption = _caption(self._agent, step, self._episode.max_steps, decision, move)
        self._moments.append(Moment(stance, seconds, caption))

    def on_end(self, walk: EpisodeWalk) -> None:
        """Render the film, with the result of the walk on its last frames."""
        if self._episode is None or not self._moments:
            return
        moments, text = list(self._moments), end_text(walk)
        last = moments[-1]
        scale, eye = self.ground.metres_per_block, self.ground.scene.eye_blocks
        looked = look_at_goal(last.stance, self._episode, scale, eye)
        moments.append(Moment(looked, LOOK_S, (*last.caption, ("", text))))
        moments.append(Moment(looked, HOLD_S, (*last.caption, ("", text))))
        stances, numbers = eased_stances(moments, self.rate_hz)
        width, height = SIZE_PX
        camera = camera_of(width, height, FOV_DEG)
        goal = self._episode.facing or self._episode.goals[0]
        with animation_writer(self.path, self.rate_hz) as write:
            for frame, (stance, number) in enumerate(zip(stances, numbers, strict=True)):
                view = self.ground.view(stance, camera)
                plan = self.plan.picture(stances[: frame + 1], (goal,), self._episode.goal_name)
                caption = moments[number].caption
                write(np.asarray(compose(view, plan, self._episode.instruction.text, caption)))

    def drop(self) -> None:
        """Forget the film of an interrupted walk."""
        self._episode, self._moments = None, []


def _seconds(before: Stance, after: Stance) -> float:
    if before.feet != after.feet:
        return WALK_S
    return TURN_S if before != after else WAIT_S


def look_at_goal(
    stance: Stance, episode: Episode, metres_per_block: float, eye_blocks: float
) -> Stance:
    """Return a stance turned to the goal object, or unchanged if that is far or unknown.

    Goals below or above the eyes are looked at with up to ``MAX_PITCH_DEG``.
    """
    if episode.facing is None:
        return stance
    away = np.array(episode.facing) - stance.feet
    level = float(np.hypot(away[0], away[2]))
    if not 0.2 <= level * metres_per_block <= LOOK_M:
        return stance
    yaw = float(np.degrees(np.arctan2(-away[0], away[2])))
    down = float(np.degrees(np.arctan2(eye_blocks - away[1], level)))
    return Stance(*stance.feet, yaw, min(max(down, -MAX_PITCH_DEG), MAX_PITCH_DEG))


def eased_stances(moments: Sequence[Moment], rate_hz: float) -> tuple[list[Stance], list[int]]:
    """Return the stance of each frame, and the number of its moment.

    Stances are interpolated in time, turning the shorter way, and smoothed.

    Args:
        moments: Stances with the seconds that lead to them. The first is held.
        rate_hz: Frames per second.
    """
    seconds = np.array([one.seconds for one in moments])
    ends = np.cumsum(seconds)
    rows = np.array([[*one.stance.feet, one.stance.yaw_deg, one.stance.pitch_deg]
                     for one in moments])  # fmt: skip
    rows[:, 3] = np.degrees(np.unwrap(np.radians(rows[:, 3])))
    times = np.arange(max(1, round(float(ends[-1]) * rate_hz))) / rate_hz
    knots = np.concatenate([[0.0], ends])
    rows = np.concatenate([rows[:1], rows])
    smooth = np.stack([np.interp(times, knots, column) for column in rows.T], axis=1)
    smooth = gaussian_filter1d(smooth, EASE_S * rate_hz, axis=0, mode="nearest")
    numbers = np.minimum(np.searchsorted(ends, times, side="right"), len(moments) - 1)
    return [Stance(*row) for row in np.asarray(smooth).tolist()], numbers.tolist()


def compose(
    view: np.ndarray, plan: Image.Image, instruction: str, caption: Sequence[tuple[str, str]]
) -> Image.Image:
    """Compose a video frame of ``SIZE_PX``.

    Args:
        view: The view of the agent as uint8 [H, W, 3].
        plan: The square floor map, laid over the upper right corner.
        instruction: The instruction of the episode, laid over the bottom.
        caption: Lines with a heading, which may be empty, and a text, for the upper left corner.
    """
    frame = Image.new("RGB", SIZE_PX, INK)
    seen = Image.fromarray(view)
    seen.thumbnail(SIZE_PX, Image.Resampling.LANCZOS)
    frame.paste(seen, ((SIZE_PX[0] - seen.width) // 2, (SIZE_PX[1] - seen.height) // 2))
    inset = plan.resize((PLAN_PX, PLAN_PX), Image.Resampling.LANCZOS)
    left = SIZE_PX[0] - PLAN_PX - EDGE_PX
    frame.paste(inset, (left, EDGE_PX))
    veil = Image.new("RGBA", SIZE_PX)
    draw = ImageDraw.Draw(veil)
    outer = (left - 1, EDGE_PX - 1, left + PLAN_PX, EDGE_PX + PLAN_PX)
    draw.rectangle(outer, outline=(255, 255, 255, 220))
    _write_instruction(draw, instruction)
    _write_caption(draw, caption, left - 2 * EDGE_PX)
    return Image.alpha_composite(frame.convert("RGBA"), veil).convert("RGB")


def _write_instruction(draw: ImageDraw.ImageDraw, instruction: str) -> None:
    font, step = ImageFont.load_default(TEXT_PX), TEXT_PX + 5
    lines = wrap_text(instruction, font, SIZE_PX[0] - 4 * EDGE_PX, 2)
    top = SIZE_PX[1] - step * len(lines) - 2 * EDGE_PX
    draw.rectangle((0, top, *SIZE_PX), VEIL)
    for number, line in enumerate(lines):
        at = ((SIZE_PX[0] - font.getlength(line)) / 2, top + EDGE_PX + step * number)
        draw.text(at, line, PAPER, font)


def _write_caption(
    draw: ImageDraw.ImageDraw, caption: Sequence[tuple[str, str]], width_px: int
) -> None:
    font, step = ImageFont.load_default(SMALL_PX), SMALL_PX + 4
    lines: list[tuple[str, tuple[int, int, int]]] = []
    for name, text in caption:
        colour = BAD if name.isupper() else PAPER
        shown = f"{name}: {text}" if name else text
        lines += [(line, colour) for line in wrap_text(shown, font, width_px - 2 * EDGE_PX, 3)]
    lines = lines[:7]
    if not lines:
        return
    widest = max(font.getlength(line) for line, _ in lines)
    box = (EDGE_PX, EDGE_PX, 3 * EDGE_PX + widest, EDGE_PX + step * len(lines) + EDGE_PX)
    draw.rectangle(box, VEIL)
    for number, (line, colour) in enumerate(lines):
        at = (2 * EDGE_PX, EDGE_PX + EDGE_PX / 2 + step * number)
        draw.text(at, line, colour, font)


def end_text(walk: EpisodeWalk) -> str:
    """Return a one-line summary of a walk."""
    left = walk.score.ne_m
    where = f"{left:.2f} m from the goal" if np.isfinite(left) else "with no path to the goal"
    how = {"stopped": "Stopped", "out of steps": "Out of steps"}.get(walk.end, "Gave up")
    return f"{how} {where} after {walk.steps} steps, {walk.score.length_m:.1f} m walked"


def wrap_text(
    text: str, font: "ImageFont.ImageFont | ImageFont.FreeTypeFont", width_px: float, most: int
) -> list[str]:
    """Wrap a text to a width, truncating it after ``most`` lines."""
    lines: list[str] = []
    line = ""
    for word in printable(text).split():
        tried = f"{line} {word}".strip()
        if font.getlength(tried) <= width_px or not line:
            line = _truncate(tried, font, width_px)
            continue
        lines.append(line)
        line = _truncate(word, font, width_px)
        if len(lines) == most:
            lines[-1] = _truncate(f"{lines[-1]} ...", font, width_px)
            return lines
    return [*lines, line] if line else lines


def _truncate(
    text: str, font: "ImageFont.ImageFont | ImageFont.FreeTypeFont", width_px: float
) -> str:
    text = text[:400]
    while len(text) > 1 and font.getlength(text) > width_px:
        text = text[:-4] + "..." if len(text) > 4 else text[:-1]
        if font.getlength("...") > width_px or len(text) <= 4:
            return text[:1]
    return text


def _caption(
    agent: str, step: int, most: int, decision: Decision | None, move: Move | None
) -> tuple[tuple[str, str], ...]:
    lines = [("", f"{agent}   step {step} of {most}")]
    if decision is None:
        return tuple(lines)
    if decision.outcome != "moves":
        lines.append((decision.outcome.upper(), str(decision.details.get("problem", ""))))
    elif move is not None:
        lines.append(("", f"now: {MOVE_NAMES[move]}"))
    thoughts = (("thought", decision.thought), ("progress", decision.progress))
    return (*lines, *((name, text) for name, text in thoughts if text))
