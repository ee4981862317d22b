"""Building into an existing world, and removal of such a build.

``build_into_world`` places a volume into a world: blocks, the contents of signs and chests, and
entities. Everything else in the chunks is kept. ``remove_build`` undoes the last build block by
block, in a world that has been played in since.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.core.errors import ConflictError, DamagedFileError, InputError, UsageError
from world2minecraft.core.types import BlockEdit, BlockEntity, Blocks, BlockVolume, Entity
from world2minecraft.editing.file_backups import (
    JOURNAL,
    Step,
    commit_step,
    discard_step,
    last_step,
    previous_data_packs,
    recover,
)
from world2minecraft.editing.journal import Journal
from world2minecraft.editing.volume_draft import block_entity_keys
from world2minecraft.editing.world_region import (
    WorldBox,
    WorldEntities,
    is_void,
    read_world_box,
    tag_entities,
)
from world2minecraft.minecraft.block_states import BlockState, parse_state
from world2minecraft.minecraft.entity_conversion import convert_block_entity, convert_entity
from world2minecraft.minecraft.versions import name_in_version
from world2minecraft.minecraft.worlds.session_lock import session_lock
from world2minecraft.minecraft.worlds.world_reader import read_level

AIR_CHOICES = ("room", "box", "none")
FIRST_DISPLAY_VERSION = 3337  # 1.19.4, the first game with display entities.


@dataclass(frozen=True)
class BuildOutcome:
    """The changes that a build or its removal made to a world.

    Attributes:
        step: The recorded step. None if the world already had the requested state.
        blocks: Number of blocks that changed.
        entities: Number of entities that were added or removed.
        kept: Number of blocks that were not restored because they have changed since the build.
        recovered: Number of interrupted steps that were undone first.
    """

    step: Step | None
    blocks: int
    entities: int
    kept: int = 0
    recovered: int = 0


def build_into_world(
    world: Path,
    volume: BlockVolume,
    *,
    air: str = "room",
    new_chunks: bool = False,
    extra: dict[str, bytes] | None = None,
    what: str = "a build",
) -> BuildOutcome:
    """Build a volume into a world at the position of its ``corner``.

    Building the same volume again changes nothing.

    Args:
        world: World folder. The world must not be open in the game.
        volume: Blocks to build. Their labels are not stored in the world.
        air: Which air of the volume replaces existing blocks: ``room`` (air above a block of the
            volume), ``box`` (all air) or ``none``.
        new_chunks: Create chunks that the game has not generated yet. Always done in a void world.
        extra: Contents of further files to write, by path in the world.
        what: Description of the step for the list of steps.

    Returns:
        The changes to the world.

    Raises:
        ConflictError: If the world is open in the game or lacks chunks at the position.
        InputError: If the folder is not a world.
        UsageError: If the build extends beyond the world limits.
        OutputError: If the disk is full.
    """
    with session_lock(world):
        recovered = len(recover(world))
        mask = affected_mask(volume, air)
        box = read_world_box(world, volume.corner, volume.states.shape)
        _check_chunks(box, new_chunks or is_void(read_level(world)))
        _check_entities(volume.entities, box)
        wanted = _numbers_of(volume, box)
        after = np.where(mask, wanted, box.states)
        come = [convert_block_entity(e, box.version_at(e.block_pos)) for e in volume.block_entities]
        data = _merged_data(box, come, mask)
        found = WorldEntities(world, box.low, box.states.shape, box.data_version)
        held = [convert_entity(e, box.data_version) for e in volume.entities]
        gone, arriving = found.built(), tag_entities(held)
        edit = _edit_of(box, after, data, gone, arriving)
        files = box.changed_files(after, data) | found.changed_files(gone, arriving)
        files |= extra or {}
        step = commit_step(world, files, what, edit)
    changed = 0 if edit is None or step is None else len(edit.cells)
    return BuildOutcome(step, changed, len(arriving) if step else 0, recovered=recovered)


def remove_build(world: Path) -> BuildOutcome:
    """Undo the last step block by block, keeping all later changes.

    A block is not restored if it is no longer the block that the step placed.

    Raises:
        UsageError: If there is no step to undo.
        ConflictError: If the world is open in the game.
        DamagedFileError: If the record of the step is damaged.
    """
    with session_lock(world):
        recovered = len(recover(world))
        last = last_step(world)
        edit = edit_of_step(last)
        low, high = edit.cells.min(axis=0), edit.cells.max(axis=0) + 1
        corner = (int(low[0]), int(low[1]), int(low[2]))
        box = read_world_box(world, corner, (high - low).tolist())
        at = tuple((edit.cells - low).T)
        now, wanted = _block_kinds(box.numbers.texts, edit.palette)
        same = now[box.states[at]] == wanted[edit.after.states]
        after = box.states.copy()
        numbers = np.array([box.numbers.number(s) for s in edit.palette], np.uint16)
        after[tuple(axis[same] for axis in at)] = numbers[edit.before.states[same]]
        back = np.zeros(after.shape, bool)
        back[tuple(axis[same] for axis in at)] = True
        data = [entity for entity in box.data if not back[_cell_of(entity, box)]]
        data += [e for e in edit.before.block_entities if back[_cell_of(e, box)]]
        found = WorldEntities(world, box.low, box.states.shape, box.data_version)
        gone, come = edit.after.entities, edit.before.entities
        files = box.changed_files(after, data) | found.changed_files(gone, come)
        files |= previous_data_packs(last)
        step = commit_step(world, files, "undone block by block")
        for old in (last, step):
            if old is not None:
                discard_step(old)
    return BuildOutcome(step, int(same.sum()), len(gone), int((~same).sum()), recovered)


def edit_of_step(step: Step) -> BlockEdit:
    """Return the blocks that a step changed.

    Raises:
        DamagedFileError: If the record is damaged.
        InputError: If the step has no record of its blocks.
    """
    path = step.folder / JOURNAL
    if not path.is_file():
        raise InputError(
            step.folder, "contains no record of the changed blocks; use w2m undo without --blocks"
        )
    edits = Journal(path).edits
    if len(edits) != 1 or not len(edits[0].cells):
        raise DamagedFileError(path, "must contain exactly one block edit")
    return edits[0]


def check_air(air: str) -> None:
    """Raise UsageError if ``air`` is not one of ``AIR_CHOICES``."""
    if air not in AIR_CHOICES:
        raise UsageError(f"air must be one of {', '.join(AIR_CHOICES)}, got {air!r}")


def affected_mask(volume: BlockVolume, air: str) -> np.ndarray:
    """Return a mask of the cells of a volume that replace blocks of a world, bool [X, Y, Z].

    Raises:
        UsageError: If ``air`` is not one of ``AIR_CHOICES``.
    """
    check_air(air)
    filled = np.asarray(volume.states > 0)
    if air == "box":
        return np.ones(filled.shape, bool)
    return filled if air == "none" else np.logical_or.accumulate(filled, axis=1)


def _check_chunks(box: WorldBox, may_make: bool) -> None:
    if box.missing and not may_make:
        x, z = (side * 16 for side in box.missing[0])
        count = f"{len(box.missing)} of the chunks, such as the one at x {x}, z {z}"
        advice = "visit the place in the game, or add --new-chunks to create them filled with air"
        raise ConflictError(box.world, f"the game has not generated {count}; {advice}")


def _check_entities(entities: Sequence[Entity], box: WorldBox) -> None:
    displays = any(entity.id.endswith("_display") for entity in entities)
    if displays and box.data_version < FIRST_DISPLAY_VERSION:
        reason = "is from a version before 1.19.4, which has no display entities"
        raise UsageError(f"{box.world} {reason}; build with the style blocks (--style blocks)")


def _numbers_of(volume: BlockVolume, box: WorldBox) -> np.ndarray:
    """Return the states of the volume as indices of the box, with names of the world's version."""
    numbers = np.zeros(len(volume.palette), np.uint16)
    for index, state in enumerate(volume.palette):
        parsed = parse_state(state)
        name = name_in_version(parsed.name, box.data_version)
        numbers[index] = box.numbers.number(str(BlockState(name, parsed.properties)))
    return numbers[volume.states]


