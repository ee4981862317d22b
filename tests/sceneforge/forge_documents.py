"""A small scene on the disk, edits of it, and all that it holds."""

from pathlib import Path

import numpy as np

from world2minecraft.core.types import OBSERVED, OccupancyGrid
from world2minecraft.editing.scene.object_conversion import object_key
from world2minecraft.formats.objects_and_placements import write_objects, write_placements
from world2minecraft.formats.run_arrays import write_room
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.scene_sources import detect_objects

SHAPE = (20, 18, 14)


class Clock:
    """A clock that a test moves."""

    def __init__(self, now=1000.0):
        self.now = now

    def __call__(self):
        return self.now


def room_grid() -> OccupancyGrid:
    """A floor, a wall, a table and a floater, with colours."""
    labels = np.zeros(SHAPE, np.uint8)
    labels[:, :, 0], labels[0] = 2, 3
    labels[6:14, 5:12, 9] = 8
    for x in (6, 13):
        for y in (5, 11):
            labels[x, y, 1:9] = 8
    labels[16, 14, 11] = 11
    colour = np.random.default_rng(1).integers(0, 256, (*SHAPE, 3)).astype(np.uint8)
    source = np.full(SHAPE, OBSERVED, np.uint8)
    confidence = np.where(labels > 0, 0.75, 1).astype(np.float16)
    instance = np.zeros(SHAPE, np.uint16)
    return OccupancyGrid(labels, confidence, colour, source, instance, 0.08, np.zeros(3))


def write_run(folder: Path) -> Path:
    """The files of a run, as reconstruct leaves them."""
    grid, objects = detect_objects(room_grid())
    from world2minecraft.editing.scene import instances_of, placements_of

    folder.mkdir(parents=True)
    write_room(folder / "room.npz", grid, np.diag([1.0, 1, 1, 1]))
    write_objects(folder / "objects.json", instances_of(objects, grid.instance))
    write_placements(folder / "placements.json", placements_of(objects))
    return folder


def edit(editor: Editor, number: int) -> None:
    """One of many edits, each another one: a step further, or now and then back."""
    if number % 7 == 5:
        editor.undo(actor="a")
    elif number % 7 == 6:
        editor.redo(actor="b")
    else:
        first = 1 + 3 * number % (SHAPE[0] * SHAPE[1] * SHAPE[2] - 4)
        class_id = (2, 3, 5, 8, 0)[number % 5]
        held = editor.draft.labels.ravel()[first : first + 3]
        wanted = 7 if (held == class_id).all() else class_id
        editor.do("set_cells", cells=[[first, 3]], class_id=wanted)


def held(editor: Editor) -> tuple:
    """Everything that a scene holds."""
    draft = editor.draft
    arrays = (draft.labels, draft.confidence, draft.colour, draft.source, draft.instance)
    objects = tuple(object_key(draft.objects[n]) for n in sorted(draft.objects))
    return (*(array.tobytes() for array in arrays), objects)


def same_files(folder: Path) -> dict[str, bytes]:
    """All files in a folder, but those of documents."""
    paths = [path for path in sorted(folder.rglob("*")) if path.is_file()]
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in paths
        if not any(part.endswith(".forge") for part in path.relative_to(folder).parts)
    }
