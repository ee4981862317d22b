"""Next-View: which of four pictures comes next? With wrong ones of three grades.

    easy    two views of elsewhere in the scene, one of another scene
    medium  elsewhere, another time of the same way, the next place with another heading
    hard    another time, another heading, and what another move would show

A wrong picture is never one that could pass for the right one: from nearly the same stance, or
with nearly the same hash.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.vln.data.album import Album, Pictured, are_apart, look_apart, shows_something
from world2minecraft.vln.data.discretise import Walker
from world2minecraft.vln.data.keyframes import MOST_FORWARD_M, Mark
from world2minecraft.vln.data.stream import wrapped_deg
from world2minecraft.vln.values import LETTERS, Instruction, Item, Move, Option, Stance, Trajectory

HISTORY = 3  # Pictures that are shown; the last is the current one.
GRADES = {
    "easy": ("elsewhere", "elsewhere", "other_scene"),
    "medium": ("elsewhere", "temporal", "turned"),
    "hard": ("temporal", "turned", "other_move"),
}
TURNS_DEG = (-180.0, -60.0, -30.0, 30.0, 60.0)
GRADE_SHARES = (0.2, 0.4, 0.4)  # In an easy one the picture most like the present is mostly right.
TURN_MOVES = 2  # Of another move: so little that it looks as near as the right one.
CHOICES = 4


@dataclass(frozen=True)
class ViewQuestion:
    """A question before its wrong pictures of elsewhere are drawn."""

    trajectory_id: str
    step: int
    grade: str
    own: dict[str, Pictured]  # wrong pictures made for it, by kind


def view_steps(clear: Sequence[int], pictures: Sequence[Pictured]) -> list[int]:
    """Return the steps that have three pictures up to them and one after, of those that are clear.

    Where one looks at a bare wall, or would next, nothing is asked.

    Args:
        clear: keyframes whose next action an instruction tells.
        pictures: of the keyframes.
    """
    fit = [step for step in clear if HISTORY - 1 <= step < len(pictures) - 1]
    return [step for step in fit if all(map(shows_something, pictures[step : step + 2]))]


def view_question(
    trajectory_id: str,
    marks: Sequence[Mark],
    pictures: Sequence[Pictured],
    step: int,
    grade: str,
    album: Album,
    walker: Walker,
    metres_per_block: float,
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
        walker: the world's physics.
        metres_per_block: of the world.
        rng: chooses.
    """
    right, own = pictures[step + 1], {}
    stances = {
        "turned": _turned(right.stance, rng),
        "other_move": _moved(marks[step], walker, metres_per_block, rng),
    }
    for kind in GRADES[grade]:
        for stance in stances.get(kind, ()):
            if not are_apart(stance, right.stance, metres_per_block):
                continue
            (shot,) = album.take([stance])
            apart = all(look_apart(shot, one) for one in (right, *own.values()))
            if apart and shows_something(shot):
                name = right.image.removesuffix(".jpg")
                own[kind] = album.write(f"{name}_{kind}.jpg", stance, shot)
                break
    return ViewQuestion(trajectory_id, step, grade, own)


def _turned(stance: Stance, rng: np.random.Generator) -> list[Stance]:
    turns = rng.permutation(TURNS_DEG)
    return [
        replace(stance, yaw_deg=float(wrapped_deg(stance.yaw_deg + turn))) for turn in turns[:3]
    ]


def _moved(
    mark: Mark, walker: Walker, metres_per_block: float, rng: np.random.Generator
) -> list[Stance]:
    """Return where the other moves would lead, one after the other by chance."""
    found = []
    for number in rng.permutation(3):
        move = (Move.FORWARD, Move.LEFT, Move.RIGHT)[number]
        stance, walked = mark.stance, 0.0
        for _ in range(8 if move == Move.FORWARD else TURN_MOVES):
            there, collided = walker(stance, move)
            if collided or walked >= MOST_FORWARD_M:
                break
            walked += float(np.hypot(there.x - stance.x, there.z - stance.z)) * metres_per_block
            stance = there
        if move != mark.move and stance != mark.stance:
            found.append(stance)
    return found


def view_item(
    question: ViewQuestion,
    trajectory: Trajectory,
    instruction: Instruction,
    pictures: Sequence[Pictured],
    elsewhere: Iterable[Pictured],
    other_scene: Iterable[Pictured],
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
    step, right = question.step, pictures[question.step + 1]
    near = [n for n in (step + 2, step + 3, step - 1) if 0 <= n < len(pictures)]
    later = [pictures[near[n]] for n in rng.permutation(len(near))]
    supply = {
        "temporal": iter(later),
        "elsewhere": iter(elsewhere),
        "other_scene": iter(other_scene),
        **{kind: iter([one]) for kind, one in question.own.items()},
    }
    wrong = _wrong(GRADES[question.grade], supply, right, trajectory.metres_per_block)
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
    return Item(
        f"{trajectory.trajectory_id}_v{step:02d}", "next_view", trajectory.scene_id,
        trajectory.trajectory_id, step, instruction, tuple(one.image for one in history[:-1]),
        history[-1].image, options, letter, trajectory.split, composition,
        trajectory.metres_per_block, oracle_version, {one.image: one.sha256 for one in shown},
        {"grade": question.grade, "progress": round(step / (len(pictures) - 1), 4)},
    )  # fmt: skip


def _wrong(
    kinds: Sequence[str], supply: dict, right: Pictured, metres_per_block: float
) -> list[tuple[str, Pictured]]:
    """Return a picture of each kind; where one has none left, one of an easier kind."""
    chosen: list[tuple[str, Pictured]] = []
    for kind in kinds:
        for instead in (kind, "temporal", "elsewhere", "other_scene"):
            same_scene = instead != "other_scene"
            found = next(
                (
                    one
                    for one in supply.get(instead, iter(()))
                    if _differs(one, right, [c for _, c in chosen], same_scene, metres_per_block)
                ),
                None,
            )
            if found is not None:
                chosen.append((instead, found))
                break
    return chosen


def _differs(
    one: Pictured,
    right: Pictured,
    chosen: Sequence[Pictured],
    same_scene: bool,
    metres_per_block: float,
) -> bool:
    if same_scene and not are_apart(one.stance, right.stance, metres_per_block):
        return False
    if not shows_something(one):
        return False
    return look_apart(one, right) and all(look_apart(one, other) for other in chosen)
