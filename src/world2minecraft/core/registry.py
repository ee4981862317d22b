"""Names to implementations: built-in ones by one line each, others by entry points.

A registry is made with ``{"name": "module:attribute"}``; the module is imported when its name is
asked for, so that a registry costs nothing until it is used. Packages outside add theirs through
the entry point group ``world2minecraft.<kind>``.
"""

from collections.abc import Mapping
from importlib import import_module
from importlib.metadata import entry_points
from typing import Any

from world2minecraft.core.errors import UnknownNameError


class Registry:
    """A closed set of built-in names, open to entry points."""

    def __init__(self, kind: str, builtins: Mapping[str, str]):
        self.kind = kind
        self._builtins = dict(builtins)

    def names(self) -> tuple[str, ...]:
        """All names: the built-in ones in their order, then those of other packages, sorted."""
        found = {point.name for point in self._points()} - set(self._builtins)
        return (*self._builtins, *sorted(found))

    def load(self, name: str) -> Any:
        """Return what is registered under ``name``.

        Raises:
            UnknownNameError: nothing is; the message suggests the nearest name.
        """
        if name in self._builtins:
            module, _, attribute = self._builtins[name].partition(":")
            return getattr(import_module(module), attribute)
        for point in self._points():
            if point.name == name:
                return point.load()
        raise UnknownNameError(self.kind, name, self.names())

    def _points(self) -> list[Any]:
        return list(entry_points(group=f"world2minecraft.{self.kind}"))
