"""Import of libraries that only some formats need."""

from importlib import import_module
from typing import Any

from world2minecraft.core.errors import MissingExtraError


def import_optional(name: str, doing: str, extra: str = "capture") -> Any:
    """Return a module of an optional library.

    Args:
        name: of the module.
        doing: what needs it, such as ``reading E57 clouds``.
        extra: the extra that installs it.

    Raises:
        MissingExtraError: it is not installed.
    """
    try:
        return import_module(name)
    except ImportError as error:
        raise MissingExtraError(doing, extra) from error
