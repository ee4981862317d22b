"""Scene surveys: prepare the world of a scene, list its fine classes and plan its views.

The result is stored in ``scenes/ID.json``, and the views in ``scenes/ID.poses.jsonl`` as a tour
file. A resumed build reuses both files.
"""

import hashlib
import os
import shutil
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import MALFORMED, ConflictError, DamagedFileError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraftocc.building.process_registry import registered_task
from world2minecraft.minecraftocc.building.recorded_views import load_given_views
from world2minecraft.minecraftocc.labels.fine_classes import map_fine_classes
from world2minecraft.minecraftocc.object_table import object_rows
from world2minecraft.minecraftocc.plan import Recipe, SceneSpec
from world2minecraft.minecraftocc.scene_sources import SceneSource, open_scene_source
from world2minecraft.minecraftocc.store.folder import SCENES, objects_path
from world2minecraft.minecraftocc.tours import TourRule, find_layouts, plan_views, write_views
from world2minecraft.minecraftocc.types import FineClass
from world2minecraft.procgen.worlds import house_of, write_house
from world2minecraft.rendering import LightSettings, prepare_scene

DEFAULT_HOUR = 12.0


@dataclass(frozen=True)
class SceneTask:
    """A survey task: a scene, with the number of views to plan in ``spec.images``."""

    folder: str
    spec: SceneSpec
    recipe: Recipe


@dataclass(frozen=True)
class SceneFacts:
    """The result of a scene survey.

    Attributes:
        scene_id: Name of the scene.
        digest: SHA-256 of the blocks of the scene, used to detect changes.
        fine: Fine classes in the scene.
        plans: Requested and found numbers of views for each plan made so far.
        hour: Time of day from 0 to 24.
        blocks: Size of the scene in blocks [X, Y, Z].
        metres_per_block: Edge length of a block in metres.
        notes: Remarks for the user.
    """

    scene_id: str
    digest: str
    fine: tuple[FineClass, ...]
    plans: tuple[tuple[int, int], ...]
    hour: float
    blocks: tuple[int, int, int]
    metres_per_block: float
    notes: tuple[str, ...] = ()

    @property
    def views(self) -> int:
        """Number of views found by the latest plan."""
        return self.plans[-1][1]

    def found(self, requested: int) -> int | None:
        """Return the number of views found for a requested number, or None if never planned."""
        return dict(self.plans).get(requested)


@registered_task
def survey_scene(task: SceneTask, tick: Callable[[int], None]) -> tuple[SceneFacts, float]:
    """Survey a scene and plan its views, unless this has already been done.

    Returns:
        The result of the survey and the CPU seconds used.

    Raises:
        InputError: If the scene cannot be read.
        UsageError: If the scene has no place for a person to stand.
        ConflictError: If the scene has changed since it was first surveyed.
    """
    began = time.process_time()
    folder, spec = Path(task.folder), task.spec
    known = (
        read_facts(folder, spec.scene_id) if facts_path(folder, spec.scene_id).exists() else None
    )
    if known is None or known.found(spec.images) is None:
        known = _make_survey(folder, spec, task.recipe, known)
    tick(1)
    return known, time.process_time() - began


def facts_path(folder: Path, scene_id: str) -> Path:
    """Return the path of the survey result of a scene."""
    return folder / SCENES / f"{scene_id}.json"


def poses_path(folder: Path, scene_id: str) -> Path:
    """Return the path of the planned views of a scene."""
    return folder / SCENES / f"{scene_id}.poses.jsonl"


def read_facts(folder: Path, scene_id: str) -> SceneFacts:
    """Read the survey result of a scene.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file is not a valid survey result.
    """
    path = facts_path(folder, scene_id)
    raw = read_json(path)
    try:
        return SceneFacts(
            scene_id=str(raw["scene_id"]),
            digest=str(raw["digest"]),
            fine=tuple(FineClass(str(block), str(design)) for block, design in raw["fine"]),
            plans=tuple((int(requested), int(got)) for requested, got in raw["plans"]),
            hour=float(raw["hour"]),
            blocks=tuple(raw["blocks"]),
            metres_per_block=float(raw["metres_per_block"]),
            notes=tuple(raw["notes"]),
        )
    except MALFORMED as error:
        raise DamagedFileError(
            path, f"not a valid scene survey ({error!r}); delete the file and build again"
        ) from error


