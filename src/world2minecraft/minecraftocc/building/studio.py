"""A scene made ready: from a planned view to a sample, with the CPU time of each stage."""

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.minecraftocc.building.cpu_clock import StageClock
from world2minecraft.minecraftocc.building.recorded_views import recorded, screenshot
from world2minecraft.minecraftocc.building.scenes import (
    check_digest,
    poses_path,
    read_facts,
    source_of,
)
from world2minecraft.minecraftocc.camera_records import camera_record
from world2minecraft.minecraftocc.labels.labels import cast_depth, label_image
from world2minecraft.minecraftocc.labels.region import RegionRule, region_in
from world2minecraft.minecraftocc.labels.voxels import scene_voxels
from world2minecraft.minecraftocc.plan import Recipe, SceneSpec
from world2minecraft.minecraftocc.tours import PlannedView, read_views
from world2minecraft.minecraftocc.values import OccSample, SceneVoxels
from world2minecraft.rendering import BlockScene, LookLight, prepare_scene, render_volume
from world2minecraft.rendering.presentation.shot_frames import exposed
from world2minecraft.rendering.views import Shot

COLOUR = ("colour", "depth")


@dataclass(frozen=True, eq=False)
class Studio:
    """A scene with all that its samples are made of."""

    spec: SceneSpec
    recipe: Recipe
    scene: BlockScene  # with one exposure for all views
    voxels: SceneVoxels
    views: list[PlannedView]
    light: LookLight
    rule: RegionRule
    block_to_room: np.ndarray
    screenshots: tuple[Path, ...] = ()

    def key(self, number: int) -> str:
        """Return the key of a view's sample."""
        view = self.views[number]
        return f"{self.spec.scene_id}-{view.tour_id}-{view.frame:06d}"

    def sample(self, number: int, clock: StageClock) -> OccSample:
        """Take a view's picture and label it."""
        view, colour = self.views[number], None
        pose, camera = view.camera_to_room, view.camera
        with clock.of("render"):
            if self.recipe.pictures and self.screenshots:
                picture = render_volume(self.scene, camera, pose, outputs=("depth",))
                colour = screenshot(self.screenshots[number], camera)
                depth_m, seen_by = picture.depth_m, camera
            elif self.recipe.pictures:
                picture = render_volume(self.scene, camera, pose, outputs=COLOUR, light=self.light)
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
        """Return K and E as the paper prints them; they do not meet the image."""
        record = camera_record(
            view.camera, view.camera_to_room, self.block_to_room, paper_compat=True
        )
        return {"paper_compat": {name: record[name] for name in ("K", "E")}}


@lru_cache(maxsize=1)
def studio_of(folder: str, spec: SceneSpec, recipe: Recipe) -> Studio:
    """Make a scene ready; the last one is kept, for its next shard.

    Raises:
        ConflictError: the scene has changed since its views were planned.
    """
    root = Path(folder)
    facts = read_facts(root, spec.scene_id)
    source = source_of(root, spec, recipe)
    volume = source.volume()
    check_digest(facts, volume, spec)
    views = read_views(poses_path(root, spec.scene_id), volume.block_to_room)[: spec.images]
    light = LookLight(hour=facts.hour)
    plain = prepare_scene(volume)
    shots = [Shot(view.camera, view.camera_to_room) for view in views]
    scene = exposed(plain, light, shots) if recipe.pictures else plain
    rule = recipe.region
    if recipe.is_block_cells:
        rule = replace(rule, voxel_m=facts.metres_per_block)
    voxels = scene_voxels(
        volume,
        source.designs(),
        voxel_m=None if recipe.is_block_cells else rule.voxel_m,
        scene=plain,
    )
    shot_files: tuple[Path, ...] = ()
    if spec.given is not None and spec.given.is_screenshots:
        shot_files = tuple(one.image for one in recorded(spec.given))
    return Studio(spec, recipe, scene, voxels, views, light, rule, volume.block_to_room, shot_files)
