"""The plan of a data set: its scenes with their split and their share of the images.

The plan also says how each picture is taken; it alone decides every byte, whoever carries it out.
"""

import hashlib
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.labels.camera_region import RegionRule
from world2minecraft.minecraftocc.scene_sources import scene_id_of
from world2minecraft.minecraftocc.store.sample_files import SampleFiles
from world2minecraft.minecraftocc.tours import nyu_camera

TEST_SHARE = 0.2  # Of images and of scenes, where there is no preset.
MAX_IMAGES, MAX_SCENES = 10_000_000, 100_000
# Of a scene: with a number, a tour and a frame its keys have 90 letters at most.
MAX_SCENE_NAME = 46


@dataclass(frozen=True)
class Preset:
    """A size of the paper: images of either split, and how many houses give enough views."""

    train: int
    test: int
    houses: int


PRESETS = {
    "8k": Preset(6_100, 2_024, 40),
    "50k": Preset(39_914, 10_245, 78),
    "100k": Preset(79_799, 20_366, 156),  # As many scenes as the paper has.
}


@dataclass(frozen=True)
class Recipe:
    """How every picture of a data set is taken, labelled and packed."""

    camera: Camera = field(default_factory=nyu_camera)
    region: RegionRule = field(default_factory=RegionRule)
    is_block_cells: bool = False  # Cells are the scene's blocks, whatever the region's rule says.
    files: SampleFiles = field(default_factory=SampleFiles)
    pictures: bool = True  # False: labels and masks alone.
    block_map: str = "nyu"
    hour: float | None = None  # The scene's own where None.
    paper_compat: bool = False  # K and E as the paper prints them stand beside the right ones.
    seed: int = 0

    def facts(self) -> dict[str, Any]:
        """Return all of it as JSON."""
        data = asdict(self)
        data["camera"] = {k: v for k, v in data["camera"].items() if k != "distortion"}
        return data


@dataclass(frozen=True)
class GivenViews:
    """Views that somebody has recorded: a tour file, or a folder of screenshots with their poses.

    ``at`` says whether screenshots tell the feet or the eye; see ``minecraftocc.screenshots``.
    """

    path: str
    is_screenshots: bool = False
    at: Literal["feet", "eye"] = "feet"
    pattern: str | None = None
    vertical_fov_deg: float = 70.0


@dataclass(frozen=True)
class SceneSpec:
    """A scene of a data set. ``house`` is the number of a house that is generated, else 0."""

    scene_id: str
    path: str
    house: int = 0
    split: str = "train"
    images: int = 0
    blocks_per_metre: float | None = None
    box: tuple[int, ...] | None = None
    given: GivenViews | None = None  # Views are planned where None.


@dataclass(frozen=True)
class DatasetPlan:
    """All that a data set is made of."""

    scenes: tuple[SceneSpec, ...]
    recipe: Recipe = field(default_factory=Recipe)
    preset: str = ""

    @property
    def images(self) -> dict[str, int]:
        """How many images each split has."""
        splits = sorted({scene.split for scene in self.scenes}, reverse=True)
        return {
            split: sum(scene.images for scene in self.scenes if scene.split == split)
            for split in splits
        }

    def facts(self) -> dict[str, Any]:
        """Return what ``dataset.json`` tells of the plan, and a later run compares."""
        return {
            "preset": self.preset,
            "recipe": self.recipe.facts(),
            "scenes": [asdict(scene) for scene in self.scenes],
        }


def house_scenes(houses: int) -> list[SceneSpec]:
    """Return the specs of generated houses, without split and images."""
    return [
        SceneSpec(f"house_{number:04d}", f"worlds/house_{number:04d}", number)
        for number in range(1, houses + 1)
    ]


def preset_named(name: str) -> Preset:
    """Return a preset. Raises UnknownNameError."""
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
    """Return a plan: scenes are split by chance of the seed, images shared evenly among them.

    A scene's place in that chance depends on its name alone, so another scene more changes little.

    Args:
        scenes: with names that differ.
        images: how many in all, where there is no preset.
        preset: one of ``PRESETS``, or none.
        recipe: how pictures are taken; its seed splits too.
        test_share: of the images, without a preset; at least one scene is for training.

    Raises:
        UsageError: the numbers do not go together. UnknownNameError: there is no such preset.
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
        # As many as scenes of either kind: at least one image is for training.
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
        _with_images(scene, "test" if scene.scene_id in names else "train", shares[scene.scene_id])
        for scene in scenes
    ]
    return DatasetPlan(tuple(placed), how, preset)


def source_scenes(paths: Sequence[Path]) -> list[SceneSpec]:
    """Return the specs of worlds and schematics, each with a name of its own.

    Raises:
        UsageError: a place is given twice; it would be trained on and tested on.
    """
    found: dict[str, SceneSpec] = {}
    known: set[Path] = set()
    for path in paths:
        if path.resolve() in known:
            raise UsageError(f"{path} is given twice; give each world once")
        known.add(path.resolve())
        name = base = scene_id_of(path)[:MAX_SCENE_NAME]
        number = 2
        while name in found:
            name, number = f"{base}_{number}", number + 1
        found[name] = SceneSpec(name, str(path))
    return list(found.values())


def _check(scenes: Sequence[SceneSpec], images: int | None, preset: str, test_share: float) -> None:
    if not scenes:
        raise UsageError("a data set needs a scene: give --houses, --worlds, --world or --schem")
    if len(scenes) > MAX_SCENES:
        raise UsageError(f"at most {MAX_SCENES:,} scenes are taken, not {len(scenes):,}")
    if preset:
        if images is not None:
            raise UsageError(f"--preset {preset} says how many images; leave out --images")
        if len(scenes) < 2:
            raise UsageError(f"--preset {preset} is split by scene: give it two scenes or more")
    elif images is None or not len(scenes) <= images <= MAX_IMAGES:
        given = "no number" if images is None else f"{images:,}"
        raise UsageError(
            f"--images is one for each of {len(scenes)} scenes or more, up to {MAX_IMAGES:,}, "
            f"not {given}"
        )
    if not 0 <= test_share < 1:
        raise UsageError(f"--test-share is 0 or more and below 1, not {test_share:g}")


def _test_scenes(scenes: int, share: float) -> int:
    """Return how many scenes are for testing: one at least, and one at least is not."""
    return min(max(round(scenes * share), 1 if share else 0), scenes - 1)


def _chance(seed: int, name: str) -> bytes:
    return hashlib.sha256(f"{seed}:{name}".encode()).digest()


def _share_evenly(names: list[str], images: int) -> dict[str, int]:
    """Share images evenly; the first scenes get one more where they do not come out even."""
    if not names:
        return {}
    each, more = divmod(images, len(names))
    return {name: each + (number < more) for number, name in enumerate(names)}


def _with_images(scene: SceneSpec, split: str, images: int) -> SceneSpec:
    facts = {**scene.__dict__, "split": split, "images": images}
    return SceneSpec(**facts)
