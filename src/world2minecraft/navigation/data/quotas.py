"""How many items a set has: all that were made, or as many as the paper counts."""

from collections.abc import Mapping, Sequence

from world2minecraft.navigation.values import Item

# Of the paper's table of instruction lengths; its table of sizes has the two rows swapped.
PAPER_SIZE: Mapping[tuple[str, str], int] = {
    ("next_action", "base"): 769,
    ("next_view", "base"): 290,
    ("next_action", "extend"): 1351,
    ("next_view", "extend"): 1132,
}
# Of its table of sizes, the rows put right: how many of them it scores on.
PAPER_HELD: Mapping[tuple[str, str], int] = {
    ("next_action", "base"): 175,
    ("next_view", "base"): 41,
    ("next_action", "extend"): 309,
    ("next_view", "extend"): 230,
}
PAPER_WALKS = {"base": 360, "extend": 600}  # Of all scenes together: with room to cut from.
COMPOSITIONS = ("base", "extend", "combined")


def cut_as_the_paper(items: Sequence[Item], splits_too: bool = False) -> list[Item]:
    """Return as many items as the paper has of each task and composition.

    Args:
        items: of a set.
        splits_too: cut what trains and what is held out each to the paper's number.
    """
    if not splits_too:
        return cut(items, PAPER_SIZE)
    train = {key: PAPER_SIZE[key] - PAPER_HELD[key] for key in PAPER_SIZE}
    kept = cut([item for item in items if item.split == "train"], train)
    kept += cut([item for item in items if item.split != "train"], PAPER_HELD)
    chosen = {item.item_id for item in kept}
    return [item for item in items if item.item_id in chosen]


def cut(items: Sequence[Item], quotas: Mapping[tuple[str, str], int]) -> list[Item]:
    """Return items, no more of a task and composition than its quota, in their order.

    They are taken from the trajectories of all scenes in turn, so that no scene is left out.

    Args:
        items: of a set, those of a trajectory beside each other.
        quotas: how many, by task and composition; what is not named is kept whole.
    """
    kept: set[str] = set()
    for key in {(item.task, item.composition) for item in items}:
        own = [item for item in items if (item.task, item.composition) == key]
        kept |= {item.item_id for item in _in_turn(own)[: quotas.get(key, len(own))]}
    return [item for item in items if item.item_id in kept]


def _in_turn(items: Sequence[Item]) -> list[Item]:
    """Return items so that each scene's n-th trajectory comes before any scene's next one."""
    turns: dict[str, dict[str, int]] = {}
    for item in items:
        own = turns.setdefault(item.scene_id, {})
        own.setdefault(item.trajectory_id, len(own))
    return sorted(items, key=lambda item: turns[item.scene_id][item.trajectory_id])
