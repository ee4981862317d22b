"""Arrays in shared memory: written once, and visible to all processes that know their layout.

One process creates ``SharedArrays`` and frees them; others join. Arrays are aligned to cache lines.
The writeable flag is preserved, because kernels are compiled for it, and another flag would cause a
recompilation.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from multiprocessing.shared_memory import SharedMemory

import numpy as np

from world2minecraft.core.errors import UsageError

LINE_BYTES = 64


@dataclass(frozen=True)
class ArrayPlace:
    """The location of an array in a block of shared memory."""

    offset: int
    shape: tuple[int, ...]
    dtype: str
    writeable: bool = True


@dataclass(frozen=True)
class SharedLayout:
    """The data that another process needs to join a block of shared memory."""

    name: str
    places: dict[str, ArrayPlace]


def lay_out(
    rooms: Mapping[str, tuple[tuple[int, ...], np.dtype]], start: int = 0
) -> tuple[dict[str, ArrayPlace], int]:
    """Return the location of each array by its shape and dtype, and the total size."""
    places, offset = {}, start
    for name, (shape, kind) in rooms.items():
        places[name] = ArrayPlace(offset, tuple(shape), kind.str)
        size = int(np.prod(shape, dtype=object)) * kind.itemsize
        offset += -(-size // LINE_BYTES) * LINE_BYTES
    return places, offset


class SharedArrays:
    """A block of shared memory with arrays."""

    def __init__(self, memory: SharedMemory, plan: SharedLayout, *, owned: bool):
        """Wrap a block of shared memory. Use ``create`` or ``join`` instead of this constructor."""
        self.plan, self._memory, self._owned = plan, memory, owned

    @classmethod
    def create(cls, places: dict[str, ArrayPlace], size: int) -> "SharedArrays":
        """Create a block of shared memory.

        Raises:
            UsageError: If the machine does not have enough shared memory.
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
        """Open a block that another process has created."""
        return cls(SharedMemory(name=plan.name), plan, owned=False)

    def arrays(self) -> dict[str, np.ndarray]:
        """Return the arrays by name, without copying."""
        return {name: self.array(place) for name, place in self.plan.places.items()}

    def array(self, place: ArrayPlace) -> np.ndarray:
        """Return the array at a location."""
        array = np.ndarray(place.shape, place.dtype, self._memory.buf, place.offset)
        array.flags.writeable = place.writeable
        return array

    def close(self) -> None:
        """Close the block; its creator also frees it. No arrays of it may exist any more."""
        try:
            self._memory.close()
        except BufferError:  # Somebody still holds an array: it goes with the process.
            pass
        finally:
            if self._owned:
                self._owned = False
                self._memory.unlink()
