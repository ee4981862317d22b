"""Stage 4: what each occupied cell is.

A labeller takes the grid and the evidence behind it and gives the grid back with classes and
confidence. It never empties an observed cell and never fills an empty one.
"""

from world2minecraft.label.labellers import LABELLERS, Labeller

__all__ = ["LABELLERS", "Labeller"]
