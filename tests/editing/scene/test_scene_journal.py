"""Operations as bytes: nothing is lost on the way, and nothing damaged comes back."""

from dataclasses import replace

import numpy as np
import pytest
from edit_scenes import SHAPE, random_cells, random_operation, small_draft, state
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError
from world2minecraft.core.types.edit import rows_are_unique
from world2minecraft.editing.scene.journal import (
    pack_objects,
    pack_operation,
    unpack_objects,
    unpack_operation,
)
from world2minecraft.minecraft.nbt import read_nbt, write_nbt

SEEDS = st.integers(0, 100_000)


def drawn(seed):
    draft = small_draft(seed % 7)
    return draft, random_operation(draft, np.random.default_rng(seed))


@given(SEEDS)
def test_what_is_read_does_what_was_written(seed):
    draft, operation = drawn(seed)
    packed = pack_operation(operation, SHAPE)
    again = unpack_operation(packed, SHAPE, "j")
    assert pack_operation(again, SHAPE) == packed
    told = ("kind", "counts_as", "class_id", "actor", "time_s")
    assert [getattr(again, name) for name in told] == [getattr(operation, name) for name in told]
    twin = small_draft(seed % 7)
    draft.apply(operation)
    twin.apply(again)
    assert state(draft) == state(twin)
    twin.apply(again.inverse())
    assert state(twin) == state(small_draft(seed % 7))


@given(SEEDS)
def test_bytes_do_not_depend_on_the_order_of_cells(seed):
    _, operation = drawn(seed)
    order = np.random.default_rng(seed).permutation(len(operation.cells))
    fields = ("labels", "confidence", "colour", "source", "instance")
    turned = {
        name: replace(value, **{field: getattr(value, field)[order] for field in fields})
        for name, value in (("before", operation.before), ("after", operation.after))
    }
    shuffled = replace(operation, cells=operation.cells[order], **turned)
    assert pack_operation(shuffled, SHAPE) == pack_operation(operation, SHAPE)


def test_cells_that_hold_the_same_take_no_room():
    draft = small_draft()
    cells = np.argwhere(np.ones(SHAPE, bool)).astype(np.int32)
    one = random_cells(np.random.default_rng(0), 1)
    fields = ("labels", "confidence", "colour", "source", "instance")
    after = type(one)(*(np.repeat(getattr(one, name), len(cells), axis=0) for name in fields))
    operation = draft.plan_operation("fill", cells, after)
    assert read_nbt(pack_operation(operation, SHAPE), "j")[1]["after"]["colour"].nbytes == 3


@given(SEEDS)
def test_objects_come_back_to_the_last_bit(seed):
    draft, operation = drawn(seed)
    draft.apply(operation)
    packed = pack_objects(draft.objects.values())
    assert pack_objects(unpack_objects(packed, "j")) == packed


@given(SEEDS, st.data())
def test_damage_is_refused_as_such(seed, data):
    _, operation = drawn(seed)
    packed = bytearray(pack_operation(operation, SHAPE))
    at = data.draw(st.integers(0, len(packed) - 1))
    packed[at] ^= data.draw(st.integers(1, 255))
    try:
        unpack_operation(bytes(packed[: data.draw(st.integers(0, len(packed)))]), SHAPE, "j")
    except InputError:
        return


def changed(**fields):
    _, operation = drawn(3)
    return write_nbt(read_nbt(pack_operation(operation, SHAPE), "j")[1] | fields)


@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        (
            {"runs": np.array([0, 211], np.int32)},
            "a run of cells extends beyond the grid of 210 cells",
        ),
        ({"runs": np.array([0, 5, 3, 4], np.int32)}, "two runs of cells overlap"),
        ({"runs": np.array([0, 1, 2], np.int32)}, "cannot reshape"),
        ({"runs": np.array([0, 9], np.int32)}, "labels must have "),
        ({"kind": "a/b"}, "kind must be a short printable name"),
        ({"counts_as": "much"}, "counts_as must be one of add, delete"),
        ({"before": {}}, "'labels'"),
        ({"objects_after": [{"id": 1}]}, "'class_id'"),
        ({"objects_after": "none"}, "string indices"),
    ],
)
def test_bytes_that_are_no_operation_are_refused(fields, reason):
    with pytest.raises(
        DamagedFileError, match="^j: does not contain a valid scene operation"
    ) as refused:
        unpack_operation(changed(**fields), SHAPE, "j")
    assert reason in str(refused.value)


def test_no_more_memory_is_taken_than_the_scene_has():
    # Two thousand million cells in one run: refused before anything is made of them.
    packed = changed(runs=np.array([0, 2_000_000_000], np.int32))
    with pytest.raises(DamagedFileError, match="extends beyond the grid"):
        unpack_operation(packed, SHAPE, "j")
    many = write_nbt({"objects": [{"id": 1}] * 10})
    with pytest.raises((DamagedFileError, LimitError)):
        unpack_objects(many, "j")


@given(
    st.lists(st.tuples(*[st.integers(-3, 3)] * 3), max_size=8),
    st.sampled_from([1, 1000, 700_000_000]),
)
def test_a_cell_that_is_named_twice_is_seen(places, far):
    cells = (np.array(places, np.int64).reshape(-1, 3) * far).astype(np.int32)
    assert rows_are_unique(cells) == (len(set(places)) == len(places))
    assert not rows_are_unique(np.repeat(cells, 2, axis=0)) or not places
