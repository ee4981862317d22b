"""Next-Action: what does one do next? Four actions, one right.

In each way one picture of each action is asked about. So no answer is likelier than another, even
to someone who knows the instruction: a model that sees nothing is right one time in four.
"""

from collections.abc import Sequence

import numpy as np

from world2minecraft.navigation.data.album import Pictured
from world2minecraft.navigation.data.keyframes import ACTIONS, Mark
from world2minecraft.navigation.values import LETTERS, Instruction, Item, Move, Option, Trajectory


def action_steps(
    marks: Sequence[Mark], clear: Sequence[int], rng: np.random.Generator, balanced: bool = True
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
    pictures: Sequence[Pictured],
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
