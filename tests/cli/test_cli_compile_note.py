"""The note on the first run: once, at the first step, and never beside an error."""

import pytest

from world2minecraft.cli import outcome


@pytest.mark.parametrize(("compiled", "lines"), [(True, 0), (False, 1)])
def test_the_note_is_printed_once_at_the_first_step(compiled, lines, monkeypatch, capsys):
    monkeypatch.setattr(outcome, "kernels_are_compiled", lambda: compiled)
    steps = []
    progress = outcome.with_compile_note(lambda *step: steps.append(step))
    assert capsys.readouterr().err == ""
    progress("fuse", 0, 2)
    progress("fuse", 2, 2)
    assert len(steps) == 2
    printed = capsys.readouterr()
    assert printed.out == "" and printed.err.count("First run: ") == lines
