"""A set of many scenes: walked one after the other, then asked about, then written.

OUT/dataset.json      what it was made of, and how
OUT/items.jsonl       questions
OUT/trajectories.jsonl, OUT/episodes.jsonl
OUT/images/SCENE/TRAJECTORY/NNN.jpg
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from world2minecraft import __version__
from world2minecraft.dataset.source import scene_id_of
from world2minecraft.errors import UsageError
from world2minecraft.files import write_json
from world2minecraft.progress import Progress, silent
from world2minecraft.vln.data.asking import items_of
from world2minecraft.vln.data.leaks import Leaks, leaks_of
from world2minecraft.vln.data.quotas import COMPOSITIONS, cut
from world2minecraft.vln.data.scene_work import MADE_BY, SceneWork, WorkRule, work_scene
from world2minecraft.vln.data.splits import scene_splits
from world2minecraft.vln.records import (
    ABOUT,
    EPISODES,
    ITEMS,
    TRAJECTORIES,
    write_episodes,
    write_items,
    write_trajectories,
)
from world2minecraft.vln.scene import VlnScene, open_scene
from world2minecraft.vln.values import Item

PER_SCENE = {"base": 30, "extend": 110}  # Trajectories: what the paper's size asks for.
RECONSTRUCTED = ("room.npz", "placements.json")  # A run folder has them.


@dataclass(frozen=True)
class BuildRule:
    """How a set is made. ``trajectories`` of each scene; None takes ``PER_SCENE``."""

    composition: str = "combined"
    trajectories: int | None = None
    quotas: Mapping[tuple[str, str], int] | None = None
    work: WorkRule = field(default_factory=WorkRule)

    def __post_init__(self):
        if self.composition not in COMPOSITIONS:
            raise UsageError(f"a composition is base, extend or combined, not {self.composition!r}")
        if self.trajectories is not None and self.trajectories < 1:
            raise UsageError(f"--trajectories must be 1 or more, not {self.trajectories}")


@dataclass(frozen=True)
class Built:
    """What came of building."""

    items: list[Item]
    works: list[SceneWork]
    leaks: Leaks
    left_out: list[str]  # scenes that are not of the composition


def composition_of(path: str | Path) -> str:
    """Return base for a reconstruction's run folder, extend for every other world."""
    folder = Path(path)
    places = (folder, folder.parent, folder.parent.parent)
    found = any(all((place / name).is_file() for name in RECONSTRUCTED) for place in places)
    return "base" if found else "extend"


def build_set(
    paths: Sequence[str | Path],
    out: str | Path,
    rule: BuildRule | None = None,
    progress: Progress = silent,
    opened: Callable[[str | Path], VlnScene] = open_scene,
) -> Built:
    """Make a set of scenes.

    Args:
        paths: of the scenes, as ``open_scene`` takes them.
        out: the folder to write; the same words and seed give the same bytes.
        rule: what is made.
        progress: told of the scenes.
        opened: opens a scene.

    Raises:
        UsageError: no scene is of the composition, two have one name, or none gives a trajectory.
        InputError: a scene cannot be read. OutputError: the folder cannot be written.
    """
    how = rule or BuildRule()
    kinds = {str(path): composition_of(path) for path in paths}
    wanted = [path for path in kinds if how.composition in ("combined", kinds[path])]
    if not wanted:
        raise UsageError(f"none of the {len(kinds)} scenes is of composition {how.composition}")
    works, scene_of = [], _names(wanted)
    splits = scene_splits({scene_of[path]: kinds[path] for path in wanted}, how.work.seed)
    progress("scenes", 0, len(wanted))
    for number, path in enumerate(wanted):
        count = how.trajectories or PER_SCENE[kinds[path]]
        own = replace(how.work, trajectories=count)
        scene = opened(path)
        works.append(work_scene(scene, Path(out), kinds[path], splits[scene.scene_id], own))
        made = len(works[-1].trajectories)
        progress("scenes", number + 1, len(wanted), f"{scene.scene_id}: {made} trajectories")
    items = items_of(works, how.work.seed)
    items = cut(items, how.quotas) if how.quotas else items
    if not items:
        raise UsageError("no scene gave an item: they lack things to go to, or floor to walk on")
    _write(Path(out), how, works, items, splits, dict(zip(wanted, scene_of.values(), strict=True)))
    return Built(items, works, leaks_of(items), [path for path in kinds if path not in wanted])


def _names(paths: Sequence[str]) -> dict[str, str]:
    names = {path: scene_id_of(Path(path)) for path in paths}
    twice = [name for name in names.values() if list(names.values()).count(name) > 1]
    if twice:
        raise UsageError(
            f"two scenes are called {twice[0]!r}: folders must have names of their own"
        )
    return names


def _write(
    out: Path,
    how: BuildRule,
    works: Sequence[SceneWork],
    items: Sequence[Item],
    splits: Mapping[str, str],
    names: Mapping[str, str],
) -> None:
    write_items(out / ITEMS, items)
    write_trajectories(out / TRAJECTORIES, [one for work in works for one in work.trajectories])
    write_episodes(out / EPISODES, [one for work in works for one in work.episodes])
    about: dict[str, Any] = {
        "format": "minecraftvln-1",
        "version": __version__,
        "oracle_version": MADE_BY,
        "composition": how.composition,
        "rule": asdict(how.work),
        "scenes": [
            {
                "scene_id": work.scene_id,
                "path": next(path for path, name in names.items() if name == work.scene_id),
                "composition": work.composition,
                "split": splits[work.scene_id],
                "metres_per_block": work.metres_per_block,
                "tours": work.tours,
                "trajectories": len(work.trajectories),
                "refused": dict(sorted(work.refused.items())),
            }
            for work in works
        ],
        "items": len(items),
    }
    write_json(out / ABOUT, about)
