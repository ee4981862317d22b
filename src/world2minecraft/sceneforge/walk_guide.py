"""The way to a thing that a sentence names, through the room as it is edited now.

The planner of navigation answers: no model is asked. The names are those of ``w2m vln run``.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import apply, invert
from world2minecraft.core.types import BlockVolume, SceneObject
from world2minecraft.core.vocabulary import MIN_NAME_CONFIDENCE, read_vocabulary
from world2minecraft.formats.object_names import NamedObject
from world2minecraft.minecraftocc.scene_sources import SceneSource
from world2minecraft.navigation.landmarks import Landmark
from world2minecraft.navigation.running.sentence_goals import landmarks_named, phrases_of
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.scores.path_similarity import path_length_m

MAX_OFFERED = 4
MAX_CANDIDATES = 8  # Objects of one name whose paths are compared.
PLAIN_TEMPLATES = ("box",)  # They stand for anything.
LIKE = 0.6  # Minimum similarity of a suggested name.
REACH_M = 2.5  # From a body off the floor, such as on a table, to the floor; height counts twice.
Feet = tuple[float, float, float]
_SMALL_TALK = re.compile(
    r"^(?:please |can you |could you )*"
    r"(?:(?:go|walk|run|come|lead me|take me|show me|where is|where's|find)\b\s*)?"
    r"(?:over )?(?:to )?(?:the |a |an |my )?"
)


@dataclass(frozen=True, eq=False)
class EditedSource(SceneSource):
    """An edited scene as a source of navigation: its blocks, and the names of its objects."""

    blocks: BlockVolume | None = None
    objects: tuple[SceneObject, ...] = ()

    def volume(self) -> BlockVolume:
        """Return the blocks."""
        if self.blocks is None:
            raise ValueError("an edited source needs blocks")
        return self.blocks

    def designs(self) -> tuple[np.ndarray, tuple[str, ...]]:
        """Return no designs: ``names`` has what the furniture shows."""
        return np.zeros(self.volume().states.shape, np.uint16), ("",)

    def names(self) -> tuple[NamedObject, ...]:
        """Return the name of each object, or of what its furniture shows, where that is known."""
        return tuple(_named(one) for one in self.objects if _name_of(one))

    def start(self) -> None:
        """Return no start: a walk begins where the person stands."""
        return


def _named(one: SceneObject) -> NamedObject:
    return NamedObject(one.id, one.class_id, _name_of(one), 1.0)


def _name_of(one: SceneObject) -> str:
    if one.name and one.name_confidence >= MIN_NAME_CONFIDENCE:
        return one.name
    template = one.placements[0].template if one.placements else ""
    entry = None if template in PLAIN_TEMPLATES else read_vocabulary().of_template(template)
    return entry.name if entry is not None and entry.class_id == one.class_id else ""


class WalkGuide:
    """Leads through a build of a scene.

    Args:
        volume: The blocks.
        objects: The objects of the scene.
        name: The name of the scene.

    Raises:
        InputError: If there is no floor to stand on.
    """

    def __init__(self, volume: BlockVolume, objects: Sequence[SceneObject], name: str):
        source = EditedSource(Path(name), name, blocks=volume, objects=tuple(objects))
        self.scene = VlnScene(source)

    def answer(self, sentence: str, feet_m: Feet) -> dict[str, Any]:
        """Return the way to what a sentence names, as ``Way`` of ``web/src/walk/ask.ts``.

        Args:
            sentence: What a person typed, such as ``go to the lamp``.
            feet_m: Where the person stands, in metres of the room.

        Returns:
            ``thing``, ``of`` (how many things have this name; the nearest is chosen), ``away_m``
            and ``corners_m``. Without a way, the last two are None. Without a thing of this name,
            ``thing`` is None, and ``near`` lists names that may have been meant.
        """
        found = self.named(sentence)
        if not found:
            subject = subject_of(sentence)
            near = names_like(subject, self.scene.landmarks)
            return {"thing": None, "subject": subject, "near": near}
        feet = apply(invert(self.scene.volume.block_to_room), np.array([feet_m], np.float64))[0]
        ways = [self._way(one, feet) for one in found]
        away = [np.inf if way is None else path_length_m(way) for way in ways]
        best = int(np.argmin(away))
        way, one = ways[best], found[best]
        return {
            "thing": {"id": one.number, "name": one.name, "center_m": _rounded(one.center_m)},
            "of": len(found),
            "away_m": None if way is None else round(path_length_m(way), 2),
            "corners_m": None if way is None else _rounded(way),
        }

    def named(self, sentence: str) -> list[Landmark]:
        """Return what a sentence names; ``sofa 2`` is the object with that id, as it is listed."""
        found = landmarks_named(self.scene.landmarks, sentence)
        number = re.search(r"(\d+)\W*$", sentence)
        listed = [one for one in found if number and one.number == int(number[1])]
        return (listed or found)[:MAX_CANDIDATES]

    def _way(self, thing: Landmark, feet: np.ndarray) -> np.ndarray | None:
        """Return the corners of the shortest way in metres, float64 [N, 3], or None."""
        scene = self.scene
        turns = scene.turning_places(goals_of(scene, thing))
        graph = scene.corner_graph.feet
        apart = (graph - feet) * scene.metres_per_block * [1, 2, 1]
        away = np.where(turns < 0, np.inf, np.linalg.norm(apart, axis=1))
        here = int(away.argmin())
        if away[here] > REACH_M:
            return None
        corners = [feet, graph[here]]
        while turns[here] != here:
            here = int(turns[here])
            corners.append(graph[here])
        return scene.to_room_m(np.array(corners))


def goals_of(scene: VlnScene, thing: Landmark) -> tuple[Feet, ...]:
    """Return where to stand before a thing, or else the place of the floor nearest to it."""
    if goals := scene.goals_at(thing):
        return goals
    feet = scene.graph.feet[scene.main_places]
    away = np.linalg.norm(scene.to_room_m(feet) - thing.center_m, axis=1)
    x, y, z = feet[away.argmin()]
    return ((float(x), float(y), float(z)),)


def subject_of(sentence: str) -> str:
    """Return what a sentence is about.

    Example:
        >>> subject_of("Where is the fridge?"), subject_of("go")
        ('fridge', 'go')
    """
    plain = " ".join(re.sub(r"[^\w' -]+", " ", sentence.lower()).split())
    return _SMALL_TALK.sub("", plain) or plain


def names_like(subject: str, landmarks: Sequence[Landmark]) -> list[str]:
    """Return the names of landmarks that words may have meant, or else the shortest names."""
    scored = [
        (SequenceMatcher(None, subject, phrase).ratio(), one.name)
        for phrase, meant in phrases_of(landmarks).items()
        for one in meant
    ]
    near = [name for score, name in sorted(scored, key=lambda row: -row[0]) if score >= LIKE]
    plain = sorted(
        landmarks, key=lambda one: (not one.is_unambiguous, one.name.count(" "), one.name)
    )
    return list(dict.fromkeys(near or [one.name for one in plain]))[:MAX_OFFERED]


def _rounded(values: np.ndarray) -> Any:
    return np.round(values, 3).tolist()
