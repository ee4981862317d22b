"""Registers the environments with Gymnasium; each is imported when one is made.

Gymnasium before 1.0 calls ``register_environments`` through the entry point ``gymnasium.envs``.
Later releases load no plugins, so ``import world2minecraft`` registers the environments as soon as
Gymnasium is imported, before or after it. Nothing here imports Gymnasium on its own.
"""

import importlib.abc
import importlib.machinery
import sys
from collections.abc import Sequence
from types import ModuleType

ENV_ID = "world2minecraft/MinecraftVLN-v0"
SERVER_ENV_ID = "world2minecraft/MinecraftVLN-Server-v0"
ENTRY_POINTS = {
    ENV_ID: "world2minecraft.navigation.environment.env:VlnEnv",
    SERVER_ENV_ID: "world2minecraft.navigation.server.env:ServerEnv",
    "World2Minecraft-VLN-v0": "world2minecraft.navigation.environment.env:FormerIdEnv",
    "World2Minecraft-VLN-Server-v0": "world2minecraft.navigation.server.env:FormerIdServerEnv",
}


def register_environments() -> None:
    """Register the environments with Gymnasium, once.

    Raises:
        MissingExtraError: Gymnasium is not installed.
    """
    try:
        from gymnasium.envs.registration import register, registry  # noqa: PLC0415  # An extra.
    except ImportError as error:
        from world2minecraft.core.errors import MissingExtraError  # noqa: PLC0415

        raise MissingExtraError("the environment", "vln") from error
    for name, entry_point in ENTRY_POINTS.items():
        if name not in registry:
            register(name, entry_point)


def register_with_gymnasium() -> None:
    """Register the environments now where Gymnasium is imported, else when it will be."""
    if "gymnasium" in sys.modules:
        register_environments()
    elif not any(isinstance(finder, _GymnasiumFinder) for finder in sys.meta_path):
        sys.meta_path.insert(0, _GymnasiumFinder())


class _GymnasiumFinder(importlib.abc.MetaPathFinder):
    """Finds Gymnasium as the other finders do, with a loader that registers the environments."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        """Return the spec of Gymnasium; None for every other module."""
        if fullname != "gymnasium":
            return None
        for finder in sys.meta_path:
            if isinstance(finder, _GymnasiumFinder):
                continue
            spec = finder.find_spec(fullname, path, target)
            if spec is not None:
                if spec.loader is not None:
                    spec.loader = _RegisteringLoader(spec.loader)
                return spec
        return None


class _RegisteringLoader(importlib.abc.Loader):
    """Executes Gymnasium by its own loader, then registers the environments."""

    def __init__(self, loader: importlib.abc.Loader):
        self._loader = loader

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType | None:
        """Create the module as its own loader does."""
        return self._loader.create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        """Execute the module under its own loader, so that nothing else sees the difference."""
        module.__loader__ = self._loader
        if module.__spec__ is not None:
            module.__spec__.loader = self._loader
        self._loader.exec_module(module)
        register_environments()
