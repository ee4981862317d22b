"""Edits of a scene (occupancy and objects), shared by SceneForge, scripts and models."""

from world2minecraft.editing.scene.cell_patch import cells_of_runs, runs_of_cells
from world2minecraft.editing.scene.command import Command, Tools
from world2minecraft.editing.scene.command_registry import COMMANDS, parse_command
from world2minecraft.editing.scene.history import MemoryLog, SceneHistory, Timeline
from world2minecraft.editing.scene.object_conversion import instances_of, objects_of, placements_of
from world2minecraft.editing.scene.scene_draft import SceneDraft

__all__ = [
    "COMMANDS",
    "Command",
    "MemoryLog",
    "SceneDraft",
    "SceneHistory",
    "Timeline",
    "Tools",
    "cells_of_runs",
    "instances_of",
    "objects_of",
    "parse_command",
    "placements_of",
    "runs_of_cells",
]
