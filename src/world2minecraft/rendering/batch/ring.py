"""The slots that pictures of a pool come back through, and how poses are cut into tasks."""

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import fields, replace
from typing import Any

from world2minecraft.core.types import Camera
from world2minecraft.rendering.batch.arrays import BatchArrays, Room
from world2minecraft.rendering.batch.drawing import Views
from world2minecraft.rendering.batch.shared_memory import Block, placed
from world2minecraft.rendering.batch.worker import Reply, Task
from world2minecraft.rendering.picture import Picture

TASK_PX = 1 << 16  # A task has so many pixels at least: a message takes 0.1 ms.
MOST_A_TASK = 64  # Pictures.


class Ring:
    """Slots of shared memory, and the tasks that they are for, in the order of their pictures."""

    def __init__(self, slots: int, slot_bytes: int):
        """Begin with all slots free."""
        self.free = deque(range(slots))
        self.taken: dict[int, Task] = {}
        self.done: dict[int, Reply] = {}
        self._slot_of: dict[int, int] = {}
        self._bytes = slot_bytes

    def take(self, first: int, views: Views, rooms: dict[str, Room]) -> Task:
        """Take a slot for pictures, and return the task to draw them there."""
        slot = self._slot_of[first] = self.free.popleft()
        self.taken[first] = Task(first, views, placed(rooms, slot * self._bytes)[0])
        return self.taken[first]

    def next_reply(self, ordered: bool) -> Reply | None:
        """Return the reply that is next, where it has come."""
        if ordered:
            return self.done.get(next(iter(self.taken), -1))
        return next(iter(self.done.values()), None)

    def give_back(self, first: int) -> None:
        """Free the slot of a task."""
        del self.taken[first], self.done[first]
        self.free.append(self._slot_of.pop(first))


def pictures_of(reply: Reply, ring: Ring, block: Block) -> list[tuple[int, Any]]:
    """Return what a task made, or copies of its pictures, each with its number."""
    if reply.made is not None:
        return list(enumerate(reply.made, reply.first))
    task = ring.taken[reply.first]
    arrays = BatchArrays(**{name: block.array(place) for name, place in task.places.items()})
    numbers = range(len(task.views.poses))
    return [(reply.first + number, _copied(arrays.picture(number))) for number in numbers]


def _copied(picture: Picture) -> Picture:
    arrays = {one.name: getattr(picture, one.name) for one in fields(picture)}
    return replace(picture, **{k: v.copy() for k, v in arrays.items() if v is not None})


def runs_of(cameras: Sequence[Camera]) -> Iterator[tuple[int, int]]:
    """Cut poses into tasks: neighbours of one size, more of them where pictures are small."""
    first = 0
    while first < len(cameras):
        size = cameras[first].height_px, cameras[first].width_px
        most = min(max(TASK_PX // (size[0] * size[1]), 1), MOST_A_TASK)
        last = first + 1
        while last < len(cameras) and last - first < most:
            if (cameras[last].height_px, cameras[last].width_px) != size:
                break
            last += 1
        yield first, last
        first = last
