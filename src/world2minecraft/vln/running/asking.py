"""An episode of a sentence: "Go to the piano", told in a scene, with the goal that it names."""

import re
from dataclasses import dataclass

from world2minecraft.errors import InputError, UsageError
from world2minecraft.vln.landmarks import Landmark
from world2minecraft.vln.scene import VlnScene
from world2minecraft.vln.values import Episode, Instruction, Stance

MAX_INSTRUCTION = 4000


@dataclass(frozen=True)
class Wish:
    """What is wished: the sentence, and the goal where the sentence does not say it."""

    instruction: str
    goal: str = ""
    start: Stance | None = None
    move_set: str = "vlnce"
    max_steps: int = 120


def episode_of(scene: VlnScene, wish: Wish) -> Episode:
    """Return the episode of a wish.

    Raises:
        UsageError: the sentence names no thing of the scene, or several things are called so.
        InputError: nobody can stand before the goal, or no way leads there.
    """
    if len(wish.instruction) > MAX_INSTRUCTION:
        raise UsageError(f"an instruction has at most {MAX_INSTRUCTION:,} characters")
    target = scene.landmark(wish.goal) if wish.goal else named_in(scene, wish.instruction)
    goals = scene.goals_at(target)
    if not goals:
        raise InputError(scene.path, f"nobody can stand before the {target.name}")
    start = scene.start if wish.start is None else _standing(scene, wish.start)
    if scene.distance_m(start.feet, goals) == float("inf"):
        raise InputError(scene.path, f"no way leads from the start to the {target.name}")
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
    )


def named_in(scene: VlnScene, sentence: str) -> Landmark:
    """Return the thing of a scene that a sentence names last; that is where it ends.

    Raises:
        UsageError: it names none, or what it names is several things.
    """
    names = {one.name.lower() for one in scene.landmarks}
    names |= {one.noun.lower() for one in scene.landmarks}
    text = " ".join(sentence.lower().split())
    spans = [
        (found.end(), -found.start(), name)
        for name in names
        for found in re.finditer(rf"(?<!\w){re.escape(name)}(?!\w)", text)
    ]
    if not spans:
        some = ", ".join(sorted(one.name for one in scene.landmarks)[:12]) or "nothing"
        raise UsageError(
            f"the instruction names no thing of {scene.scene_id}; give --goal NAME. It has {some}"
        )
    return scene.landmark(max(spans)[2])


def _standing(scene: VlnScene, wished: Stance) -> Stance:
    """Return the place of the floor nearest to a wished one, looking the wished way."""
    x, y, z = map(float, scene.graph.feet[scene.graph.nearest(wished.feet)])
    return Stance(x, y, z, wished.yaw_deg, wished.pitch_deg)
