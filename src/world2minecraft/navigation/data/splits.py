"""Which scenes and walks are for training, and whether anything leaks from there.

Scenes and walks are ordered by hashes of their names, so that their order does not matter. Whole
scenes are kept unseen (``val_unseen``), and of the others whole tours (``val_seen``). What is asked
of a walk is always in one split.
"""

import hashlib
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.types import Item, Trajectory

UNSEEN_SHARE = 0.2  # Of the scenes of each composition: the paper's test share of items is 0.21.
SEEN_SHARE = 0.1  # Of the tours of the other scenes.
PAPER_SHARE = 0.23  # Of the walks: of its items the paper holds out 14 to 23 %, part by part.


def scene_splits(
    compositions: Mapping[str, str], seed: int = 0, unseen_share: float = UNSEEN_SHARE
) -> dict[str, str]:
    """Return train or val_unseen for each scene.

    The scenes of each composition are put in the order of a sum of seed and name, and the first
    are kept unseen: their share, rounded, and at least one of three or more.

    Args:
        compositions: base or extend, by the scene's name.
        seed: another seed, another choice.
        unseen_share: from 0 up to 1.

    Example:
        >>> scene_splits({"a": "base", "b": "base", "c": "base"})
        {'a': 'train', 'b': 'val_unseen', 'c': 'train'}
    """
    if not 0 <= unseen_share <= 1:
        raise UsageError(f"the share of unseen scenes is 0 to 1, not {unseen_share:g}")
    splits = {}
    for kind in sorted(set(compositions.values())):
        names = sorted(
            (name for name, own in compositions.items() if own == kind),
            key=lambda name: (_sum(seed, name), name),
        )
        count = round(unseen_share * len(names))
        count = max(count, 1) if len(names) >= 3 and unseen_share > 0 else count
        splits |= {name: "val_unseen" if n < count else "train" for n, name in enumerate(names)}
    return {name: splits[name] for name in compositions}


def split_of_tour(
    tour_id: str, scene_split: str, seed: int = 0, seen_share: float = SEEN_SHARE
) -> str:
    """Return the split of a tour: its scene's, or val_seen for a few of those that train."""
    if scene_split != "train":
        return scene_split
    return "val_seen" if _sum(seed, f"tour {tour_id}") / 2**64 < seen_share else "train"


def paper_splits(trajectories: Sequence[Trajectory], seed: int = 0) -> dict[str, str]:
    """Return the split of each trajectory as the paper splits: walks of the same scenes.

    Whole tours, in the order of a sum of seed and name, are ``val_seen`` until they have
    ``PAPER_SHARE`` of the walks; all others are for training. No scene is unseen.

    Args:
        trajectories: of one composition.
        seed: another seed, another choice.
    """
    walks = Counter(tour_of(one.trajectory_id) for one in trajectories)
    held, left = set[str](), PAPER_SHARE * len(trajectories)
    for tour in sorted(walks, key=lambda name: (_sum(seed, f"tour {name}"), name)):
        if left <= 0:
            break
        held.add(tour)
        left -= walks[tour]
    return {
        one.trajectory_id: "val_seen" if tour_of(one.trajectory_id) in held else "train"
        for one in trajectories
    }


def tour_of(trajectory_id: str) -> str:
    """Return the tour that a trajectory is a part of.

    Example:
        >>> tour_of("kitchen_t03_002")
        'kitchen_t03'
    """
    return trajectory_id.rpartition("_")[0]


def _sum(seed: int, name: str) -> int:
    return int.from_bytes(hashlib.sha256(f"{seed} {name}".encode()).digest()[:8], "big")


@dataclass(frozen=True)
class Leaks:
    """What train shares with the other splits: instructions may, such as one to go to the bed."""

    images: tuple[str, ...]  # sums
    scenes: tuple[str, ...]  # with val_unseen
    trajectories: tuple[str, ...]
    instructions: tuple[str, ...]  # texts; those that name the goal alone come again by nature

    @property
    def is_clean(self) -> bool:
        """Whether no picture, scene or walk is on both sides."""
        return not (self.images or self.scenes or self.trajectories)


def find_leaks(items: Sequence[Item]) -> Leaks:
    """Return what the items of train share with those that are scored on."""
    train = [item for item in items if item.split == "train"]
    held = [item for item in items if item.split != "train"]
    unseen = [item for item in held if item.split == "val_unseen"]
    return Leaks(
        _shared(_sums(train), _sums(held)),
        _shared({item.scene_id for item in train}, {item.scene_id for item in unseen}),
        _shared({item.trajectory_id for item in train}, {item.trajectory_id for item in held}),
        _shared({item.instruction.text for item in train}, {i.instruction.text for i in held}),
    )


def without_shared_pictures(items: Sequence[Item]) -> list[Item]:
    """Return items but for those to be scored on that show a picture of train.

    Two tours of one scene may come to the very same place.
    """
    train = _sums([item for item in items if item.split == "train"])
    return [item for item in items if item.split == "train" or not train & _sums([item])]


def _sums(items: Sequence[Item]) -> set[str]:
    return {value for item in items for value in item.sha256.values()}


def _shared(one: set[str], other: set[str]) -> tuple[str, ...]:
    return tuple(sorted(one & other))
