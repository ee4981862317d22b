"""A faulty source becomes the code of a module that is loaded and that tests hold by its names.

The functions stay the objects that they are and get other code, so that whoever imported one runs
the fault. That is not enough for a compiled kernel; so those run as plain Python here.
"""

import sys
from functools import cached_property
from types import FunctionType, ModuleType
from typing import Any

import numpy as np


class LoadError(Exception):
    """A fault that shows as soon as the module is loaded."""


def graft(module: ModuleType, source: str, in_function: bool) -> None:
    """Give a module's functions the code of ``source``.

    Args:
        module: a loaded one.
        source: its source with a fault.
        in_function: whether the fault is within a function. Else values of the module may differ,
            and are replaced wherever they are known by the same name.

    Raises:
        LoadError: the source cannot even be loaded.
    """
    scratch = _executed(module, source)
    for name, new in vars(scratch).items():
        old = vars(module).get(name)
        if getattr(new, "__module__", None) == module.__name__ and _is_code(new):
            _graft_one(old, new)
        elif not in_function and not isinstance(new, ModuleType) and not name.startswith("__"):
            _replace(name, old, new)


def _executed(module: ModuleType, source: str) -> ModuleType:
    """Return a module of the same name and file that was run from ``source``."""
    scratch = ModuleType(module.__name__)
    for name in ("__file__", "__package__"):
        setattr(scratch, name, vars(module)[name])
    sys.modules[module.__name__] = scratch  # Dataclasses ask for their module.
    try:
        exec(compile(source, str(module.__file__), "exec"), scratch.__dict__)
    except Exception as error:
        raise LoadError(str(error)) from error
    finally:
        sys.modules[module.__name__] = module
    return scratch


def _is_code(value: Any) -> bool:
    return isinstance(value, FunctionType | type) or hasattr(value, "__wrapped__")


def _graft_one(old: Any, new: Any) -> None:
    """Carry code and default values from a function, method or class to its like."""
    if isinstance(new, property):
        _graft_one(old.fget, new.fget)
    elif isinstance(new, staticmethod | classmethod):
        _graft_one(old.__func__, new.__func__)
    elif isinstance(new, FunctionType):
        old.__code__, old.__defaults__ = new.__code__, new.__defaults__
        old.__kwdefaults__ = new.__kwdefaults__
    elif isinstance(new, type):
        for name, value in vars(new).items():
            if isinstance(value, FunctionType | property | staticmethod | classmethod):
                _graft_one(vars(old)[name], value)
            elif isinstance(value, cached_property):
                _graft_one(vars(old)[name].func, value.func)
            elif isinstance(value, int | float | str | tuple) and not name.startswith("__"):
                setattr(old, name, value)
    elif hasattr(new, "__wrapped__"):
        _graft_one(old.__wrapped__, new.__wrapped__)
        if hasattr(old, "cache_clear"):
            old.cache_clear()


def _replace(name: str, old: Any, new: Any) -> None:
    """Put a value of a module in place of the old one wherever that is known by its name."""
    same = old is new or (type(old) is type(new) and not isinstance(old, np.ndarray) and old == new)
    if same or (isinstance(old, np.ndarray) and np.array_equal(old, new)):
        return
    for module in list(sys.modules.values()):
        if vars(module).get(name, module) is old:
            setattr(module, name, new)
