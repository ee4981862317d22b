"""Real rooms become Minecraft scenes that people can walk in and robots can learn in.

The tree is the way of the data: ``scan`` -> ``occupy`` -> ``fuse`` -> ``label`` -> ``find`` ->
``furnish`` -> ``build``, joined by ``pipeline``. The values that cross between the stages are in
``types``; the one place that knows axis conventions is ``coordinates``.
"""

__version__ = "0.1.0"
