"""Import paths of version 0.1 that the documentation named, with a deprecation warning.

``former_names.txt`` lists each former module of the package, with its present name if it can be run
or imported as a whole, followed by one indented line per name with its present module and, if it
was renamed, its present name. The table is read only when an import of a module of this package
fails, so it costs nothing otherwise.
"""

import importlib.abc
import importlib.machinery
import runpy
import sys
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.resources import files
from types import CodeType, ModuleType
from typing import Any

PACKAGE = "world2minecraft"


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


def install() -> None:
    """Let the imports of former modules succeed, after all other finders have failed."""
    if not any(isinstance(finder, _FormerModuleFinder) for finder in sys.meta_path):
        sys.meta_path.append(_FormerModuleFinder())


class _CallableModule(ModuleType):
    """A former module with the name of a public function, which its import replaces."""

    def __call__(self, *args: Any, **options: Any) -> Any:
        """Call the public function."""
        api = import_module(f"{PACKAGE}.api")
        return getattr(api, self.__name__.removeprefix(f"{PACKAGE}."))(*args, **options)


class _FormerModuleFinder(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Finds the former modules, which contain nothing but a ``__getattr__``."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        """Return the spec of a former module or of a package of such; None for all others."""
        package, _, short = fullname.partition(".")
        if package != PACKAGE or not short:
            return None
        inside = any(name.startswith(f"{short}.") for name in former_modules())
        if short not in former_modules() and not inside:
            return None
        return importlib.machinery.ModuleSpec(fullname, self, is_package=inside)

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType | None:
        """Return an empty module, or None to let the import system create one."""
        short = spec.name.removeprefix(f"{PACKAGE}.")
        is_public = short in import_module(PACKAGE).__all__
        return _CallableModule(spec.name) if is_public else None

    def exec_module(self, module: ModuleType) -> None:
        """Give the module its ``__getattr__``."""
        setattr(module, "__getattr__", getter(module.__name__))  # noqa: B010
        former = former_modules().get(module.__name__.removeprefix(f"{PACKAGE}."))
        if former is not None and former.present:
            import_module(f"{PACKAGE}.{former.present}")

    def get_code(self, fullname: str) -> CodeType:
        """Return the code that ``python -m`` runs."""
        return compile(
            f"from {__name__} import run_former; run_former({fullname!r})", fullname, "exec"
        )


def _warn(text: str) -> None:
    warnings.warn(text, DeprecationWarning, stacklevel=3)
