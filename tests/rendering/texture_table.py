"""The table of all texture generators in Markdown, for the documentation."""

from collections.abc import Iterator

from world2minecraft.rendering.textures.catalogue import GENERATORS
from world2minecraft.rendering.textures.generator import Accent, Generator

HEAD = ("generator", "accents", "options", "notes")


def generator_table() -> str:
    """Return a Markdown table of all generators with their accents, options and properties."""
    rows = [HEAD, ("---",) * len(HEAD)]
    rows += [_row(name, generator) for name, generator in GENERATORS.items()]
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def _row(name: str, generator: Generator) -> tuple[str, ...]:
    return (
        f"`{name}`",
        ", ".join(_accent(accent) for accent in generator.accents),
        "; ".join(f"`{key}`: {option}" for key, option in generator.options.items()),
        "; ".join(_notes(generator)),
    )


def _accent(accent: Accent) -> str:
    if isinstance(accent.default, float):
        return f"{accent.name} ({accent.default:+g})"
    share = f" ({accent.share:g})" if accent.share < 1 else ""
    return f"{accent.name} `{accent.default}`{share}"


def _notes(generator: Generator) -> Iterator[str]:
    for word, values in (("holes", generator.holes), ("clear", generator.translucent)):
        if values:
            when = "" if values == ("*",) else f" ({', '.join(f'`{value}`' for value in values)})"
            yield word + when
    if not generator.tiles:
        yield "single"
