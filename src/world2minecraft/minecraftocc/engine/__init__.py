"""Who does the work of a data set: this process, a pool of processes, or many machines with Ray.

All call the same function with the same items, so all make the same files.
"""

from world2minecraft.minecraftocc.engine.choice import ENGINES, Engine, opened_engine
from world2minecraft.minecraftocc.engine.here import HereEngine
from world2minecraft.minecraftocc.engine.pool import PoolEngine

__all__ = ["ENGINES", "Engine", "HereEngine", "PoolEngine", "opened_engine"]
