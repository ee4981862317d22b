"""The public functions and types, one module for each noun; the command line calls nothing else.

``world2minecraft`` offers the same names, so that ``w2m.reconstruct`` is ``api.rooms.reconstruct``.
A module is imported when one of its names is first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:


__all__ = [
]

_MODULES = {
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names}


def __getattr__(name: str) -> Any:
    """Import the module of a public name when it is first used."""
    if name not in _HOMES:
        raise AttributeError(f"module 'world2minecraft' has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    """List the public names."""
    return sorted(__all__)
