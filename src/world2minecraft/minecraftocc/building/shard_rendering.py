"""Rendering of one shard of a scene, the unit of work of a data set build.

``SampleRenderer`` turns planned views into samples and measures the CPU time of each stage. The
result depends only on the task, so any process can run it. Samples left in the shard by an
interrupted attempt are kept.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.minecraftocc.building.cpu_clock import StageClock
from world2minecraft.minecraftocc.building.process_registry import registered_task
from world2minecraft.minecraftocc.building.recorded_views import (
    load_screenshot,
    load_screenshot_views,
)
from world2minecraft.minecraftocc.building.scene_survey import (
    check_digest,
    open_source,
    poses_path,
    read_facts,
)
from world2minecraft.minecraftocc.camera_records import camera_record
from world2minecraft.minecraftocc.labels.camera_region import RegionRule, region_in
from world2minecraft.minecraftocc.labels.image_labels import cast_depth, label_image
from world2minecraft.minecraftocc.labels.voxelization import voxelize_scene
from world2minecraft.minecraftocc.plan import DatasetPlan, Recipe, SceneSpec
from world2minecraft.minecraftocc.store.folder import read_classes, shard_name
from world2minecraft.minecraftocc.store.sample_files import pack_sample
from world2minecraft.minecraftocc.store.shard import ShardWriter
from world2minecraft.minecraftocc.store.writer import SHARD_SAMPLES, ShardContents, read_shard
from world2minecraft.minecraftocc.tours import PlannedView, read_views
from world2minecraft.minecraftocc.types import OccSample, SceneVoxels
from world2minecraft.rendering import BlockScene, LightSettings, prepare_scene, render_volume
from world2minecraft.rendering.presentation.shot_rendering import with_common_exposure
from world2minecraft.rendering.views import Shot

OUTPUTS = ("colour", "depth")


@dataclass(frozen=True, eq=False)
class SampleRenderer:
    """A prepared scene from which samples can be rendered."""

    spec: SceneSpec
    recipe: Recipe
    scene: BlockScene  # with one exposure for all views
    voxels: SceneVoxels
    views: list[PlannedView]
    light: LightSettings
    rule: RegionRule
    block_to_room: np.ndarray
    screenshots: tuple[Path, ...] = ()

    def key(self, number: int) -> str:
        """Return the key of the sample for a view."""
        view = self.views[number]
        return f"{self.spec.scene_id}-{view.tour_id}-{view.frame:06d}"

    def sample(self, number: int, clock: StageClock) -> OccSample:
        """Render and label the image for a view."""
        view, colour = self.views[number], None
        pose, camera = view.camera_to_room, view.camera
        with clock.of("render"):
            if self.recipe.pictures and self.screenshots:
                picture = render_volume(self.scene, camera, pose, outputs=("depth",))
                colour = load_screenshot(self.screenshots[number], camera)
                depth_m, seen_by = picture.depth_m, camera
            elif self.recipe.pictures:
                picture = render_volume(self.scene, camera, pose, outputs=OUTPUTS, light=self.light)
                colour, depth_m, seen_by = picture.colour, picture.depth_m, camera
            else:
                seen_by, depth_m = cast_depth(self.scene, camera, pose)
        with clock.of("labels"):
            region = region_in(self.voxels, pose, self.rule)
            occ = label_image(self.voxels, region, seen_by, pose, depth_m)
        return OccSample(
            key=self.key(number),
            scene_id=self.spec.scene_id,
            tour_id=view.tour_id,
            frame=view.frame,
            camera=camera,
            camera_to_room=pose,
            occ=occ,
            fine_classes=self.voxels.fine_classes,
            colour=colour,
            depth_m=depth_m if self.recipe.pictures else None,
            split=self.spec.split,
            facts=self._facts(view),
        )

    def _facts(self, view: PlannedView) -> dict[str, Any]:
        pose = view.pose
        return {
            "block_to_room": self.block_to_room.tolist(),
            "game_pose": {
                "x": pose.x,
                "y": pose.y,
                "z": pose.z,
                "yaw": pose.yaw_deg,
                "pitch": pose.pitch_deg,
                "at": pose.at,
            },
            "t_s": view.t_s,
            **(self._as_printed(view) if self.recipe.paper_compat else {}),
            "hour": self.light.hour,
        }

    def _as_printed(self, view: PlannedView) -> dict[str, Any]:
        """Return K and E as printed in the paper, which do not match the image."""
        record = camera_record(
            view.camera, view.camera_to_room, self.block_to_room, paper_compat=True
        )
        return {"paper_compat": {name: record[name] for name in ("K", "E")}}


@lru_cache(maxsize=1)
def sample_renderer(folder: str, spec: SceneSpec, recipe: Recipe) -> SampleRenderer:
    """Prepare a scene for rendering. The most recent scene is cached for its next shard.

    Raises:
        ConflictError: If the scene has changed since its views were planned.
    """
    root = Path(folder)
    facts = read_facts(root, spec.scene_id)
    source = open_source(root, spec, recipe)
    volume = source.volume()
    check_digest(facts, volume, spec)
    views = read_views(poses_path(root, spec.scene_id), volume.block_to_room)[: spec.images]
    light = LightSettings(hour=facts.hour)
    plain = prepare_scene(volume)
    shots = [Shot(view.camera, view.camera_to_room) for view in views]
    scene = with_common_exposure(plain, light, shots) if recipe.pictures else plain
    rule = recipe.region
    if recipe.is_block_cells:
        rule = replace(rule, voxel_m=facts.metres_per_block)
    voxels = voxelize_scene(
        volume,
        source.designs(),
        voxel_m=None if recipe.is_block_cells else rule.voxel_m,
        scene=plain,
    )
    shot_files: tuple[Path, ...] = ()
    if spec.given is not None and spec.given.is_screenshots:
        shot_files = tuple(one.image for one in load_screenshot_views(spec.given))
    return SampleRenderer(
        spec, recipe, scene, voxels, views, light, rule, volume.block_to_room, shot_files
    )


@dataclass(frozen=True)
class ShardTask:
    """A shard to render: the views ``first`` (included) to ``last`` (excluded) of a scene."""

    folder: str
    name: str
    spec: SceneSpec
    recipe: Recipe
    first: int
    last: int


def shard_tasks(folder: Path, plan: DatasetPlan) -> list[ShardTask]:
    """Return the shard tasks for a plan, ordered by split, scene and view."""
    scenes = sorted(plan.scenes, key=lambda scene: list(plan.images).index(scene.split))
    return [
        ShardTask(
            str(folder),
            shard_name(scene.split, scene.scene_id, number),
            scene,
            plan.recipe,
            first,
            min(first + SHARD_SAMPLES, scene.images),
        )
        for scene in scenes
        for number, first in enumerate(range(0, scene.images, SHARD_SAMPLES))
    ]


@registered_task
def render_shard(unit: ShardTask, tick: Callable[[int], None]) -> tuple[int, dict[str, float]]:
    """Render a shard, or the samples that are missing from it.

    Returns:
        The number of samples rendered, and the CPU seconds by stage.

    Raises:
        OutputError: If the disk is full.
        ConflictError: If another process is writing the shard, or if the scene has changed.
        InputError: If the scene cannot be read.
    """
    path, clock, count = Path(unit.folder) / unit.name, StageClock(), unit.last - unit.first
    if path.exists():
        tick(count)
        return 0, {}
    with clock.of("scenes"):
        studio = sample_renderer(unit.folder, unit.spec, unit.recipe)
        table = read_classes(Path(unit.folder))
    numbers = range(unit.first, unit.last)
    with ShardWriter(path, [studio.key(number) for number in numbers]) as shard:
        found = shard.done
        tick(found)
        for number in numbers[found:]:
            sample = studio.sample(number, clock)
            with clock.of("encode"):
                members = pack_sample(sample, table, unit.recipe.files)
            with clock.of("write"):
                shard.append(members)
            tick(1)
        with clock.of("write"):
            shard.finish()
    return count - found, dict(clock.seconds)


def index_shard(unit: ShardTask, tick: Callable[[int], None]) -> tuple[ShardContents, float]:
    """Return the index rows and the checksum of a finished shard, and the CPU seconds used."""
    clock = StageClock()
    with clock.of("write"):
        contents = read_shard(Path(unit.folder), unit.name)
    tick(len(contents[0]))
    return contents, clock.seconds["write"]


def in_order(results: Iterator[tuple[int, Any]]) -> Iterator[Any]:
    """Reorder numbered results, which arrive in any order, and yield them by number."""
    waiting: dict[int, Any] = {}
    following = 0
    for number, result in results:
        waiting[number] = result
        while following in waiting:
            yield waiting.pop(following)
            following += 1
