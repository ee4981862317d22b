"""The two tasks of a set, Next-Action and Next-View.

Next-Action asks which of four actions comes next. Each walk contributes one image per action, so
all answers are equally likely, even given the instruction. A model that ignores the images scores
25 percent.

Next-View asks which of four images comes next. Its distractors have three grades of difficulty::

    easy    two views from elsewhere in the scene, one from another scene
    medium  elsewhere, another time of the same walk, the next position with another heading, a step
            to the side
    hard    also views after a different move, and after the mirrored walk

The correct view often resembles the current view more than random distractors do. To avoid this
shortcut, a random number of distractors, from zero to three, resemble the current view more than
the correct option does, as far as suitable images exist. A distractor never has nearly the same
stance or image hash as the correct option, and never repeats an image of the question.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.navigation.data.distractors import (
    CHOICES,
    RENDERED_KINDS,
    DistractorPicker,
    DistractorSampler,
    DistractorSlot,
    RankBalancer,
    is_valid_choice,
)
from world2minecraft.navigation.data.keyframes import ACTIONS, KeyframeMark
from world2minecraft.navigation.data.picture_store import (
    PictureStore,
    StoredPicture,
    has_detail,
    picture_difference,
    show_different_views,
)
from world2minecraft.navigation.types import LETTERS, Instruction, Item, Move, Option, Trajectory

HISTORY = 3  # Images that are shown; the last is the current one.
# Kinds of rendered distractors, and the kinds used where none can be rendered, by grade.
RENDERED_OF = {"easy": (), "medium": ("turned", "beside"), "hard": RENDERED_KINDS}
FOUND_OF = {
    "easy": ("elsewhere", "elsewhere", "other_scene"),
    "medium": ("elsewhere", "temporal", "elsewhere"),
    "hard": ("temporal", "temporal", "elsewhere"),
}
# Rendered distractors that resemble the current view less than the correct option, by grade.
MAX_FAR = {"easy": 0, "medium": 1, "hard": 3}
GRADES = tuple(RENDERED_OF)
GRADE_SHARES = (0.1, 0.45, 0.45)  # In easy questions, the most similar image is mostly correct.
TEMPORAL_OFFSETS = (2, 3, 4, -3, -4)  # From the current keyframe to images that are not shown.


def action_steps(
    marks: Sequence[KeyframeMark],
    clear: Sequence[int],
    rng: np.random.Generator,
    balanced: bool = True,
) -> list[int]:
    """Return the keyframes to ask about, in ascending order.

    Args:
        marks: The keyframes of the walk.
        clear: The keyframes whose next action follows from the instruction.
        rng: The random generator.
        balanced: Whether to return one keyframe per action, or none if an action is missing. If
            False, all clear keyframes are returned.
    """
    if not balanced:
        return list(clear)
    by_move = {move: [n for n in clear if marks[n].move == move] for move in Move}
    if not all(by_move.values()):
        return []
    return sorted(int(rng.choice(steps)) for steps in by_move.values())


def action_item(
    trajectory: Trajectory,
    instruction: Instruction,
    pictures: Sequence[StoredPicture],
    step: int,
    letter: str,
    rng: np.random.Generator,
    *,
    composition: str,
    oracle_version: str,
) -> Item:
    """Return the Next-Action item of a keyframe.

    Args:
        trajectory: The trajectory.
        instruction: The instruction of the item.
        pictures: The images of all keyframes.
        step: The index of the keyframe.
        letter: The letter of the correct action.
        rng: The random generator for the order of the other actions.
        composition: "base" or "extend".
        oracle_version: The version of the code that planned the moves.
    """
    frame = trajectory.keyframes[step]
    wrong = [action for action in ACTIONS.values() if action != frame.move]
    mixed = [wrong[n] for n in rng.permutation(len(wrong))]
    mixed.insert(LETTERS.index(letter), frame.move)
    options = tuple(
        Option(LETTERS[n], "positive" if text == frame.move else "action", text)
        for n, text in enumerate(mixed)
    )
    before = trajectory.keyframes[step - 1].move if step else ""
    extra = {
        "gold": frame.move,
        "gold_chunk": [int(move) for move in frame.chunk],
        "progress": round(step / (len(pictures) - 1), 4),
        "previous": before,
    }
    return Item(
        f"{trajectory.trajectory_id}_a{step:02d}", "next_action", trajectory.scene_id,
        trajectory.trajectory_id, step, instruction, (), pictures[step].image, options, letter,
        trajectory.split, composition, trajectory.metres_per_block, oracle_version,
        {pictures[step].image: pictures[step].sha256}, extra,
    )  # fmt: skip


@dataclass(frozen=True)
class ViewQuestion:
    """A Next-View question before its distractors from elsewhere are chosen."""

    trajectory_id: str
    step: int
    grade: str
    slots: tuple[DistractorSlot, ...]


def view_steps(clear: Sequence[int], pictures: Sequence[StoredPicture]) -> list[int]:
    """Return the clear steps that have enough previous images and a next image.

    Steps at which the current or the next view shows little more than a bare wall are omitted.

    Args:
        clear: The keyframes whose next action follows from the instruction.
        pictures: The images of all keyframes.
    """
    fit = [step for step in clear if HISTORY - 1 <= step < len(pictures) - 1]
    return [step for step in fit if all(map(has_detail, pictures[step : step + 2]))]


def view_question(
    trajectory_id: str,
    marks: Sequence[KeyframeMark],
    pictures: Sequence[StoredPicture],
    step: int,
    grade: str,
    album: PictureStore,
    scout: DistractorSampler,
    ranks: RankBalancer,
    rng: np.random.Generator,
) -> ViewQuestion:
    """Return a Next-View question with its rendered distractors.

    Args:
        trajectory_id: The ID of the trajectory.
        marks: The keyframes of the walk.
        pictures: The images of the keyframes.
        step: The index of the current keyframe.
        grade: One of ``GRADES``.
        album: The store in which distractors are rendered.
        scout: The sampler of stances for distractors.
        ranks: The balancer of the number of distractors that resemble the current view most.
        rng: The random generator.
    """
    count, right = ranks.wanted(), pictures[step + 1]
    places = [
        (kind, stance)
        for kind in RENDERED_OF[grade]
        for stance in scout.places(kind, marks, step)
        if show_different_views(stance, right.stance, scout.metres_per_block)
    ]
    shuffled = [places[n] for n in rng.permutation(len(places))]
    plan = [DistractorSlot(kind, n < count) for n, kind in enumerate(FOUND_OF[grade])]
    slots = DistractorPicker(album, pictures[step], right).filled(plan, shuffled, MAX_FAR[grade])
    if grade != "easy":  # Without a suitable rendered image, any other one is accepted.
        slots = [slot if slot.picture else replace(slot, nearer=False) for slot in slots]
    ranks.came(sum(slot.nearer for slot in slots))
    return ViewQuestion(trajectory_id, step, grade, tuple(slots))


def view_item(
    question: ViewQuestion,
    trajectory: Trajectory,
    instruction: Instruction,
    pictures: Sequence[StoredPicture],
    elsewhere: Iterable[StoredPicture],
    other_scene: Iterable[StoredPicture],
    letter: str,
    rng: np.random.Generator,
    *,
    composition: str,
    oracle_version: str,
) -> Item | None:
    """Return the item of a Next-View question, or None if too few distractors are available.

    Args:
        question: The result of ``view_question``.
        trajectory: The trajectory of the question.
        instruction: The instruction of the item.
        pictures: The images of all keyframes.
        elsewhere: Images of other trajectories in the scene and split, in order of preference.
        other_scene: Images of another scene of the split, in order of preference.
        letter: The letter of the correct image.
        rng: The random generator for the order of the distractors.
        composition: "base" or "extend".
        oracle_version: The version of the code that planned the moves.
    """
    step, now, right = question.step, pictures[question.step], pictures[question.step + 1]
    near = [n for n in (step + away for away in TEMPORAL_OFFSETS) if 0 <= n < len(pictures)]
    supply = {
        "temporal": [pictures[near[n]] for n in rng.permutation(len(near))],
        "elsewhere": list(elsewhere),
        "other_scene": list(other_scene),
    }
    wrong = _choose_wrong(question, supply, now, right, trajectory.metres_per_block)
    if len(wrong) < CHOICES - 1:
        return None
    mixed = [wrong[n] for n in rng.permutation(len(wrong))]
    place = LETTERS.index(letter)
    mixed.insert(place, ("positive", right))
    options = tuple(
        Option(LETTERS[n], kind, image=one.image, stance=one.stance)
        for n, (kind, one) in enumerate(mixed)
    )
    history = pictures[step - HISTORY + 1 : step + 1]
    shown = [*history, *(one for _, one in mixed)]
    rank = sum(picture_difference(now, one) < picture_difference(now, right) for _, one in wrong)
    return Item(
        f"{trajectory.trajectory_id}_v{step:02d}", "next_view", trajectory.scene_id,
        trajectory.trajectory_id, step, instruction, tuple(one.image for one in history[:-1]),
        history[-1].image, options, letter, trajectory.split, composition,
        trajectory.metres_per_block, oracle_version, {one.image: one.sha256 for one in shown},
        {
            "grade": question.grade,
            "nearer": rank,
            "progress": round(step / (len(pictures) - 1), 4),
        },
    )  # fmt: skip


def _choose_wrong(
    question: ViewQuestion,
    supply: Mapping[str, Sequence[StoredPicture]],
    now: StoredPicture,
    right: StoredPicture,
    metres_per_block: float,
) -> list[tuple[str, StoredPicture]]:
    """Choose a distractor for each slot, falling back to easier kinds."""
    chosen: list[tuple[str, StoredPicture]] = []
    limit = picture_difference(now, right)
    for slot in question.slots:
        others = [right, *(one for _, one in chosen)]
        if slot.picture is not None and is_valid_choice(slot.picture, now, others):
            chosen.append((slot.kind, slot.picture))
            continue
        for kind in (slot.kind, "temporal", "elsewhere", "other_scene"):
            fit = [
                one
                for one in supply.get(kind, ())
                if kind == "other_scene"
                or show_different_views(one.stance, right.stance, metres_per_block)
            ]
            fit.sort(key=lambda one: (picture_difference(now, one) < limit) != slot.nearer)
            found = next((one for one in fit if is_valid_choice(one, now, others)), None)
            if found is not None:
                chosen.append((kind, found))
                break
    return chosen
