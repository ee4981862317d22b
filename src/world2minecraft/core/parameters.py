"""Declaration and description of the parameters of a stage.

The parameters of a stage are the fields of a frozen dataclass. Each field is created by
``parameter`` with its default, its unit and the origin of the default, and the docstring of the
class states its meaning. All listings of parameters read these declarations.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, fields, is_dataclass
from fnmatch import fnmatchcase
from inspect import cleandoc
from textwrap import dedent
from typing import Any

# The first line of an entry of a docstring: one or more names, a colon, the meaning.
ENTRY = re.compile(r"(?P<names>[a-z][\w*]*(?:, [a-z][\w*]*)*): (?P<meaning>.*)")


@dataclass(frozen=True)
class ParameterInfo:
    """The description of a parameter in listings.

    Attributes:
        key: Name of the parameter after the names of its groups, such as ``find.cluster_radius``.
        default: Default value.
        unit: Unit, such as ``m``. Empty for a name or a switch.
        meaning: One or more sentences from the docstring of its class.
        origin: Source of the default value.
    """

    key: str
    default: Any
    unit: str
    meaning: str
    origin: str


def parameter(default: Any = None, *, unit: str = "", origin: str = "", **facts: Any) -> Any:
    """Return a dataclass field that declares a parameter.

    Args:
        default: Default value. A class is called to create a new value for each instance.
        unit: Unit, such as ``m`` or ``cells``. Empty for a name, a switch or a group.
        origin: Source of the default value.
        **facts: Further facts for listings, such as the limits of the value.
    """
    metadata = {"unit": unit, "origin": origin, **facts}
    if isinstance(default, type):
        return field(default_factory=default, metadata=metadata)
    return field(default=default, metadata=metadata)


def names_where(parameters: Any, **facts: Any) -> tuple[str, ...]:
    """Return the names of the parameters declared with the given facts, in order."""
    return tuple(
        entry.name
        for entry in fields(parameters)
        if all(entry.metadata.get(key) == value for key, value in facts.items())
    )


def fact_by_name(parameters: Any, fact: str) -> dict[str, Any]:
    """Return a fact, such as the limits, by the names of the parameters declared with it.

    Example:
        >>> from dataclasses import dataclass
        >>> @dataclass(frozen=True)
        ... class Sweep:
        ...     planes: int = parameter(64, limits=(8, 254))
        ...     network_alone: bool = parameter(False)
        >>> fact_by_name(Sweep, "limits")
        {'planes': (8, 254)}
    """
    return {
        entry.name: entry.metadata[fact] for entry in fields(parameters) if fact in entry.metadata
    }


def describe_parameters(parameters: type) -> tuple[ParameterInfo, ...]:
    """Return a description of each parameter of a class and its groups, in order.

    Parameters that only copy another parameter, and dictionaries, which have no fixed keys, are
    omitted.

    Example:
        >>> @dataclass(frozen=True)
        ... class Sweep:
        ...     '''How planes are swept.
        ...
        ...     Attributes:
        ...         planes: Number of depths tried for each pixel.
        ...     '''
        ...
        ...     planes: int = parameter(64, unit="planes")
        >>> describe_parameters(Sweep)[0].meaning
        'Number of depths tried for each pixel'
    """
    return tuple(_describe(parameters(), ""))


def _describe(value: Any, prefix: str) -> Iterator[ParameterInfo]:
    entries = docstring_entries(type(value).__doc__ or "")
    for entry in fields(value):
        inner, facts = getattr(value, entry.name), entry.metadata
        if is_dataclass(inner):
            yield from _describe(inner, f"{prefix}{entry.name}.")
        elif "copy_of" not in facts and not isinstance(inner, dict):
            meaning = _meaning(entry.name, entries)
            unit, origin = facts.get("unit", ""), facts.get("origin", "")
            yield ParameterInfo(prefix + entry.name, inner, unit, meaning, origin)


def docstring_entries(docstring: str) -> dict[str, str]:
    """Return the entries ``name: meaning.`` of a docstring by the text before the colon.

    The entries are in the section ``Attributes:``, or unindented if there is no such section. An
    entry can describe several parameters (``width, height: ...``), or all that match a pattern
    (``bed_*: ...``). Continuation lines are indented.

    Example:
        >>> docstring_entries("bed_*: a side of a bed.")
        {'bed_*': 'a side of a bed'}
    """
    entries: dict[str, str] = {}
    names = ""
    text = cleandoc(docstring)
    _, heading, section = text.partition("\nAttributes:\n")
    if heading:
        text = dedent(re.split(r"\n(?=\S)", section)[0])
    for line in text.splitlines():
        if found := ENTRY.fullmatch(line):
            names = found["names"]
            entries[names] = found["meaning"]
        elif names and line.startswith(" "):
            entries[names] += f" {line.strip()}"
        else:
            names = ""
    return {names: text.removesuffix(".") for names, text in entries.items()}


def _meaning(name: str, entries: dict[str, str]) -> str:
    """Return the text of a parameter's entry, or of the first entry that mentions it."""
    for names, text in entries.items():
        if any(fnmatchcase(name, pattern) for pattern in names.split(", ")):
            return text
    mentions = re.compile(rf"\b{re.escape(name)}\b")
    return next((text for text in entries.values() if mentions.search(text)), "")
