"""Whether what is scored on was seen in training: pictures, scenes, walks, instructions."""

from collections.abc import Sequence
from dataclasses import dataclass

from world2minecraft.navigation.values import Item


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


def leaks_of(items: Sequence[Item]) -> Leaks:
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
