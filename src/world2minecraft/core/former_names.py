"""Import paths of version 0.1 that the documentation named, with a deprecation warning.

``former_names.txt`` lists each former module of the package, with its present name if it can be run
or imported as a whole, followed by one indented line per name with its present module and, if it
was renamed, its present name. ``former_imports`` reads the table only when an import of a module of
this package fails, so it costs nothing otherwise.
"""

import runpy
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.resources import files
from typing import Any

from world2minecraft.core.former_imports import PACKAGE


@dataclass(frozen=True)
class FormerModule:
    """A module of version 0.1.

    Attributes:
        present: Name of the module that replaces it, without the package; empty if none does.
        names: Present module and present name of each former name.
    """

    present: str
    names: dict[str, tuple[str, str]]


@cache
def former_modules() -> dict[str, FormerModule]:
    """Return the former modules by their names, without the package."""
    table: dict[str, FormerModule] = {}
    names: dict[str, tuple[str, str]] = {}
    listed = files(f"{PACKAGE}.core").joinpath("former_names.txt").read_text("utf-8")
    for line in listed.splitlines():
        if line.startswith(" "):
            former, module, *renamed = line.split()
            names[former] = (module, renamed[0] if renamed else former)
        else:
            former, _, present = line.partition(" ")
            names = {}
            table[former] = FormerModule(present, names)
    return table


def run_former(name: str) -> None:
    """Run the module that replaces a former one, as ``python -m`` does.

    Args:
        name: Full name of the former module.
    """
    present = f"{PACKAGE}.{former_modules()[name.removeprefix(PACKAGE + '.')].present}"
    _warn(f"{name} has moved; run python -m {present} instead")
    runpy.run_module(present, run_name="__main__", alter_sys=True)


def getter(module: str) -> Callable[[str], Any]:
    """Return a ``__getattr__`` for a module, which resolves the former names of the module.

    Args:
        module: Full name of the module, former or present.
    """
    short = module.removeprefix(f"{PACKAGE}.")

    def __getattr__(name: str) -> Any:
        former = former_modules().get(short)
        if former is None or name not in former.names:
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        target, present = former.names[name]
        path = f"{PACKAGE}.{target}"
        _warn(f"{module}.{name} has moved; import {present} from {path} instead")
        return getattr(import_module(path), present)

    return __getattr__


def _warn(text: str) -> None:
    warnings.warn(text, DeprecationWarning, stacklevel=3)
