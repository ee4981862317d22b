"""Registration of the environments with Gymnasium, without importing them.

Gymnasium before 1.0 calls ``register_environments`` through the entry point ``gymnasium.envs``.
Later releases load no plug-ins, so ``import world2minecraft`` registers the environments as soon as
Gymnasium is imported. This module never imports Gymnasium on its own.
"""

from __future__ import annotations

import sys

TYPE_CHECKING = False  # The module typing takes longer to import than all of this package.
if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.abc import Loader
    from importlib.machinery import ModuleSpec
    from types import ModuleType
else:
    Loader = object

ENV_ID = "world2minecraft/MinecraftVLN-v0"
SERVER_ENV_ID = "world2minecraft/MinecraftVLN-Server-v0"
ENTRY_POINTS = {
    ENV_ID: "world2minecraft.navigation.environment.env:VlnEnv",
    SERVER_ENV_ID: "world2minecraft.navigation.server.env:ServerEnv",
    "World2Minecraft-VLN-v0": "world2minecraft.navigation.environment.env:FormerIdEnv",
    "World2Minecraft-VLN-Server-v0": "world2minecraft.navigation.server.env:FormerIdServerEnv",
}


def register_environments() -> None:
    """Register the environments with Gymnasium, unless they are already registered.

    Raises:
        MissingExtraError: If Gymnasium is not installed.
    """
    try:
        from gymnasium.envs.registration import register, registry  # noqa: PLC0415  # An extra.
    except ImportError as error:
        from world2minecraft.core.errors import MissingExtraError  # noqa: PLC0415

        raise MissingExtraError("the Gymnasium environment", "vln") from error
    for name, entry_point in ENTRY_POINTS.items():
        if name not in registry:
            register(name, entry_point)


def register_with_gymnasium() -> None:
    """Register the environments now if Gymnasium is imported, or when it is imported later."""
    if "gymnasium" in sys.modules:
        register_environments()
    elif not any(isinstance(finder, _GymnasiumFinder) for finder in sys.meta_path):
        sys.meta_path.insert(0, _GymnasiumFinder())


class _GymnasiumFinder:
    """A finder that wraps Gymnasium's loader in order to register the environments."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the spec of Gymnasium, or None for every other module."""
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


class _RegisteringLoader(Loader):
    """A loader that executes Gymnasium with its own loader and registers the environments."""

    def __init__(self, loader: Loader):
        self._loader = loader

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        """Create the module with Gymnasium's own loader."""
        return self._loader.create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        """Execute the module with its own loader restored, then register the environments."""
        module.__loader__ = self._loader
        if module.__spec__ is not None:
            module.__spec__.loader = self._loader
        self._loader.exec_module(module)
        register_environments()
