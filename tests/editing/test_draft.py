"""Edits of a volume: done and undone they are nothing, and they never destroy what they expect."""

import contextlib

import numpy as np
import pytest
from edit_volumes import random_edits, seen, small_volume
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import ConflictError, DamagedFileError, LimitError
from world2minecraft.core.types import AIR
from world2minecraft.editing.journal import pack_edit, unpack_edit
from world2minecraft.editing.volume_draft import Draft, apply_edits

seeds = st.integers(0, 10_000)


def slowly(start: dict, edits) -> dict:
    """The readable twin of ``apply_edits``: cell by cell, over plain values."""
    cells, data = dict(start["cells"]), dict(start["data"])
    entities = list(start["entities"])
    for edit in edits:
        after = edit.after
        for index, cell in enumerate(map(tuple, edit.cells.tolist())):
            state = edit.palette[after.states[index]]
            cells[cell] = (state, int(after.semantic[index]), int(after.instance[index]))
            data.pop(cell, None)
        data |= {e.block_pos: (e.id, str(e.nbt)) for e in after.block_entities}
        for gone in edit.before.entities:
            entities.remove((gone.position, gone.id, str(gone.nbt), gone.class_id))
        entities += [(e.position, e.id, str(e.nbt), e.class_id) for e in after.entities]
    return {"cells": cells, "data": data, "entities": sorted(entities)}


@given(seeds, st.integers(0, 8))
def test_edits_do_what_the_readable_twin_does(seed, count):
    volume = small_volume(seed)
    edits = random_edits(volume, count, seed)
    assert seen(apply_edits(volume, *edits)) == slowly(seen(volume), edits)


@given(seeds, st.integers(1, 8))
def test_edits_undone_in_reverse_are_nothing(seed, count):
    volume = small_volume(seed)
    edits = random_edits(volume, count, seed)
    back = [edit.inverse() for edit in reversed(edits)]
    again = apply_edits(volume, *edits, *back)
    assert seen(again) == seen(volume)
    assert again.palette == (AIR, *sorted({s for s in again.palette if s != AIR}))


@given(seeds)
def test_an_edit_survives_its_bytes(seed):
    edit = random_edits(small_volume(seed), 1, seed)[0]
    again = unpack_edit(pack_edit(edit), "j")
    assert pack_edit(again) == pack_edit(edit)
    assert seen(apply_edits(small_volume(seed), again)) == seen(
        apply_edits(small_volume(seed), edit)
    )


def test_data_go_with_their_block_and_come_back():
    volume = small_volume()
    draft = Draft(volume)
    edit = draft.fill("clear", np.array([[0, 0, 0]], np.int32), AIR)
    assert [e.block_pos for e in draft.volume().block_entities] == [(-1, 62, 7)]
    assert seen(apply_edits(draft.volume(), edit.inverse())) == seen(volume)


def test_an_edit_of_changed_blocks_is_refused_without_effect():
    volume = small_volume()
    first = random_edits(volume, 1, 3)[0]
    changed = apply_edits(volume, first)
    draft = Draft(changed)
    x, y, z = first.cells[0].tolist()
    with pytest.raises(ConflictError, match=rf"^edit paint: block \({x}, {y}, {z}\) is now "):
        draft.apply(first)
    assert seen(draft.volume()) == seen(changed)
    assert not draft.edits


def test_an_edit_beyond_the_volume_is_refused():
    edit = random_edits(small_volume(shape=(9, 9, 9)), 20, 1)
    with pytest.raises(ConflictError, match="is outside the volume$"):
        apply_edits(small_volume(), *edit)


def test_changed_text_of_a_sign_is_a_conflict():
    volume = small_volume()
    edit = Draft(volume).fill("clear", np.array([[1, 0, 0]], np.int32), AIR)
    other = small_volume()
    other.block_entities[1].nbt["Text1"] = "mine"
    with pytest.raises(ConflictError, match="a sign, a chest or an entity has changed since"):
        apply_edits(other, edit)


@pytest.mark.parametrize("cut", [1, 10, 60])
def test_half_an_edit_is_refused(cut):
    data = pack_edit(random_edits(small_volume(), 1, 3)[0])
    with pytest.raises(DamagedFileError):
        unpack_edit(data[:-cut], "j")


@given(st.integers(0, 400), st.integers(0, 255))
def test_a_changed_byte_is_an_edit_or_refused(place, byte):
    data = bytearray(pack_edit(random_edits(small_volume(), 1, 3)[0]))
    data[place % len(data)] = byte
    with contextlib.suppress(DamagedFileError, LimitError):
        unpack_edit(bytes(data), "j")
