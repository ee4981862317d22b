"""Real rooms become Minecraft scenes that people can walk in and robots can learn in.

The public functions and types are those of ``__all__``, each imported when it is first used::

    import world2minecraft as w2m

    run = w2m.reconstruct("my_scan", "OUT")
    w2m.render(run)

The package follows the data: ``capture`` -> ``reconstruction`` -> ``construction``; the values that
pass between the stages are in ``core.types``, axis conventions in ``core.coordinates``.
"""

from __future__ import annotations

from importlib import import_module

from world2minecraft.core import former_imports
from world2minecraft.navigation.gymnasium_plugin import register_with_gymnasium

TYPE_CHECKING = False  # The module typing takes longer to import than all of this package.
if TYPE_CHECKING:
    from typing import Any

    from world2minecraft.api import *  # noqa: F403
    from world2minecraft.core import errors as errors

__version__ = "0.2.0"

register_with_gymnasium()  # As soon as Gymnasium is imported, which this does not do.
former_imports.install()


def __getattr__(name: str) -> Any:
    """Import a public name when it is first used."""
    if name == "errors":
        return import_module("world2minecraft.core.errors")
    if name.startswith("_") and name != "__all__":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    api = import_module("world2minecraft.api")
    return [*api.__all__, "errors"] if name == "__all__" else getattr(api, name)


def __dir__() -> list[str]:
    """List the public names."""
    return sorted([*import_module("world2minecraft.api").__all__, "errors", "__version__"])
