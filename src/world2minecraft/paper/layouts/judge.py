"""Grading of rooms by a vision-language model for realism, completeness and atmosphere, 1 to 10.

All methods are shown alike: built from the same blocks, from the same two corners, in the same
light. Each room is graded several times. A reply that cannot be parsed gives no grade, and a room
without grades has no score. The prompt is ``prompts/judge.md``. Its SHA-256, the model and the
SHA-256 of the images are stored with the grades, because grades of different models or prompts are
not comparable.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume
from world2minecraft.external_models.chat_client import ChatModel
from world2minecraft.external_models.chat_messages import Picture, Turn
from world2minecraft.external_models.structured_replies import (
    ReplyFormat,
    UnreadableError,
    ask_structured,
    extract_json_object,
)
from world2minecraft.rendering.output.images import colour_bytes
from world2minecraft.rendering.presentation.opened_room import OpenedBuild
from world2minecraft.rendering.presentation.shot_rendering import DrawOptions, draw_shots
from world2minecraft.rendering.presentation.turntable import OPEN_ELEVATION_DEG
from world2minecraft.rendering.scene import prepare_scene
from world2minecraft.rendering.shading_parameters import BACKDROP, NEUTRAL
from world2minecraft.rendering.views.cameras import camera_of
from world2minecraft.rendering.views.orbit import TURN_DEG, orbit_shots

ASPECTS = ("realism", "completeness", "atmosphere")
LEAST, MOST = 1, 10
REPEATS = 3  # The paper's evident source asks three times.
VIEWS = 2  # From opposite corners.
SIZE_PX = (768, 576)
FOV_DEG = 30.0
QUALITY = 90
PROMPT = "judge.md"


@dataclass(frozen=True)
class Grades:
    """The grades of one room, with a row per repetition, or None for an invalid reply."""

    name: str
    method: str
    rows: tuple[dict[str, int] | None, ...]
    pictures: tuple[str, ...]  # SHA-256 of each

    @property
    def unread(self) -> int:
        """The number of replies that could not be parsed."""
        return sum(row is None for row in self.rows)

    def mean(self, aspect: str) -> float | None:
        """Return the mean grade of an aspect, or None without grades."""
        told = [row[aspect] for row in self.rows if row is not None]
        return float(np.mean(told)) if told else None

    def told(self) -> dict[str, Any]:
        """Return the grades as JSON data."""
        return {
            "name": self.name,
            "method": self.method,
            "grades": list(self.rows),
            "mean": {aspect: self.mean(aspect) for aspect in ASPECTS},
            "unread": self.unread,
            "pictures": list(self.pictures),
        }


def prompt_text(name: str = PROMPT) -> str:
    """Return the text of a prompt file."""
    return (files("world2minecraft.paper.layouts") / "prompts" / name).read_text(encoding="utf-8")


def prompt_sum() -> str:
    """Return the SHA-256 of the judge's prompt."""
    return hashlib.sha256(prompt_text().encode()).hexdigest()


def pictures_of(volume: BlockVolume) -> list[Picture]:
    """Render the images of a room for the judge as JPEG."""
    build = OpenedBuild(volume)
    camera = camera_of(*SIZE_PX, vertical_fov_deg=FOV_DEG)
    shots = orbit_shots(
        build.whole, camera, VIEWS, elevation_deg=OPEN_ELEVATION_DEG, start_deg=TURN_DEG
    )
    how = DrawOptions(light=NEUTRAL, samples=2, background=BACKDROP)
    pictures = []
    for shot in shots:
        scene = prepare_scene(build.seen_by(shot.camera_to_room))
        picture = next(iter(draw_shots(scene, [shot], how)))
        if picture.colour is None:
            raise RuntimeError("the renderer returned no colour image")
        pictures.append(Picture(colour_bytes(picture.colour, ".jpg", QUALITY)))
    return pictures


def grade(
    model: ChatModel,
    name: str,
    method: str,
    pictures: Sequence[Picture],
    *,
    wish: str = "",
    repeats: int = REPEATS,
) -> Grades:
    """Ask a model to grade a room, without naming the method that created it.

    Args:
        model: The model. Cached replies cost nothing.
        name: The name of the scene, for the record.
        method: The method that created the scene, for the record.
        pictures: The images to show.
        wish: The description that all methods were given, or "".
        repeats: The number of repetitions.

    Raises:
        UsageError: If ``repeats`` is less than 1.
        ServerError: If the model cannot be queried.
        BudgetError: If the limit on calls or cost is reached.
    """
    if repeats < 1:
        raise UsageError(f"repeats must be 1 or more, got {repeats}")
    words = prompt_text()
    if wish:
        task = "The room should match this description; grade completeness by it."
        words += f"\n{task}\n\n{wish.strip()}\n"
    turns = (Turn("user", (words, *pictures)),)
    rows = [ask_structured(model, turns, FORM, sample=number).value for number in range(repeats)]
    return Grades(name, method, tuple(rows), tuple(one.sha256 for one in pictures))


def means_of(grades: Sequence[Grades]) -> dict[str, dict[str, tuple[float, float, int] | None]]:
    """Return the mean grade of each aspect by method, with its standard deviation and count.

    The standard deviation is that of the scene means. An aspect without grades is None.
    """
    result: dict[str, dict[str, tuple[float, float, int] | None]] = {}
    for method in dict.fromkeys(one.method for one in grades):
        row: dict[str, tuple[float, float, int] | None] = {}
        for aspect in ASPECTS:
            means = [one.mean(aspect) for one in grades if one.method == method]
            told = [mean for mean in means if mean is not None]
            row[aspect] = (float(np.mean(told)), float(np.std(told)), len(told)) if told else None
        result[method] = row
    return result


def read_grades(text: str) -> dict[str, int]:
    """Parse the grades of a reply.

    Raises:
        UnreadableError: If an aspect is missing, or is not an integer from 1 to 10.

    Example:
        >>> read_grades('{"realism": 7, "completeness": 6, "atmosphere": 8}')["atmosphere"]
        8
    """
    told = extract_json_object(text)
    if told is None:
        raise UnreadableError("the reply does not contain a JSON object")
    row = {}
    for aspect in ASPECTS:
        value = told.get(aspect)
        if isinstance(value, float) and value.is_integer():
            value = int(value)
        if type(value) is not int or not LEAST <= value <= MOST:
            raise UnreadableError(f"{aspect} must be an integer from {LEAST} to {MOST}")
        row[aspect] = value
    return row


_SCALE: dict[str, Any] = {"type": "integer", "enum": list(range(LEAST, MOST + 1))}
FORM: ReplyFormat[dict[str, int]] = ReplyFormat(
    "grades",
    {
        "type": "object",
        "properties": {"why": {"type": "string"}, **{aspect: _SCALE for aspect in ASPECTS}},
        "required": ["why", *ASPECTS],
        "additionalProperties": False,
    },
    'Reply with JSON alone: {"why": "one sentence", "realism": 1 to 10, "completeness": 1 to 10, '
    '"atmosphere": 1 to 10}.',
    read_grades,
)
