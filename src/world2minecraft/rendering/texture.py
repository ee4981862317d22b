"""Textures: colours, and the material maps that the path tracer reads."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

SIZES_PX = (16, 32, 64, 128)  # The sides of the textures in an atlas.
MAX_SIDE_PX = 1024  # A side; larger ones are a mistake or a trap.


@dataclass(frozen=True, eq=False)
class Texture:
    """The square texture of a face.

    ``colour`` uint8 [N, N, 4] is sRGB and alpha (0 for a hole, 255 for opaque). The other maps may
    be None: ``normal`` uint8 [N, N, 3] in tangent space, x along u, y along v (down), z outward,
    128 for 0; ``roughness``, ``metal`` and ``emission`` uint8 [N, N], 0 to 255 for 0 to 1
    (perceptual roughness). If ``translucent`` is True, alpha blends with the background, as in
    stained glass; otherwise alpha below 128 is a hole.
    """

    colour: np.ndarray
    normal: np.ndarray | None = None
    roughness: np.ndarray | None = None
    metal: np.ndarray | None = None
    emission: np.ndarray | None = None
    translucent: bool = False

    def __post_init__(self):
        shape = self.colour.shape
        if self.colour.dtype != np.uint8 or len(shape) != 3 or shape[2] != 4:
            raise ValueError(f"colour must be uint8 [N, N, 4], got {self.colour.dtype} {shape}")
        if shape[0] != shape[1] or not 1 <= shape[0] <= MAX_SIDE_PX:
            raise ValueError(
                f"a texture must be square with 1 to {MAX_SIDE_PX} pixels, got {shape[:2]}"
            )
        for name, depth in (("normal", (3,)), ("roughness", ()), ("metal", ()), ("emission", ())):
            value = getattr(self, name)
            if value is None:
                continue
            if value.dtype != np.uint8 or value.shape != (*shape[:2], *depth):
                raise ValueError(
                    f"{name} must be uint8 {[*shape[:2], *depth]}, got {value.dtype} {value.shape}"
                )

    @cached_property
    def has_holes(self) -> bool:
        """Whether rays may pass through the texture, by holes or translucency."""
        return self.translucent or bool((self.colour[..., 3] < 128).any())
