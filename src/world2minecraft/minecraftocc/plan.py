"""The plan of a data set: its scenes with their splits and numbers of images.

The plan also contains all settings for images and labels. It determines every byte of the data set,
independent of the engine and the machine.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.labels.camera_region import RegionRule
from world2minecraft.minecraftocc.scene_sources import scene_id_of
from world2minecraft.minecraftocc.store.sample_files import SampleFiles
from world2minecraft.minecraftocc.tours import nyu_camera

TEST_SHARE = 0.2  # Of the images and the scenes, without a preset.
MAX_IMAGES, MAX_SCENES = 10_000_000, 100_000
MAX_SCENE_NAME = 46  # With number, tour and frame, a key then has at most 90 characters.


@dataclass(frozen=True)
class Preset:
    """A data set size from the paper.

    Attributes:
        train: Number of training images.
        test: Number of test images.
        houses: Number of houses to generate, enough for these images.
    """

    train: int
    test: int
    houses: int


PRESETS = {
    "8k": Preset(6_100, 2_024, 40),
    "50k": Preset(39_914, 10_245, 78),
    "100k": Preset(79_799, 20_366, 156),  # As many scenes as the paper has.
}


def plain_camera(camera: Camera) -> dict[str, Any]:
    """Return the size and intrinsics of a camera without distortion as a dict for JSON."""
    return {name: one for name, one in asdict(camera).items() if name != "distortion"}


@dataclass(frozen=True)
class Recipe:
    """The settings for rendering, labelling and storing the images of a data set.

    Attributes:
        camera: Camera of the images.
        region: Rule for the region of each image.
        is_block_cells: Whether to use one cell per block, overriding the cell size of ``region``.
        files: File formats of a sample.
        pictures: Whether to render images and depth maps. False writes only labels and masks.
        block_map: Name or file of the block map.
        hour: Time of day from 0 to 24. None uses that of each scene.
        paper_compat: Whether to store also the matrices K and E as printed in the paper.
        seed: Random seed.
    """

    camera: Camera = field(default_factory=nyu_camera)
    region: RegionRule = field(default_factory=RegionRule)
    is_block_cells: bool = False
    files: SampleFiles = field(default_factory=SampleFiles)
    pictures: bool = True
    block_map: str = "nyu"
    hour: float | None = None
    paper_compat: bool = False
    seed: int = 0

    def facts(self) -> dict[str, Any]:
        """Return all settings as a dict for JSON."""
        return {**asdict(self), "camera": plain_camera(self.camera)}


@dataclass(frozen=True)
class GivenViews:
    """Recorded views to use instead of planned ones: a tour file, or a folder of screenshots.

    Attributes:
        path: Tour file or folder of screenshots.
        is_screenshots: Whether ``path`` is a folder of screenshots.
        at: Reference point of the screenshot positions, ``feet`` or ``eye``; see
            ``minecraftocc.screenshots``.
        pattern: Pattern of the screenshot file names.
        vertical_fov_deg: Vertical field of view of screenshots that do not record their own, in
            degrees.
    """

    path: str
    is_screenshots: bool = False
    at: Literal["feet", "eye"] = "feet"
    pattern: str | None = None
    vertical_fov_deg: float = 70.0


@dataclass(frozen=True)
class SceneSpec:
    """A scene of a data set.

    Attributes:
        scene_id: Unique name of the scene.
        path: World, run folder or schematic of the scene.
        house: Number of the generated house, or 0 for an existing world.
        split: ``train`` or ``test``.
        images: Number of images.
        blocks_per_metre: Scale for worlds that do not record their own.
        box: Part of the world to use, as x0 y0 z0 x1 y1 z1 in blocks.
        given: Recorded views. None plans views automatically.
    """

    scene_id: str
    path: str
    house: int = 0
    split: str = "train"
    images: int = 0
    blocks_per_metre: float | None = None
    box: tuple[int, ...] | None = None
    given: GivenViews | None = None


@dataclass(frozen=True)
class DatasetPlan:
    """All settings that define a data set.

    Attributes:
        scenes: Scenes with their splits and numbers of images.
        recipe: Settings for images and labels.
        preset: Name of the preset that was used, if any.
    """

    scenes: tuple[SceneSpec, ...]
    recipe: Recipe = field(default_factory=Recipe)
    preset: str = ""

    @property
    def images(self) -> dict[str, int]:
        """Number of images in each split."""
        splits = sorted({scene.split for scene in self.scenes}, reverse=True)
        return {
            split: sum(scene.images for scene in self.scenes if scene.split == split)
            for split in splits
        }

    def facts(self) -> dict[str, Any]:
        """Return the plan as stored in ``dataset.json`` and compared when a build is resumed."""
        return {
            "preset": self.preset,
            "recipe": self.recipe.facts(),
            "scenes": [asdict(scene) for scene in self.scenes],
        }


def house_scenes(houses: int) -> list[SceneSpec]:
    """Return scenes for generated houses, without splits and numbers of images."""
    return [
        SceneSpec(f"house_{number:04d}", f"worlds/house_{number:04d}", number)
        for number in range(1, houses + 1)
    ]


def preset_named(name: str) -> Preset:
    """Return the preset with this name.

    Raises:
        UnknownNameError: If there is no such preset.
    """
    if name not in PRESETS:
        raise UnknownNameError("preset", name, PRESETS)
    return PRESETS[name]


def plan_dataset(
    scenes: Sequence[SceneSpec],
    images: int | None = None,
    *,
    preset: str = "",
    recipe: Recipe | None = None,
    test_share: float = TEST_SHARE,
) -> DatasetPlan:
    """Plan a data set: split the scenes randomly and distribute the images evenly among them.

    The split of a scene depends on the seed and on its name, so adding a scene changes few others.

    Args:
        scenes: Scenes with unique names.
        images: Total number of images. Required without a preset.
        preset: Name of a preset in ``PRESETS``, or an empty string.
        recipe: Settings for images and labels. Its seed also determines the split.
        test_share: Fraction of the images to use for testing, without a preset. At least one scene
            is used for training.

    Raises:
        UsageError: If the arguments contradict each other.
        UnknownNameError: If there is no such preset.
    """
    how = recipe or Recipe()
    _check(scenes, images, preset, test_share)
    if preset:
        wanted = preset_named(preset)
        train, test = wanted.train, wanted.test
    else:
        total = images or 0
        tests = _test_scenes(len(scenes), test_share)
        test = round(total * test_share)
        # At least one image per test scene, and at least one for training.
        test = min(max(test, tests), total - 1) if tests else 0
        train = total - test
    count = _test_scenes(len(scenes), test / (train + test))
    order = sorted(scenes, key=lambda scene: _chance(how.seed, scene.scene_id))
    names = {scene.scene_id for scene in order[:count]}
    shares = {
        **_share_evenly([scene.scene_id for scene in scenes if scene.scene_id in names], test),
        **_share_evenly([scene.scene_id for scene in scenes if scene.scene_id not in names], train),
    }
    placed = [
        replace(
            scene,
            split="test" if scene.scene_id in names else "train",
            images=shares[scene.scene_id],
        )
        for scene in scenes
    ]
    return DatasetPlan(tuple(placed), how, preset)


def source_scenes(paths: Sequence[Path]) -> list[SceneSpec]:
    """Return scenes for worlds and schematics, with unique names.

    Raises:
        UsageError: If a path is given twice.
    """
    found: dict[str, SceneSpec] = {}
    known: set[Path] = set()
    for path in paths:
        if path.resolve() in known:
            raise UsageError(f"{path} is listed twice; list each world only once")
        known.add(path.resolve())
        name = base = scene_id_of(path)[:MAX_SCENE_NAME]
        number = 2
        while name in found:
            name, number = f"{base}_{number}", number + 1
        found[name] = SceneSpec(name, str(path))
    return list(found.values())


def _check(scenes: Sequence[SceneSpec], images: int | None, preset: str, test_share: float) -> None:
    if not scenes:
        raise UsageError("no scenes; add houses or worlds (--houses, --worlds, --world or --schem)")
    if len(scenes) > MAX_SCENES:
        raise UsageError(f"a data set may have at most {MAX_SCENES:,} scenes, got {len(scenes):,}")
    if preset:
        if images is not None:
            raise UsageError(f"preset {preset} sets the number of images; omit images (--images)")
        if len(scenes) < 2:
            raise UsageError(f"preset {preset} needs at least two scenes, one for each split")
    elif images is None or not len(scenes) <= images <= MAX_IMAGES:
        given = "none" if images is None else f"{images:,}"
        raise UsageError(
            f"images must be from {len(scenes):,} (one per scene) to {MAX_IMAGES:,}, got {given}"
        )
    if not 0 <= test_share < 1:
        raise UsageError(f"the test share must be at least 0 and below 1, got {test_share:g}")


def _test_scenes(scenes: int, share: float) -> int:
    """Return the number of test scenes: at least one, and at least one less than all scenes."""
    return min(max(round(scenes * share), 1 if share else 0), scenes - 1)


def _chance(seed: int, name: str) -> bytes:
    return hashlib.sha256(f"{seed}:{name}".encode()).digest()


def _share_evenly(names: list[str], images: int) -> dict[str, int]:
    """Distribute images evenly among scenes. The first scenes get the remainder."""
    if not names:
        return {}
    each, more = divmod(images, len(names))
    return {name: each + (number < more) for number, name in enumerate(names)}
