"""Do, undo and redo of a scene: whatever is done can be taken back, to the last bit."""

import numpy as np
import pytest
from edit_scenes import random_operation, small_draft, state
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import ConflictError, OutputError, UsageError
from world2minecraft.editing.scene import MemoryLog, SceneHistory

SEEDS = st.integers(0, 10_000)


def done(count, seed=0):
    """A history of some operations, and the states before and after each."""
    rng, draft = np.random.default_rng(seed), small_draft(seed)
    history, states = SceneHistory(draft, MemoryLog()), [state(draft)]
    for _ in range(count):
        history.do(random_operation(draft, rng))
        states.append(state(draft))
    return history, states, rng


@given(SEEDS)
def test_undo_all_gives_the_first_scene_and_redo_all_the_last(seed):
    history, states, _ = done(5, seed)
    for wanted in reversed(states[:-1]):
        history.undo()
        assert state(history.draft) == wanted
    for wanted in states[1:]:
        history.redo()
        assert state(history.draft) == wanted


@given(SEEDS, st.lists(st.sampled_from(["do", "undo", "redo"]), max_size=20))
def test_any_walk_is_that_of_a_plain_list_of_states(seed, steps):
    rng, draft = np.random.default_rng(seed), small_draft(seed)
    history, line, at = SceneHistory(draft, MemoryLog()), [state(draft)], 0
    for step in steps:
        try:
            if step == "do":
                history.do(random_operation(draft, rng))
                line, at = [*line[: at + 1], state(draft)], at + 1
            elif step == "undo":
                history.undo()
                at -= 1
            else:
                history.redo()
                at += 1
        except UsageError:
            assert (step, at) in (("undo", 0), ("redo", len(line) - 1))
        assert state(draft) == line[at]
        assert history.line.done == at and len(history.line.numbers) == len(line) - 1


def test_what_was_undone_is_out_of_reach_after_an_edit():
    history, _, rng = done(3)
    history.undo()
    history.do(random_operation(history.draft, rng))
    assert history.line.numbers == (0, 1, 3)
    with pytest.raises(UsageError, match="^nothing to redo$"):
        history.redo()


def test_an_empty_history_has_nothing_to_undo():
    history, _, _ = done(0)
    assert (history.line.undo_kind, history.line.redo_kind) == ("", "")
    with pytest.raises(UsageError, match="^nothing to undo$"):
        history.undo()


def test_a_log_that_cannot_be_written_leaves_the_scene_as_it_is():
    class Full(MemoryLog):
        def do(self, *_):
            raise OutputError("j", "cannot be written: No space left on device")

        undo = redo = do

    history, states, rng = done(2)
    history.undo()
    history.log = full = Full()
    full.operations = done(2)[0].log.operations
    before, line = state(history.draft), history.line
    planned = random_operation(history.draft, rng)
    for step in (history.undo, history.redo, lambda: history.do(planned)):
        with pytest.raises(OutputError, match="No space left"):
            step()
        assert state(history.draft) == before and history.line == line
    assert before == states[1]


def test_an_operation_of_another_scene_is_refused_unlogged():
    history, _, rng = done(1)
    foreign = random_operation(small_draft(99), rng)
    with pytest.raises(ConflictError, match=r"^operation paint: .* has changed since$"):
        history.do(foreign)
    assert len(history.log.operations) == 1
