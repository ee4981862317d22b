"""How many items a set has: all that were made, or as many as the paper counts."""

from collections.abc import Mapping, Sequence

from world2minecraft.vln.values import Item

# Of the paper's table of instruction lengths; its table of sizes has the two rows swapped.
PAPER_SIZE: Mapping[tuple[str, str], int] = {
    ("next_action", "base"): 769,
    ("next_view", "base"): 290,
    ("next_action", "extend"): 1351,
    ("next_view", "extend"): 1132,
}
COMPOSITIONS = ("base", "extend", "combined")


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
