"""Declare the parameters of a stage: each with its default, its unit, and where its number is from.

A stage's parameters are a frozen dataclass whose fields are made by ``parameter``. What lists
parameters reads these declarations: no name is written down twice.
"""

from dataclasses import field, fields
from typing import Any


def parameter(default: Any = None, *, unit: str = "", origin: str = "", **facts: Any) -> Any:
    """Return a dataclass field that declares a parameter.

    Args:
        default: its value where nobody chooses another; a class makes a fresh value of its own.
        unit: such as ``m`` or ``cells``; nothing for a name, a switch or a group.
        origin: where the default comes from.
        **facts: what else listings ask for, such as the bounds that a check names.
    """
    metadata = {"unit": unit, "origin": origin, **facts}
    if isinstance(default, type):
        return field(default_factory=default, metadata=metadata)
    return field(default=default, metadata=metadata)


def names_where(parameters: Any, **facts: Any) -> tuple[str, ...]:
    """Return the names of the parameters that were declared with these facts, in order."""
    return tuple(
        entry.name
        for entry in fields(parameters)
        if all(entry.metadata.get(key) == value for key, value in facts.items())
    )


def fact_by_name(parameters: Any, fact: str) -> dict[str, Any]:
    """Return a fact, such as the limits, by the names of the parameters declared with it, in order.

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
