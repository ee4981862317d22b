"""A generator of textures: what it paints, its accents and options, and its laws."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from world2minecraft.rendering.textures.canvas import Canvas
from world2minecraft.rendering.textures.recipe import Number, Option, Recipe, rgb_of
from world2minecraft.rendering.textures.texture_baking import TONE_FLOOR, TONE_OF_COLOUR, Surface

# Every generator has these: other noise, and more or less contrast.
SHARED: Mapping[str, Option] = {"seed": Number(0, 0, 1e9), "contrast": Number(1.0, 0.0, 3.0)}


@dataclass(frozen=True)
class Accent:
    """A colour after the first: what it is for, and its default.

    That is a tone of the first colour, or ``#rrggbb``, of which ``share`` is mixed with the first.
    """

    name: str
    default: str | float
    share: float = 1.0

    def colour(self, main: tuple[int, int, int]) -> tuple[int, int, int]:
        """Return sRGB of the default beside a main colour."""
        if isinstance(self.default, str):
            levels = zip(main, rgb_of(self.default), strict=True)
            red, green, blue = (round(old + (new - old) * self.share) for old, new in levels)
            return red, green, blue
        red, green, blue = (
            round(
                min(255.0, max(0.0, level + self.default * (level * TONE_OF_COLOUR + TONE_FLOOR)))
            )
            for level in main
        )
        return red, green, blue


@dataclass(frozen=True)
class Generator:
    """One kind of texture.

    ``sample`` is a recipe's tail, for pictures of the whole set. ``holes`` and ``translucent``
    list the values of an option ("key=value") that make it so, or ``("*",)`` for always.
    ``tiles`` says that no seam is seen where two lie side by side; False for frames and pictures.
    """

    paint: Callable[[Canvas, Recipe], Surface]
    sample: str
    accents: tuple[Accent, ...] = ()
    options: Mapping[str, Option] = field(default_factory=dict)
    holes: tuple[str, ...] = ()
    translucent: tuple[str, ...] = ()
    tiles: bool = True

    @property
    def about(self) -> str:
        """One sentence on what it shows."""
        return (self.paint.__doc__ or "").strip()

    @property
    def all_options(self) -> dict[str, Option]:
        """Its own options and those that all generators have."""
        return {**self.options, **SHARED}
