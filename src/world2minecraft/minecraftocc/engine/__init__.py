"""Engines that run the tasks of a build: this process, a pool of processes, or Ray.

All call the same function with the same items, so all make the same files.
"""

from world2minecraft.minecraftocc.engine.engines import (
    ENGINES,
    Engine,
    InProcessEngine,
    open_engine,
)
from world2minecraft.minecraftocc.engine.process_pool import PoolEngine

__all__ = ["ENGINES", "Engine", "InProcessEngine", "PoolEngine", "open_engine"]
