"""The definition of a texture generator: its paint function, accents, options and properties."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from world2minecraft.rendering.textures.canvas import Canvas
from world2minecraft.rendering.textures.recipe import Number, Option, Recipe, rgb_of
from world2minecraft.rendering.textures.texture_baking import TONE_FLOOR, TONE_OF_COLOUR, Surface

# Every generator has these: other noise, and more or less contrast.
SHARED: Mapping[str, Option] = {"seed": Number(0, 0, 1e9), "contrast": Number(1.0, 0.0, 3.0)}


@dataclass(frozen=True)
class Accent:
    """A colour after the main colour: its purpose and its default.

    The default is a tone of the main colour, or ``#rrggbb`` mixed with the main colour by
    ``share``.
    """

    name: str
    default: str | float
    share: float = 1.0

    def colour(self, main: tuple[int, int, int]) -> tuple[int, int, int]:
        """Return the default sRGB colour for a main colour."""
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
    """A kind of texture.

    ``sample`` is the end of a recipe, used for contact sheets. ``holes`` and ``translucent`` list
    the option values ("key=value") for which the texture has this property, or ``("*",)`` for
    always. ``tiles`` says whether adjacent textures have no visible seam, which is False for frames
    and pictures.
    """

    paint: Callable[[Canvas, Recipe], Surface]
    sample: str
    accents: tuple[Accent, ...] = ()
    options: Mapping[str, Option] = field(default_factory=dict)
    holes: tuple[str, ...] = ()
    translucent: tuple[str, ...] = ()
    tiles: bool = True

    @property
    def all_options(self) -> dict[str, Option]:
        """The generator's own options and the options that all generators share."""
        return {**self.options, **SHARED}
