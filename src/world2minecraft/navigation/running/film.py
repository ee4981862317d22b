"""The video of a walk: the view, the instruction, the agent's thoughts and a map with the path.

The video has one frame per move. Characters that the font does not contain are shown as question
marks, and texts that do not fit are truncated.
"""

from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from world2minecraft.navigation.agents.types import Decision, Observation
from world2minecraft.navigation.agents.vlm_prompts import MOVE_NAMES
from world2minecraft.navigation.running.episode_runner import EpisodeWalk
from world2minecraft.navigation.running.floor_map import SIDE_PX, PlanMap
from world2minecraft.navigation.running.simulator import Simulator
from world2minecraft.navigation.types import Episode, Move, Stance
from world2minecraft.rendering.output.animation import FrameWriter, animation_writer

FILM_FILE = "walk.mp4"
VIEW_PX = (640, 480)
BAND_PX = 56  # For the instruction, above.
SIZE_PX = (VIEW_PX[0] + SIDE_PX, VIEW_PX[1] + BAND_PX)
RATE_HZ = 6.0
HOLD_S = 2.0  # The first and the last frame stay.
INK, FAINT, PAPER, BAD = (24, 26, 30), (110, 112, 118), (248, 247, 244), (190, 30, 30)
LINE_PX = 17


class Film:
    """An observer that writes the video of an episode."""

    def __init__(self, path: Path, ground: Simulator, plan: PlanMap, rate_hz: float = RATE_HZ):
        self.path, self.ground, self.plan, self.rate_hz = path, ground, plan, rate_hz
        self._stack = ExitStack()
        self._write: FrameWriter | None = None
        self._stances: list[Stance] = []
        self._episode: Episode | None = None
        self._agent = ""
        self._last: Image.Image | None = None

    def on_begin(self, episode: Episode, agent: str) -> None:
        """Open the video file."""
        self._episode, self._agent, self._stances = episode, agent, []
        self._stack = ExitStack()
        self._write = self._stack.enter_context(animation_writer(self.path, self.rate_hz))

    def on_decision(
        self, sight: Observation, decision: Decision, made: Sequence[tuple[Move, bool]]
    ) -> None:
        """Ignore the decision, because frames are drawn for each move."""

    def on_stance(
        self, stance: Stance, step: int, decision: Decision | None, move: Move | None
    ) -> None:
        """Draw a frame for a stance."""
        if self._episode is None:
            return
        self._stances.append(stance)
        view = self.ground.view(stance)
        frame = compose(
            view,
            self.plan.picture(self._stances, self._episode.goals),
            self._episode.instruction.text,
            _caption(self._agent, step, self._episode.max_steps, decision, move),
        )
        self._send(frame, self.rate_hz * HOLD_S if decision is None else 1)

    def on_end(self, walk: EpisodeWalk) -> None:
        """Show the result of the walk on the last frame, and close the video."""
        if self._last is not None:
            self._send(with_end(self._last, end_text(walk)), self.rate_hz * HOLD_S)
        self._stack.close()
        self._write = None

    def drop(self) -> None:
        """Discard the video of an interrupted walk."""
        self._write = None
        error = RuntimeError("the walk was interrupted")
        self._stack.__exit__(RuntimeError, error, None)

    def _send(self, frame: Image.Image, times: float) -> None:
        self._last = frame
        if self._write is not None:
            for _ in range(max(1, round(times))):
                self._write(np.asarray(frame))


def compose(
    view: np.ndarray, plan: Image.Image, instruction: str, caption: Sequence[tuple[str, str]]
) -> Image.Image:
    """Compose a video frame.

    Args:
        view: The view of the agent as uint8 [H, W, 3].
        plan: The floor map, ``SIDE_PX`` wide and high.
        instruction: The instruction of the episode.
        caption: Lines with a heading, which may be empty, and a text.
    """
    frame = Image.new("RGB", SIZE_PX, PAPER)
    seen = Image.fromarray(view)
    if seen.size != VIEW_PX:
        seen = _fit_view(seen)
    frame.paste(seen, (0, BAND_PX))
    frame.paste(plan, (VIEW_PX[0], BAND_PX))
    draw = ImageDraw.Draw(frame)
    big = ImageFont.load_default(19)
    lines = wrap_text(instruction, big, SIZE_PX[0] - 24, 2)
    top = (BAND_PX - 23 * len(lines)) / 2
    for number, line in enumerate(lines):
        draw.text((12, top + 23 * number), line, INK, big)
    _write_caption(draw, caption)
    return frame


def with_end(frame: Image.Image, text: str) -> Image.Image:
    """Return a frame with a line of text across the bottom of the view."""
    final = frame.copy()
    draw = ImageDraw.Draw(final)
    top = SIZE_PX[1] - 40
    draw.rectangle((0, top, VIEW_PX[0] - 1, SIZE_PX[1]), INK)
    draw.text((12, top + 9), printable(text), PAPER, ImageFont.load_default(18))
    return final


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


def printable(text: str) -> str:
    """Collapse white space, and replace characters that the font lacks with question marks."""
    return "".join(mark if " " <= mark <= "ÿ" else "?" for mark in " ".join(text.split()))


def _truncate(
    text: str, font: "ImageFont.ImageFont | ImageFont.FreeTypeFont", width_px: float
) -> str:
    text = text[:400]
    while len(text) > 1 and font.getlength(text) > width_px:
        text = text[:-4] + "..." if len(text) > 4 else text[:-1]
        if font.getlength("...") > width_px or len(text) <= 4:
            return text[:1]
    return text


def _fit_view(seen: Image.Image) -> Image.Image:
    scale = min(VIEW_PX[0] / seen.width, VIEW_PX[1] / seen.height)
    size = (round(seen.width * scale), round(seen.height * scale))
    back = Image.new("RGB", VIEW_PX, INK)
    at = ((VIEW_PX[0] - size[0]) // 2, (VIEW_PX[1] - size[1]) // 2)
    back.paste(seen.resize(size, Image.Resampling.LANCZOS), at)
    return back


def _caption(
    agent: str, step: int, most: int, decision: Decision | None, move: Move | None
) -> list[tuple[str, str]]:
    lines = [("", f"{agent}   step {step} of {most}")]
    if decision is None:
        return lines
    if decision.outcome != "moves":
        lines.append((decision.outcome.upper(), str(decision.details.get("problem", ""))))
    elif move is not None:
        lines.append(("", f"now: {MOVE_NAMES[move]}"))
    return lines + [
        (name, text)
        for name, text in (("thought", decision.thought), ("progress", decision.progress))
        if text
    ]


def _write_caption(draw: ImageDraw.ImageDraw, caption: Sequence[tuple[str, str]]) -> None:
    font, left = ImageFont.load_default(14), VIEW_PX[0] + 10
    top, bottom = BAND_PX + SIDE_PX + 6, SIZE_PX[1] - 4
    for name, text in caption:
        line_text = f"{name}: {text}" if name else text
        colour = BAD if name.isupper() else FAINT if not name else INK
        most = max(1, (bottom - top) // LINE_PX)
        for line in wrap_text(line_text, font, SIDE_PX - 20, min(most, 4)):
            if top + LINE_PX > bottom:
                return
            draw.text((left, top), line, colour, font)
            top += LINE_PX
