"""Engines that run the tasks of a data set build: this process, a process pool or Ray.

All engines call the same function with the same items, so they all produce identical files.
"""

from world2minecraft.minecraftocc.engine.engines import (
    ENGINES,
    Engine,
    InProcessEngine,
    open_engine,
)
from world2minecraft.minecraftocc.engine.process_pool import PoolEngine

__all__ = ["ENGINES", "Engine", "InProcessEngine", "PoolEngine", "open_engine"]
