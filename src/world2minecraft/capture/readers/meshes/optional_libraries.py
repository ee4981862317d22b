"""Import of libraries that only some file formats require."""

from importlib import import_module
from typing import Any

from world2minecraft.core.errors import MissingExtraError


def import_optional(name: str, doing: str, extra: str = "capture") -> Any:
    """Import a module of an optional library.

    Args:
        name: Name of the module.
        doing: The task that requires the module, such as ``reading E57 clouds``.
        extra: The extra of this package that installs the library.

    Raises:
        MissingExtraError: If the library is not installed.
    """
    try:
        return import_module(name)
    except ImportError as error:
        raise MissingExtraError(doing, extra) from error
