"""Import hooks for the modules of version 0.1, which ``former_names`` describes.

They are installed whenever the package is imported. This module therefore imports next to nothing:
the table of former names is read only when an import of a module of this package fails.
"""

from __future__ import annotations

import sys
from importlib import import_module
from importlib.machinery import ModuleSpec
from types import ModuleType

TYPE_CHECKING = False  # The module typing takes longer to import than all of this package.
if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.abc import Loader
    from types import CodeType
    from typing import Any
else:
    Loader = object

PACKAGE = "world2minecraft"
PUBLIC = {"errors": "core.errors"}  # Modules that are found under a public name as well.


class FormerModule(ModuleType):
    """A module of version 0.1. It contains nothing but a ``__getattr__``."""


class PublicPackage(ModuleType):
    """The package, whose public functions are not replaced by former modules of the same name.

    After ``import world2minecraft.build``, the import system sets the attribute ``build`` of the
    package to that module. The names that the module had in version 0.1 are found by
    ``from world2minecraft.build import ...``, which does not use the attribute.
    """

    def __setattr__(self, name: str, value: Any) -> None:
        """Set an attribute, except a public name to a former module."""
        if not isinstance(value, FormerModule) or name not in self.__all__:
            super().__setattr__(name, value)


def install() -> None:
    """Let the imports of former modules succeed, after all other finders have failed."""
    sys.modules[PACKAGE].__class__ = PublicPackage
    if not any(isinstance(finder, _FormerModuleFinder) for finder in sys.meta_path):
        sys.meta_path.append(_FormerModuleFinder())


class _FormerModuleFinder(Loader):
    """A finder and loader of former modules, and of modules under a public name."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the spec of a former module or of a package of such; None for all others."""
        package, _, short = fullname.partition(".")
        if package != PACKAGE or not short:
            return None
        if short in PUBLIC:
            return ModuleSpec(fullname, self)
        known = import_module(f"{PACKAGE}.core.former_names").former_modules()
        inside = any(name.startswith(f"{short}.") for name in known)
        if short not in known and not inside:
            return None
        return ModuleSpec(fullname, self, is_package=inside)

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Return an empty former module."""
        return FormerModule(spec.name)

    def exec_module(self, module: ModuleType) -> None:
        """Give the module its ``__getattr__``, or replace it by the module with a public name."""
        if (public := module.__name__.removeprefix(f"{PACKAGE}.")) in PUBLIC:
            sys.modules[module.__name__] = import_module(f"{PACKAGE}.{PUBLIC[public]}")
            return
        names = import_module(f"{PACKAGE}.core.former_names")
        setattr(module, "__getattr__", names.getter(module.__name__))  # noqa: B010
        former = names.former_modules().get(module.__name__.removeprefix(f"{PACKAGE}."))
        if former is not None and former.present:
            import_module(f"{PACKAGE}.{former.present}")

    def get_code(self, fullname: str) -> CodeType:
        """Return the code that ``python -m`` runs."""
        code = f"from {PACKAGE}.core.former_names import run_former; run_former({fullname!r})"
        return compile(code, fullname, "exec")
