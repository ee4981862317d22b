"""Work on several cores in threads, with results that do not depend on the number of threads.

Kernels, image decoders and network inference release the GIL, so threads suffice.
"""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

from world2minecraft.core.machine import usable_cores

Item = TypeVar("Item")
Result = TypeVar("Result")

END: Any = object()


def map_parallel(work: Callable[[Item], Result], items: Sequence[Item]) -> list[Result]:
    """Return the results of a function for all items, computed on all usable cores.

    If calls raise exceptions, that of the first such item is raised after all calls have ended.
    """
    threads = min(usable_cores(), len(items))
    if threads < 2:
        return [work(item) for item in items]
    with ThreadPoolExecutor(threads, "world2minecraft-map") as pool:
        return list(pool.map(work, items))


def read_ahead(items: Iterable[Item], count: int = 2) -> Iterator[Item]:
    """Yield items in order while a thread computes up to ``count`` further ones.

    A chain of generators, such as decoding, lifting and fusing of frames, runs on as many cores as
    it has links, and each link still processes its items one by one in order. On one core, the
    items are computed when they are needed. An exception of an item is raised at its place. Closing
    the generator early closes ``items``.
    """
    if usable_cores() < 2:
        yield from items
        return
    iterator = iter(items)
    pool = ThreadPoolExecutor(1, "world2minecraft-ahead")
    try:
        pending = deque(pool.submit(next, iterator, END) for _ in range(count))
        while (item := pending.popleft().result()) is not END:
            pending.append(pool.submit(next, iterator, END))
            yield item
    finally:
        pool.shutdown(cancel_futures=True)
        close = getattr(iterator, "close", None)
        if close is not None:
            close()