def open_source(folder: Path, spec: SceneSpec, recipe: Recipe) -> SceneSource:
    """Open the source of a scene's blocks."""
    place = folder / spec.path if spec.house else Path(spec.path)
    return open_scene_source(
        place,
        box=spec.box,
        blocks_per_metre=spec.blocks_per_metre,
        block_map=recipe.block_map,
        scene_id=spec.scene_id,
    )


def volume_digest(volume: BlockVolume) -> str:
    """Return the SHA-256 of all parts of a volume that its images and labels depend on."""
    total = hashlib.sha256()
    for part in (volume.states, volume.semantic, volume.instance, volume.block_to_room):
        total.update(repr(part.shape).encode() + np.ascontiguousarray(part).tobytes())
    rest = (volume.palette, volume.corner, volume.block_entities, volume.entities)
    total.update(repr(rest).encode())
    return total.hexdigest()


def check_digest(facts: SceneFacts, volume: BlockVolume, spec: SceneSpec) -> None:
    """Check that a scene has not changed since its views were planned.

    Raises:
        ConflictError: If the blocks of the scene have changed.
    """
    if volume_digest(volume) != facts.digest:
        raise ConflictError(
            spec.path,
            "has changed since the build of this data set was started; build a new data set",
        )


def _make_survey(
    folder: Path, spec: SceneSpec, recipe: Recipe, known: SceneFacts | None
) -> SceneFacts:
    if spec.house:
        generate_house_world(folder / spec.path, recipe.seed, spec.house)
    source = open_source(folder, spec, recipe)
    volume = source.volume()
    if known is not None:
        check_digest(known, volume, spec)
    hour = recipe.hour if recipe.hour is not None else _scene_hour(source.path)
    if spec.given is not None:
        views = load_given_views(spec.given, volume.block_to_room, recipe.camera)[: spec.images]
    else:
        rule = TourRule(
            camera=recipe.camera,
            light=LightSettings(hour=hour),
            layouts=find_layouts(source.path),
        )
        views = plan_views(volume, spec.images, recipe.seed, rule, scene=prepare_scene(volume))
    write_views(poses_path(folder, spec.scene_id), views, volume.block_to_room, spec.scene_id)
    east, up, south = volume.states.shape
    facts = SceneFacts(
        scene_id=spec.scene_id,
        digest=volume_digest(volume),
        fine=map_fine_classes(volume, source.designs()).classes,
        plans=(*(known.plans if known else ()), (spec.images, len(views))),
        hour=hour,
        blocks=(east, up, south),
        metres_per_block=1 / volume.blocks_per_metre,
        notes=tuple(source.notes()),
    )
    rows = object_rows(volume, source.designs(), source.names())
    write_json(objects_path(folder, spec.scene_id), rows)
    _write_facts(folder, facts)
    return facts


def generate_house_world(target: Path, seed: int, number: int) -> None:
    """Generate the world of a house and write it atomically, unless it exists."""
    if target.exists():
        return
    part = target.with_name(f".{target.name}.part")
    shutil.rmtree(part, ignore_errors=True)
    write_house(house_of(seed, number), part, name=target.name.replace("_", " "))
    os.replace(part, target)


def _scene_hour(path: Path) -> float:
    """Return the time of day stated by a scene, or noon by default."""
    for place in (path, path / "build", path.parent):
        if (place / "scene.json").is_file():
            scene = read_json(place / "scene.json")
            light = scene.get("light") if isinstance(scene, dict) else None
            hour = light.get("hour") if isinstance(light, dict) else None
            return float(hour) % 24 if isinstance(hour, (int, float)) else DEFAULT_HOUR
    return DEFAULT_HOUR


def _write_facts(folder: Path, facts: SceneFacts) -> None:
    write_json(
        facts_path(folder, facts.scene_id),
        {
            **facts.__dict__,
            "fine": [[one.block, one.design] for one in facts.fine],
        },
    )
