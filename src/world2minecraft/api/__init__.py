"""The public functions and types, grouped into one module per topic.

The command line is built on these modules alone. The package ``world2minecraft`` exports the same
names, so ``w2m.reconstruct`` is ``api.rooms.reconstruct``. Each module is imported on first use of
one of its names.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from world2minecraft.api.agents import evaluate_agent, run_agent
    from world2minecraft.api.captures import inspect_capture, join_rooms
    from world2minecraft.api.dataset_contents import dataset_statistics
    from world2minecraft.api.datasets import (
        build_dataset,
        export_dataset,
        import_dataset,
        open_dataset,
        verify_dataset,
    )
    from world2minecraft.api.editor import open_editor
    from world2minecraft.api.existing_worlds import build_into_world, build_on_server
    from world2minecraft.api.furniture import list_furniture
    from world2minecraft.api.generation import (
        demo,
        evaluate,
        generate_house,
        generate_room,
        scan_room,
    )
    from world2minecraft.api.navigation import build_navigation_set, export_navigation_set, make_env
    from world2minecraft.api.networks import (
        evaluate_network,
        export_network,
        predict_occupancy,
        train_network,
    )
    from world2minecraft.api.parameters import settings
    from world2minecraft.api.pictures import render, render_files
    from world2minecraft.api.progress import show_progress
    from world2minecraft.api.repairs import repair
    from world2minecraft.api.results import Room, Run, load
    from world2minecraft.api.rooms import build, reconstruct
    from world2minecraft.api.sharing import share
    from world2minecraft.api.worlds import convert, install_world, undo_build

__all__ = [
    "Room",
    "Run",
    "build",
    "build_dataset",
    "build_into_world",
    "build_navigation_set",
    "build_on_server",
    "convert",
    "dataset_statistics",
    "demo",
    "evaluate",
    "evaluate_agent",
    "evaluate_network",
    "export_dataset",
    "export_navigation_set",
    "export_network",
    "generate_house",
    "generate_room",
    "import_dataset",
    "inspect_capture",
    "install_world",
    "join_rooms",
    "list_furniture",
    "load",
    "make_env",
    "open_dataset",
    "open_editor",
    "predict_occupancy",
    "reconstruct",
    "render",
    "render_files",
    "repair",
    "run_agent",
    "scan_room",
    "settings",
    "share",
    "show_progress",
    "train_network",
    "undo_build",
    "verify_dataset",
]

_MODULES = {
    "agents": (
        "evaluate_agent",
        "run_agent",
    ),
    "captures": (
        "inspect_capture",
        "join_rooms",
    ),
    "dataset_contents": ("dataset_statistics",),
    "datasets": (
        "build_dataset",
        "export_dataset",
        "import_dataset",
        "open_dataset",
        "verify_dataset",
    ),
    "editor": ("open_editor",),
    "existing_worlds": (
        "build_into_world",
        "build_on_server",
    ),
    "furniture": ("list_furniture",),
    "generation": (
        "demo",
        "evaluate",
        "generate_house",
        "generate_room",
        "scan_room",
    ),
    "navigation": (
        "build_navigation_set",
        "export_navigation_set",
        "make_env",
    ),
    "networks": (
        "evaluate_network",
        "export_network",
        "predict_occupancy",
        "train_network",
    ),
    "parameters": ("settings",),
    "pictures": (
        "render",
        "render_files",
    ),
    "progress": ("show_progress",),
    "repairs": ("repair",),
    "results": (
        "Room",
        "Run",
        "load",
    ),
    "rooms": (
        "build",
        "reconstruct",
    ),
    "sharing": ("share",),
    "worlds": (
        "convert",
        "install_world",
        "undo_build",
    ),
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names}


def __getattr__(name: str) -> Any:
    """Import the module that defines a public name when the name is first used."""
    if name not in _HOMES:
        raise AttributeError(f"module 'world2minecraft' has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    """List the public names."""
    return sorted(__all__)
