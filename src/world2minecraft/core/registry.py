"""Registries that map names to implementations, built-in or added by other packages.

A registry is created with ``{"name": "module:attribute"}``. A module is imported only when its name
is requested. Other packages register implementations with the entry point group
``world2minecraft.<kind>``.
"""

import sys
from collections.abc import Mapping
from functools import lru_cache
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from world2minecraft.core.errors import UnknownNameError


class Registry:
    """A registry of built-in names that entry points can extend."""

    def __init__(self, kind: str, builtins: Mapping[str, str]):
        self.kind = kind
        self._builtins = dict(builtins)

    def names(self) -> tuple[str, ...]:
        """Return the built-in names in order, then the names of other packages, sorted."""
        found = {point.name for point in self._points()} - set(self._builtins)
        return (*self._builtins, *sorted(found))

    def load(self, name: str) -> Any:
        """Return the implementation registered under ``name``.

        Raises:
            UnknownNameError: If the name is not registered. The message suggests the closest match.
        """
        if name in self._builtins:
            module, _, attribute = self._builtins[name].partition(":")
            return getattr(import_module(module), attribute)
        for point in self._points():
            if point.name == name:
                return point.load()
        raise UnknownNameError(self.kind, name, self.names())

    def _points(self) -> tuple[EntryPoint, ...]:
        return points_of(f"world2minecraft.{self.kind}", tuple(sys.path))


@lru_cache(maxsize=64)
def points_of(group: str, search_path: tuple[str, ...]) -> tuple[EntryPoint, ...]:
    """Return the entry points of a group. The search reads the metadata of all packages: 10 ms."""
    return tuple(entry_points(group=group))
