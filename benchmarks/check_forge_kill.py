"""Crash safety of the editor: SIGKILL while a scene is edited, then recovery.

``python -m benchmarks.check_forge_kill [--kills 50]``

A process edits the demo room: it paints, undoes, redoes and sometimes saves, with a snapshot after
every fifth step, so that kills hit those too. It reports each acknowledged step and is killed at a
random moment. The scene must then open for editing, contain every acknowledged step and be, bit for
bit, the result of those steps on the first scene. The next process continues from there.
"""

import argparse
import os
import random
import select
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from world2minecraft.core.types import GridCells, Operation
from world2minecraft.editing.scene import SceneDraft
from world2minecraft.editing.scene.object_conversion import object_key
from world2minecraft.sceneforge.document import document as document_module
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.scene_sources import demo_room

MOST_S = 0.4  # From the first acknowledged step to the kill: tens of steps.


class Outcome(NamedTuple):
    """One kill: what was acknowledged before it, what was found after it, and if that is right."""

    acknowledged: int
    found: int
    is_right: bool
    notes: tuple[str, ...]


def edit(editor: Editor, number: int) -> None:
    """Do the edit of a number: the same one on the same scene."""
    turn = number % 11
    if turn == 7:
        editor.undo()
    elif turn == 8:
        editor.redo()
    else:
        editor.do(plan_operation(editor.draft, number))


def plan_operation(draft: SceneDraft, number: int) -> Operation:
    """Give a thousand cells other values, and turn or remove an object."""
    rng = np.random.default_rng(number)
    size = int(np.prod(draft.shape))
    flat = np.unique(rng.integers(0, size // 50, 40)[:, None] * 50 + np.arange(25))
    count = len(flat)
    labels = rng.choice([0, 2, 3, 5, 8, 255], count).astype(np.uint8)
    after = GridCells(
        labels,
        rng.random(count).astype(np.float16),
        rng.integers(0, 256, (count, 3), np.uint8),
        np.where(labels == 255, 0, 1).astype(np.uint8),
        rng.integers(0, 20, count).astype(np.uint16),
    )
    ids = sorted(draft.objects)
    chosen = draft.objects[ids[number % len(ids)]]
    turned = replace(chosen, yaw_deg=float(rng.random()) * 360)
    cells = np.column_stack(np.unravel_index(flat, draft.shape))
    gone = [ids[-1]] if number % 29 == 0 and len(ids) > 3 else []
    objects = [turned] if chosen.id not in gone else []
    return draft.plan_operation(
        "paint", cells, after, gone=gone, objects=objects, counts_as="other"
    )


def work(folder: Path, out: int) -> None:
    """Edit a scene on and on; each revision is told once it is acknowledged."""
    document_module.SNAPSHOT_STEPS = 5
    editor = Editor.open(None, out=folder)
    editor.document.history_bytes = 40_000
    while True:
        edit(editor, editor.rev)
        os.write(out, f"{editor.rev}\n".encode())
        if editor.rev % 13 == 0:
            editor.save()


def started(folder: Path) -> tuple[Callable[[], None], Callable[[], int], int]:
    """Start the work in a process of its own; return how to kill it, to await it, and its words."""
    code = (
        "import sys; from benchmarks.check_forge_kill import work, Path; work(Path(sys.argv[1]), 1)"
    )
    command = [sys.executable, "-c", code, str(folder)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, cwd=Path(__file__).parents[1])
    words = os.dup(process.stdout.fileno())
    return process.kill, process.wait, words


def forked(folder: Path) -> tuple[Callable[[], None], Callable[[], int], int]:
    """As ``started``, without the second that a new interpreter takes to begin."""
    words, told = os.pipe()
    number = os.fork()
    if number == 0:
        os.close(words)
        try:
            work(folder, told)
        finally:
            os._exit(1)
    os.close(told)
    return lambda: os.kill(number, signal.SIGKILL), lambda: os.waitpid(number, 0)[1], words


def killed(folder: Path, twin: Editor, seconds: float, start: Callable = started) -> Outcome:
    """Start the work, kill it, and look at what is left.

    Args:
        folder: where the scene is saved.
        twin: the same scene in memory; it is brought to what was found.
        seconds: from the first acknowledged step to the kill.
        start: ``started`` or ``forked``.
    """
    kill, wait, words = start(folder)
    try:
        if not select.select([words], [], [], 120)[0]:
            raise RuntimeError("the process did not begin to edit")
        time.sleep(seconds)
    finally:
        kill()
        wait()
    told = b""
    while part := os.read(words, 1 << 16):
        told += part
    os.close(words)
    acknowledged = int(told.rpartition(b"\n")[0].rpartition(b"\n")[2])
    again = Editor.open(None, out=folder)
    found, notes = again.rev, tuple(again.notes)
    while twin.rev < found:
        edit(twin, twin.rev)
    same = not again.read_only and held(again) == held(twin)
    again.close()
    return Outcome(acknowledged, found, same and acknowledged <= found <= acknowledged + 1, notes)


def held(editor: Editor) -> tuple:
    """Everything that a scene holds."""
    draft = editor.draft
    arrays = (draft.labels, draft.confidence, draft.colour, draft.source, draft.instance)
    objects = tuple(object_key(draft.objects[number]) for number in sorted(draft.objects))
    return (*(array.tobytes() for array in arrays), objects)


def main() -> int:
    """Kill as often as asked, print each outcome, and return 1 where one is wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    moments, wrong = random.Random(asked.seed), 0
    with tempfile.TemporaryDirectory() as scratch:
        twin = Editor(demo_room())
        for number in range(asked.kills):
            seconds = moments.uniform(0, MOST_S)
            one = killed(Path(scratch) / "room", twin, seconds)
            wrong += not one.is_right
            word = "right" if one.is_right else "WRONG"
            print(
                f"{number + 1:>3}  after {seconds:.3f} s  acknowledged {one.acknowledged:>5}  "
                f"found {one.found:>5}  {word}  {' '.join(one.notes)}",
                flush=True,
            )
    print(f"{asked.kills} kills, {wrong} wrong, {twin.rev} steps in all")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
