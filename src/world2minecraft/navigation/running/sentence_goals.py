"""Episodes for a single instruction, such as "Go to the piano", with the goal that it names."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.classes import SemanticClass, display_name
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.vocabulary import read_vocabulary
from world2minecraft.navigation.episodes import target_of
from world2minecraft.navigation.landmarks import UNSPECIFIC_NOUNS, Landmark
from world2minecraft.navigation.moves import wrap_yaw
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.types import Episode, Instruction, Stance

MAX_INSTRUCTION = 4000
# Other classes, such as furniture and object, do not identify the kind of an object.
NAMED_CLASSES = frozenset(
    {
        SemanticClass.CHAIR,
        SemanticClass.BED,
        SemanticClass.SOFA,
        SemanticClass.TABLE,
        SemanticClass.TVS,
    }
)
MIN_START_M = 2.0  # Minimum walking distance from the default start to the goal.
YAW_STEP_DEG = 15.0  # The turn angle of most move sets.


@dataclass(frozen=True)
class GoalRequest:
    """An instruction in a scene, with optional goal and start.

    Attributes:
        instruction: The instruction text.
        goal: The goal landmark. If empty, it is taken from the instruction.
        start: The start. None uses the scene's start, or one far from the goal if it is near.
        move_set: The name of the move set.
        max_steps: The maximum number of steps.
    """

    instruction: str
    goal: str = ""
    start: Stance | None = None
    move_set: str = "vlnce"
    max_steps: int = 120


def episode_of_sentence(scene: VlnScene, wish: GoalRequest) -> Episode:
    """Return the episode of an instruction.

    Raises:
        UsageError: If the instruction names no landmark of the scene, or an ambiguous one.
        InputError: If the goal has no free floor in front of it, or cannot be reached.
    """
    if len(wish.instruction) > MAX_INSTRUCTION:
        count = len(wish.instruction)
        raise UsageError(
            f"an instruction must have at most {MAX_INSTRUCTION:,} characters, got "
            f"{count:,}; shorten it"
        )
    target = find_named_landmark(scene, wish.goal or wish.instruction)
    goals = scene.goals_at(target)
    if not goals:
        raise InputError(
            scene.path,
            f"the {target.name} has no free floor in front of it; name another goal, or "
            "clear space there",
        )
    start = _default_start(scene, goals) if wish.start is None else _snap_start(scene, wish.start)
    if scene.distance_m(start.feet, goals) == float("inf"):
        raise InputError(
            scene.path,
            f"no path leads from the start to the {target.name}; choose another start (--start "
            "X,Y,Z)",
        )
    return Episode(
        episode_id="wish",
        scene=scene.path,
        scene_id=scene.scene_id,
        start=start,
        goals=goals,
        goal_name=target.name,
        instruction=Instruction(wish.instruction, "human", "goal", (target.name,)),
        move_set=wish.move_set,
        max_steps=wish.max_steps,
        split="val_unseen",
        facing=target_of(scene, target, goals).point,
    )


def find_named_landmark(scene: VlnScene, sentence: str) -> Landmark:
    """Return the landmark that a sentence names last, which is the goal.

    The last words of a noun suffice, such as "piano" for an upright piano. Where no noun has a
    word, it may name a class, such as "table" for a desk.

    Raises:
        UsageError: If the sentence names no landmark, or an ambiguous one.
    """
    phrase, named = _last_phrase(scene.landmarks, sentence)
    if not named:
        some = ", ".join(sorted(one.name for one in scene.landmarks)[:12]) or "nothing"
        raise UsageError(
            f"no object of {scene.scene_id} matches {_plain(sentence)[:60]!r}; known objects: "
            f"{some}"
        )
    if len(named) > 1:
        some = ", ".join(repr(one.name) for one in named[:6])
        raise UsageError(
            f"{phrase!r} matches {len(named)} objects; use one of {some}, or name the "
            "goal (--goal NAME)"
        )
    return named[0]


def landmarks_named(landmarks: Sequence[Landmark], sentence: str) -> list[Landmark]:
    """Return the landmarks that a sentence names last, by the rules of ``find_named_landmark``.

    There is none if no name matches, and there are several if the name is ambiguous.
    """
    return _last_phrase(landmarks, sentence)[1]


def _last_phrase(landmarks: Sequence[Landmark], sentence: str) -> tuple[str, list[Landmark]]:
    text, named = _plain(sentence), phrases_of(landmarks)
    spans = [
        (found.end(), -found.start(), phrase)
        for phrase in named
        for found in re.finditer(rf"(?<!\w){re.escape(phrase)}(?!\w)", text)
    ]
    phrase = max(spans)[2] if spans else ""
    return phrase, named.get(phrase, [])


def _plain(sentence: str) -> str:
    return " ".join(sentence.lower().split())


def phrases_of(landmarks: Sequence[Landmark]) -> dict[str, list[Landmark]]:
    """Map phrases to landmarks.

    Full names come first, then nouns, their last words, classes, and the words of the vocabulary
    for what a design shows, such as armchair and recliner.
    """
    vocabulary = read_vocabulary()
    words_of: dict[str, list[Landmark]] = {}
    classes: dict[str, list[Landmark]] = {}
    names: dict[str, list[Landmark]] = {}
    nouns: dict[str, list[Landmark]] = {}
    ends: dict[str, list[Landmark]] = {}
    for one in landmarks:
        names.setdefault(one.name.lower(), []).append(one)
        nouns.setdefault(one.noun.lower(), []).append(one)
        entry = vocabulary.find(one.noun) or vocabulary.of_template(one.design)
        # The entry "object" has hundreds of labels, most of which do not fit this object.
        if entry is not None and one.noun not in UNSPECIFIC_NOUNS:
            for word in (entry.name, *entry.labels):
                words_of.setdefault(word, []).append(one)
        if one.class_id in NAMED_CLASSES:
            classes.setdefault(display_name(one.class_id), []).append(one)
        words = one.noun.lower().split()
        for n in range(1, len(words)):
            ends.setdefault(" ".join(words[n:]), []).append(one)
    return {**words_of, **classes, **ends, **nouns, **names}


def _default_start(scene: VlnScene, goals: Sequence[tuple[float, float, float]]) -> Stance:
    """Return the scene's start, or the place farthest from the goal if the start is beside it.

    It faces the middle of the floor instead of the nearest wall.
    """
    start, floor = scene.start, scene.graph.feet[scene.main_places]
    if scene.distance_m(start.feet, goals) < MIN_START_M:
        away_m = scene.distances_m(goals)[scene.main_places]
        farthest = int(np.where(np.isfinite(away_m), away_m, -1.0).argmax())
        start = Stance(*map(float, floor[farthest]))
    x, _, z = floor.mean(axis=0) - np.array(start.feet)
    yaw_deg = math.degrees(math.atan2(-x, z))
    return replace(start, yaw_deg=wrap_yaw(YAW_STEP_DEG * round(yaw_deg / YAW_STEP_DEG)))


def _snap_start(scene: VlnScene, wished: Stance) -> Stance:
    """Return the floor position nearest to the requested start, with the requested heading."""
    floor = scene.graph.feet[scene.main_places]
    away = ((floor - np.array(wished.feet)) ** 2).sum(axis=1)
    x, y, z = map(float, floor[away.argmin()])
    return Stance(x, y, z, wished.yaw_deg, wished.pitch_deg)
