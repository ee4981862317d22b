"""Conversion of the texture descriptions in the data files to texture recipe names.

A description such as ``"planks self,self*0.6 boards=4 half={half}"`` and a block state give the
canonical recipe ``own:planks#a2834f,#614e2f?boards=4&half=upper``. A description consists of the
generator, the colours and the options. A colour is ``self`` (the colour of the block), ``#rrggbb``
or ``@block`` (the colour of that block), optionally followed by ``*factor``, or ``a~b~share`` for a
mixture of a with a share of b. The first colour is the mean of the texture, so the colour of a
flower must include its stem. Braces contain the name of a property.
"""

from collections.abc import Mapping

from world2minecraft.minecraft.block_colours import colour_of

PREFIX = "own:"


def recipe_of(words: str, name: str, values: Mapping[str, str]) -> str:
    """Return the canonical recipe of a texture.

    Args:
        words: Texture description, as explained in the module docstring.
        name: Full name of the block, for ``self``.
        values: Properties of the block state.

    Example:
        >>> recipe_of("planks #FF0000*0.5 half={half}", "a:b", {"half": "upper"})
        'own:planks#800000?half=upper'
    """
    generator, *rest = words.format_map(Values(values)).split()
    options = sorted(word for word in rest if "=" in word)
    colours = [word for word in rest if "=" not in word]
    spelled = ",".join(_colour(one, name) for many in colours for one in many.split(","))
    query = "?" + "&".join(options) if options else ""
    return f"{PREFIX}{generator}{spelled}{query}"


def split_recipe(
    recipe: str,
) -> tuple[str, tuple[tuple[int, int, int], ...], dict[str, str]]:
    """Return the generator, the colours (sRGB bytes) and the options of a recipe.

    Example:
        >>> split_recipe("own:planks#800000?half=upper")
        ('planks', ((128, 0, 0),), {'half': 'upper'})
    """
    head, _, query = recipe.removeprefix(PREFIX).partition("?")
    generator, *colours = head.split("#")
    values = tuple(_bytes(one.strip(",")) for one in colours)
    pairs = (pair.partition("=") for pair in query.split("&") if pair)
    return generator, values, {key: value for key, _, value in pairs}


def hex_colour(rgb: tuple[int, int, int]) -> str:
    """Return a colour as ``#rrggbb``."""
    return "#{:02x}{:02x}{:02x}".format(*rgb)


def _bytes(text: str) -> tuple[int, int, int]:
    return int(text[0:2], 16), int(text[2:4], 16), int(text[4:6], 16)


def _colour(word: str, name: str) -> str:
    first, *mixed = word.split("~")
    rgb = _plain_colour(first, name)
    if mixed:
        other, share = _plain_colour(mixed[0], name), float(mixed[1])
        rgb = [a + (b - a) * share for a, b in zip(rgb, other, strict=True)]
    red, green, blue = (min(255, round(part)) for part in rgb)
    return hex_colour((red, green, blue))


def _plain_colour(word: str, name: str) -> list[float]:
    base, _, factor = word.partition("*")
    if base == "self":
        rgb = colour_of(name)
    elif base.startswith("@"):
        rgb = colour_of(base[1:])
    else:
        rgb = _bytes(base.lstrip("#").lower())
    return [part * float(factor or 1) for part in rgb]


class Values(dict):
    """Properties of a block state, in which missing properties are empty strings."""

    def __missing__(self, key: str) -> str:
        return ""


def values_of(name: str, properties: Mapping[str, str]) -> Values:
    """Return the values that braces may name: the properties, and parts of the block's name.

    ``plain`` is the name, ``stem`` is the name without its last word, ``last`` is that word,
    ``inside`` is the plant in a pot, and ``wire`` is the colour of redstone dust at its power.
    """
    plain = name.partition(":")[2]
    stem, _, last = plain.rpartition("_")
    power = properties.get("power", "")
    red = 76 + min(int(power), 15) * 179 // 15 if power.isdecimal() and len(power) < 3 else 76
    wire = hex_colour((red, red // 12, red // 24))
    inside = plain.removeprefix("potted_")
    return Values(properties, plain=plain, stem=stem, last=last, inside=inside, wire=wire)