def _merged_data(box: WorldBox, come: Sequence[BlockEntity], mask: np.ndarray) -> list[BlockEntity]:
    """Return the block entities of the box after the build."""

    def is_built(entity: BlockEntity) -> bool:
        return bool(mask[_cell_of(entity, box)])

    return [*[e for e in box.data if not is_built(e)], *[e for e in come if is_built(e)]]


def _edit_of(
    box: WorldBox,
    after: np.ndarray,
    data: Sequence[BlockEntity],
    gone: Sequence[Entity],
    come: Sequence[Entity],
) -> BlockEdit | None:
    """Return the change as a block edit of the cells that change or contain data."""
    moved = after != box.states
    changed = block_entity_keys(box.data) ^ block_entity_keys(data)
    old, new = ([e for e in held if block_entity_keys([e]) <= changed] for held in (box.data, data))
    for entity in (*old, *new):
        moved[_cell_of(entity, box)] = True
    cells = np.argwhere(moved)
    if not len(cells):
        return None
    at, world_cells = tuple(cells.T), (cells + box.low).astype(np.int32)
    used = np.unique(np.concatenate([box.states[at], after[at]]))
    numbers = np.zeros(len(box.numbers.texts), np.uint16)
    numbers[used] = np.arange(len(used))

    def blocks(states: np.ndarray, held: Sequence[BlockEntity], entities: Sequence[Entity]):
        zeros = np.zeros(len(cells), np.uint8)
        found = numbers[states[at]], zeros, zeros.astype(np.uint16)
        return Blocks(*found, tuple(held), tuple(entities))

    palette = tuple(box.numbers.texts[number] for number in used.tolist())
    before = [entity for entity in box.data if moved[_cell_of(entity, box)]]
    held = [entity for entity in data if moved[_cell_of(entity, box)]]
    return BlockEdit(
        "build",
        world_cells,
        palette,
        blocks(box.states, before, gone),
        blocks(after, held, come),
    )


def _cell_of(entity: BlockEntity, box: WorldBox) -> tuple[int, ...]:
    return tuple((np.array(entity.block_pos) - box.low).tolist())


def _block_kinds(*palettes: Sequence[str]) -> list[np.ndarray]:
    """Return a number for each state of each palette, equal for states of the same block."""
    numbers: dict[str, int] = {}
    return [
        np.array([numbers.setdefault(s.partition("[")[0], len(numbers)) for s in palette])
        for palette in palettes
    ]
