"""Alternative instructions for a set, written by people or by a language model.

Instructions are added to a trajectory without replacing others. Items use a human instruction if
one exists, otherwise one from a model, otherwise the generated one. An item keeps its instruction
level, because an instruction that states only the goal permits many paths.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from world2minecraft.core.errors import BudgetError, ServerError
from world2minecraft.core.files import read_json
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.whole_reads import read_whole
from world2minecraft.navigation.language.human_instructions import (
    read_annotations,
    with_annotations,
)
from world2minecraft.navigation.language.instruction_parsing import parse_instruction
from world2minecraft.navigation.language.rewriting import Ask, Rewriting, rewrite
from world2minecraft.navigation.records import (
    ABOUT,
    EPISODES,
    ITEMS,
    TRAJECTORIES,
    read_episodes,
    read_items,
    read_trajectories,
    write_episodes,
    write_items,
    write_trajectories,
)
from world2minecraft.navigation.types import Episode, Instruction, Item, Trajectory

ORDER = ("human", "llm", "template")  # Preferred sources of instructions.
NO_REPLY, NO_BUDGET = "no reply", "no budget left"


@dataclass(frozen=True)
class NavigationSet:
    """The records of a set, and the names of the objects in each scene."""

    items: list[Item]
    trajectories: list[Trajectory]
    episodes: list[Episode]
    names: Mapping[str, tuple[str, ...]]


def read_set(folder: str | Path) -> NavigationSet:
    """Read a set that was written by ``w2m vln build``.

    Raises:
        InputError: If a file is missing or invalid.
    """
    place = Path(folder)
    return read_whole(place, lambda: _read_set(place))


def _read_set(place: Path) -> NavigationSet:
    walks = read_trajectories(place)
    return NavigationSet(
        read_items(place), walks, read_episodes(place), _names(place / ABOUT, walks)
    )


def write_set(folder: str | Path, navigation_set: NavigationSet) -> None:
    """Write the records of a set without changing its images.

    Raises:
        OutputError: If a file cannot be written.
    """
    place = Path(folder)
    write_trajectories(place / TRAJECTORIES, navigation_set.trajectories)
    write_episodes(place / EPISODES, navigation_set.episodes)
    write_items(place / ITEMS, navigation_set.items)


def select_instructions(
    navigation_set: NavigationSet, order: Sequence[str] = ORDER
) -> NavigationSet:
    """Return a set whose items and episodes use instructions of the preferred source.

    If several people described a trajectory, its items use their instructions in turn.

    Args:
        navigation_set: The set.
        order: Names from ``INSTRUCTION_SOURCES`` in order of preference. Other sources are not
            used.
    """
    words = {one.trajectory_id: one.instructions for one in navigation_set.trajectories}
    turns: Counter[str] = Counter()
    items = []
    for item in navigation_set.items:
        own = words.get(item.trajectory_id, ())
        chosen = _choose(own, item.instruction, order, turns[item.trajectory_id])
        turns[item.trajectory_id] += 1
        items.append(replace(item, instruction=chosen))
    episodes = [
        replace(
            one,
            instruction=_choose(words.get(one.trajectory_id, ()), one.instruction, order, 0),
        )
        for one in navigation_set.episodes
    ]
    return replace(navigation_set, items=items, episodes=episodes)


def add_annotations(navigation_set: NavigationSet, file: str | Path) -> NavigationSet:
    """Return a set whose trajectories include the human instructions of a file.

    Raises:
        InputError: If the file cannot be read, or refers to an unknown trajectory.
        DamagedFileError: If a line is invalid.
    """
    scene_of, annotated = (
        {one.trajectory_id: one.scene_id for one in navigation_set.trajectories},
        [],
    )
    for walk, one in read_annotations(file):
        names = navigation_set.names.get(scene_of.get(walk, ""), ())
        annotated.append(
            (walk, replace(one, landmarks=parse_instruction(one.text, names).landmarks))
        )
    return replace(
        navigation_set,
        trajectories=with_annotations(navigation_set.trajectories, annotated, str(file)),
    )


def annotate_set(folder: str | Path, file: str | Path) -> None:
    """Add the human instructions of a file to a set on disk, and use them in its items.

    Raises:
        InputError: If a file cannot be read, or refers to an unknown trajectory.
    """
    write_set(folder, select_instructions(add_annotations(read_set(folder), file)))


def reword_set(
    navigation_set: NavigationSet,
    ask: Ask,
    model: str,
    jobs: int = 1,
    progress: Progress = no_progress,
) -> tuple[NavigationSet, Counter[str]]:
    """Return a set with model-written paraphrases of the generated instructions that items use.

    Args:
        navigation_set: The set. Trajectories with a paraphrase of the same level are skipped.
        ask: A thread-safe function that queries the model.
        model: The name of the model.
        jobs: The number of concurrent queries.
        progress: Called after each query.

    Returns:
        The set, and the number of replies by reason of rejection, with "" for accepted replies.

    Raises:
        ServerError: If no query was answered.
    """
    levels = _levels_in_use(navigation_set)
    pending = [
        (one, words)
        for one in navigation_set.trajectories
        for words in one.instructions
        if words.source == "template" and words.level in levels.get(one.trajectory_id, ())
        and not any(w.source == "llm" and w.level == words.level for w in one.instructions)
    ]  # fmt: skip
    progress("words", 0, len(pending))
    added: dict[str, list[Instruction]] = {}
    outcomes, failures = Counter[str](), list[ServerError]()
    again = partial(_reword_one, navigation_set=navigation_set, ask=ask, model=model)
    with ThreadPoolExecutor(max(1, jobs)) as pool:
        for number, ((walk, _), (rewriting, error)) in enumerate(
            zip(pending, pool.map(again, pending), strict=True), 1
        ):
            outcomes[rewriting.refusal] += 1
            failures += [error] if error is not None else []
            if rewriting.instruction is not None:
                added.setdefault(walk.trajectory_id, []).append(rewriting.instruction)
            progress("words", number, len(pending))
    if failures and not added:
        raise failures[0]
    trajectories = [
        replace(one, instructions=(*one.instructions, *added.get(one.trajectory_id, ())))
        for one in navigation_set.trajectories
    ]
    return replace(navigation_set, trajectories=trajectories), outcomes


def _reword_one(
    one: tuple[Trajectory, Instruction], navigation_set: NavigationSet, ask: Ask, model: str
) -> tuple[Rewriting, ServerError | None]:
    walk, words = one
    try:
        return rewrite(words, navigation_set.names.get(walk.scene_id, ()), ask, model), None
    except BudgetError:
        return Rewriting(None, NO_BUDGET), None
    except ServerError as error:
        return Rewriting(None, NO_REPLY), error


def _levels_in_use(navigation_set: NavigationSet) -> dict[str, set[str]]:
    levels: dict[str, set[str]] = {}
    for one in (*navigation_set.items, *navigation_set.episodes):
        levels.setdefault(one.trajectory_id, set()).add(one.instruction.level)
    return levels


def _choose(
    words: Sequence[Instruction], now: Instruction, order: Sequence[str], turn: int
) -> Instruction:
    """Return the replacement for an instruction, of the same level if available."""
    for source in order:
        own = [one for one in words if one.source == source]
        fit = [one for one in own if one.level == now.level] or [
            one for one in own if now.level == "goal" or one.level != "goal"
        ]
        if fit:
            return replace(fit[turn % len(fit)], level=now.level)
    return now


def _names(path: Path, walks: Sequence[Trajectory]) -> dict[str, tuple[str, ...]]:
    """Return the object names of each scene, from the set's description and its instructions."""
    names: dict[str, set[str]] = {}
    for walk in walks:
        for words in walk.instructions:
            names.setdefault(walk.scene_id, set()).update(words.landmarks)
    data = read_json(path) if path.is_file() else {}
    scenes = data.get("scenes", []) if isinstance(data, dict) else []
    for scene in scenes if isinstance(scenes, list) else []:
        own = scene.get("landmarks") if isinstance(scene, dict) else None
        if isinstance(own, list):
            known = [name for name in own if isinstance(name, str) and name]
            names.setdefault(str(scene.get("scene_id")), set()).update(known)
    return {scene: tuple(sorted(own)) for scene, own in names.items()}
