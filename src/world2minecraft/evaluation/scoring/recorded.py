"""The parameters that a run was made with, read back from its ``manifest.json``."""

from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import DamagedFileError, UsageError
from world2minecraft.core.files import read_json
from world2minecraft.reconstruction.parameters import Parameters


def recorded_parameters(out: Path) -> Parameters:
    """Return the parameters of the run in ``out``; what it did not know of has its default.

    Raises:
        InputError: there is no manifest. DamagedFileError: it holds no parameters.
    """
    path = out / "manifest.json"
    try:
        return _restored(Parameters(), read_json(path)["parameters"])
    except (KeyError, TypeError, ValueError, UsageError) as error:
        raise DamagedFileError(path, f"holds no parameters ({error})") from error


def _restored(default: Any, stated: dict[str, Any]) -> Any:
    """Return a dataclass with the values that JSON states of it, inner ones too."""
    changes = {}
    for entry in fields(default):
        if entry.name in stated:
            old, value = getattr(default, entry.name), stated[entry.name]
            if is_dataclass(old):
                value = _restored(old, value)
            elif isinstance(old, tuple):
                value = tuple(value)
            changes[entry.name] = value
    return replace(default, **changes)
