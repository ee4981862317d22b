"""Splits into training and held-out scenes and walks, and the check for leaks between them.

Scenes and walks are sorted by hashes of their names, so their order does not matter. Whole scenes
are held out as ``val_unseen``, and whole tours of the other scenes as ``val_seen``. All questions
about a walk belong to one split.
"""

import hashlib
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.types import Item, Trajectory

UNSEEN_SHARE = 0.2  # Of the scenes of each composition; the paper's test set has 21 % of the items.
TOURS_PER_SEEN = 10  # One of so many tours of the other scenes is held out.
PAPER_SHARE = 0.23  # Of the walks; the paper holds out 14 to 23 % of the items of each part.


def scene_splits(
    compositions: Mapping[str, str], seed: int = 0, unseen_share: float = UNSEEN_SHARE
) -> dict[str, str]:
    """Assign each scene to the split train or val_unseen.

    The scenes of each composition are sorted by a hash of seed and name. The first ones, rounded to
    the share but at least one of three or more, are held out.

    Args:
        compositions: "base" or "extend" by the name of the scene.
        seed: The seed of the hash.
        unseen_share: The share of scenes to hold out, 0 to 1.

    Example:
        >>> scene_splits({"a": "base", "b": "base", "c": "base"})
        {'a': 'train', 'b': 'val_unseen', 'c': 'train'}
    """
    if not 0 <= unseen_share <= 1:
        raise UsageError(f"the unseen share must be 0 to 1, got {unseen_share:g}")
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


def seen_splits(trajectories: Sequence[Trajectory], seed: int = 0) -> dict[str, str]:
    """Split the trajectories of training scenes into training and ``val_seen``.

    Whole tours, sorted by a hash of seed and name, become ``val_seen``: one in ``TOURS_PER_SEEN``,
    rounded, but at least one. Of each scene, one tour remains in training.

    Args:
        trajectories: The trajectories of one composition. Held-out ones keep their split.
        seed: The seed of the hash.

    Returns:
        The split of each trajectory by its ID.
    """
    scene_of = {
        tour_of(one.trajectory_id): one.scene_id for one in trajectories if one.split == "train"
    }
    tours = _sorted_tours(scene_of, seed)
    trained = set({scene_of[tour]: tour for tour in tours}.values())  # The last one of each scene.
    count = max(1, round(len(tours) / TOURS_PER_SEEN))
    held = [tour for tour in tours if tour not in trained][:count]
    return {
        one.trajectory_id: "val_seen" if tour_of(one.trajectory_id) in held else one.split
        for one in trajectories
    }


def paper_splits(trajectories: Sequence[Trajectory], seed: int = 0) -> dict[str, str]:
    """Split trajectories as the paper does, into training and held-out walks of the same scenes.

    Whole tours, sorted by a hash of seed and name, become ``val_seen`` until ``PAPER_SHARE`` of the
    walks are held out. No scene is unseen.

    Args:
        trajectories: The trajectories of one composition.
        seed: The seed of the hash.

    Returns:
        The split of each trajectory by its ID.
    """
    walks = Counter(tour_of(one.trajectory_id) for one in trajectories)
    held, left = set[str](), PAPER_SHARE * len(trajectories)
    for tour in _sorted_tours(walks, seed):
        if left <= 0:
            break
        held.add(tour)
        left -= walks[tour]
    return {
        one.trajectory_id: "val_seen" if tour_of(one.trajectory_id) in held else "train"
        for one in trajectories
    }


def tour_of(trajectory_id: str) -> str:
    """Return the ID of the tour that a trajectory belongs to.

    Example:
        >>> tour_of("kitchen_t03_002")
        'kitchen_t03'
    """
    return trajectory_id.rpartition("_")[0]


def _sorted_tours(tours: Iterable[str], seed: int) -> list[str]:
    return sorted(tours, key=lambda name: (_sum(seed, f"tour {name}"), name))


def _sum(seed: int, name: str) -> int:
    return int.from_bytes(hashlib.sha256(f"{seed} {name}".encode()).digest()[:8], "big")


@dataclass(frozen=True)
class Leaks:
    """The overlap between the training split and the held-out splits.

    Instructions may be shared, because an instruction such as "go to the bed" occurs in many
    scenes.

    Attributes:
        images: The SHA-256 of shared images.
        scenes: The scenes shared with val_unseen.
        trajectories: The IDs of shared trajectories.
        instructions: The shared instruction texts.
    """

    images: tuple[str, ...]
    scenes: tuple[str, ...]
    trajectories: tuple[str, ...]
    instructions: tuple[str, ...]

    @property
    def is_clean(self) -> bool:
        """Whether no image, scene or trajectory is shared."""
        return not (self.images or self.scenes or self.trajectories)


def find_leaks(items: Sequence[Item]) -> Leaks:
    """Return the overlap between the training items and the held-out items."""
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
    """Return the items without held-out ones that show a training image.

    Two tours of one scene can pass through exactly the same position.
    """
    train = _sums([item for item in items if item.split == "train"])
    return [item for item in items if item.split == "train" or not train & _sums([item])]


def _sums(items: Sequence[Item]) -> set[str]:
    return {value for item in items for value in item.sha256.values()}


def _shared(one: set[str], other: set[str]) -> tuple[str, ...]:
    return tuple(sorted(one & other))
