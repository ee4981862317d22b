"""Arrays in shared memory: written once, seen by every process that knows their plan.

One process creates ``SharedArrays`` and frees them again; others join. Each array begins at a whole
number of cache lines. Whether it may be written to is kept: kernels are compiled for that, and a
process with another flag would compile its own.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from multiprocessing.shared_memory import SharedMemory

import numpy as np

from world2minecraft.core.errors import UsageError

LINE_BYTES = 64


@dataclass(frozen=True)
class ArrayPlace:
    """Where an array lies in a block."""

    offset: int
    shape: tuple[int, ...]
    dtype: str
    writeable: bool = True


@dataclass(frozen=True)
class SharedLayout:
    """What another process needs to know to join a block."""

    name: str
    places: dict[str, ArrayPlace]


def lay_out(
    rooms: Mapping[str, tuple[tuple[int, ...], np.dtype]], start: int = 0
) -> tuple[dict[str, ArrayPlace], int]:
    """Return a place for each array, by its shape and dtype, and where the last one ends."""
    places, offset = {}, start
    for name, (shape, kind) in rooms.items():
        places[name] = ArrayPlace(offset, tuple(shape), kind.str)
        size = int(np.prod(shape, dtype=object)) * kind.itemsize
        offset += -(-size // LINE_BYTES) * LINE_BYTES
    return places, offset


class SharedArrays:
    """Shared memory with arrays in it."""

    def __init__(self, memory: SharedMemory, plan: SharedLayout, *, owned: bool):
        """Use ``create`` or ``join``."""
        self.plan, self._memory, self._owned = plan, memory, owned

    @classmethod
    def create(cls, places: dict[str, ArrayPlace], size: int) -> "SharedArrays":
        """Make a block.

        Raises:
            UsageError: the machine has not so much shared memory.
        """
        try:
            memory = SharedMemory(create=True, size=max(size, 1))
        except OSError as error:
            raise UsageError(
                f"cannot allocate {size / 2**20:,.0f} MiB of shared memory ({error}); use smaller "
                "images, fewer workers, or more shared memory (container: --shm-size=2g)"
            ) from error
        return cls(memory, SharedLayout(memory.name, places), owned=True)

    @classmethod
    def join(cls, plan: SharedLayout) -> "SharedArrays":
        """Open a block that another process has made."""
        return cls(SharedMemory(name=plan.name), plan, owned=False)

    def arrays(self) -> dict[str, np.ndarray]:
        """Return the arrays by their names; they are the memory itself."""
        return {name: self.array(place) for name, place in self.plan.places.items()}

    def array(self, place: ArrayPlace) -> np.ndarray:
        """Return the array at a place."""
        array = np.ndarray(place.shape, place.dtype, self._memory.buf, place.offset)
        array.flags.writeable = place.writeable
        return array

    def close(self) -> None:
        """Let go of the memory; its maker takes it away. Arrays of it must be gone."""
        try:
            self._memory.close()
        except BufferError:  # Somebody still holds an array: it goes with the process.
            pass
        finally:
            if self._owned:
                self._owned = False
                self._memory.unlink()
