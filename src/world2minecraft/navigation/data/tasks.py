"""The two tasks of a set: Next-Action and Next-View.

Next-Action: what does one do next? Four actions, one right. In each walk one picture of each action
is asked about, so no answer is likelier than another, even to someone who knows the instruction: a
model that sees nothing is right one time in four.

Next-View: which of four pictures comes next? With wrong ones of three grades::

    easy    two views of elsewhere in the scene, one of another scene
    medium  elsewhere, another time of the same walk, the next place with another heading, a step
            beside
    hard    also what another move would show, and where the mirrored walk leads

Who walks on sees much of what was there before. So that the picture most like the present one is
not mostly the right one, it is drawn how many of the wrong ones are more like it than the right
one: none to three, each as often, as far as such pictures are found. A wrong picture is never one
that could pass for the right one: from nearly the same stance, or with nearly the same hash. Nor is
it one that was shown before.
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

HISTORY = 3  # Pictures that are shown; the last is the current one.
# What is taken for a question, and what serves where nothing is; of a grade.
RENDERED_OF = {"easy": (), "medium": ("turned", "beside"), "hard": RENDERED_KINDS}
FOUND_OF = {
    "easy": ("elsewhere", "elsewhere", "other_scene"),
    "medium": ("elsewhere", "temporal", "elsewhere"),
    "hard": ("temporal", "temporal", "elsewhere"),
}
MAX_FAR = {"easy": 0, "medium": 1, "hard": 3}  # Taken ones that are less like the present picture.
GRADES = tuple(RENDERED_OF)
GRADE_SHARES = (
    0.1,
    0.45,
    0.45,
)  # In easy ones the nearest is mostly right.
TEMPORAL_OFFSETS = (2, 3, 4, -3, -4)  # From the current one: other times of a walk, not shown yet.


def action_steps(
    marks: Sequence[KeyframeMark],
    clear: Sequence[int],
    rng: np.random.Generator,
    balanced: bool = True,
) -> list[int]:
    """Return the keyframes to ask about, rising.

    Args:
        marks: of the way.
        clear: those whose next action the instruction tells.
        rng: chooses.
        balanced: one of each action, and none at all where one is missing; else all that are clear.
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
    """Return the item of a keyframe.

    Args:
        trajectory: the way.
        instruction: what is told.
        pictures: of its keyframes.
        step: which one.
        letter: of the right action.
        rng: orders the wrong ones.
        composition: base or extend.
        oracle_version: of what made the moves.
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
    """A question before its wrong pictures of elsewhere are drawn."""

    trajectory_id: str
    step: int
    grade: str
    slots: tuple[DistractorSlot, ...]


def view_steps(clear: Sequence[int], pictures: Sequence[StoredPicture]) -> list[int]:
    """Return the steps that have three pictures up to them and one after, of those that are clear.

    Where one looks at a bare wall, or would next, nothing is asked.

    Args:
        clear: keyframes whose next action an instruction tells.
        pictures: of the keyframes.
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
    """Return a question with the wrong pictures that must be taken for it.

    Args:
        trajectory_id: of the way.
        marks: its keyframes.
        pictures: theirs.
        step: which is the current one.
        grade: of ``GRADES``.
        album: where pictures go.
        scout: says where they may be taken.
        ranks: says how many of them are to be more like the present picture than the right one.
        rng: chooses.
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
    if grade != "easy":  # Where no such picture could be taken another will do.
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
    """Return the item of a question; None where too few wrong pictures differ from the right one.

    Args:
        question: of ``view_question``.
        trajectory: its way.
        instruction: what is told.
        pictures: of the way's keyframes.
        elsewhere: pictures of other ways in the scene, of the same split, in the order to try.
        other_scene: the same of other scenes.
        letter: of the right picture.
        rng: orders the wrong ones.
        composition: base or extend.
        oracle_version: of what made the moves.
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
    """Return a picture of each kind; where one has none left, one of an easier kind."""
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
