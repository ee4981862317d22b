"""Progress on stderr: plain lines into a file, bars on a terminal."""

import io

import pytest

from world2minecraft.cli import progress


class Terminal(io.StringIO):
    def isatty(self):
        return True


def ticking():
    """A clock that goes on by half a second each time it is read."""
    now = [0.0]

    def clock():
        now[0] += 0.5
        return now[0]

    return clock


def test_a_stage_is_two_lines():
    stream = io.StringIO()
    lines = progress.LineProgress(stream, clock=ticking())
    for done in range(41):
        lines("fuse", done, 40)
    assert stream.getvalue() == "fuse ...\nfuse done in 20.0 s\n"


def test_a_long_stage_prints_its_progress_and_time_left():
    stream, now = io.StringIO(), [0.0]
    lines = progress.LineProgress(stream, clock=lambda: now[0])
    for done in range(0, 2001, 100):
        lines("images", done, 2000, "9.1 a second")
        now[0] += 11
    told = stream.getvalue().splitlines()
    assert told[1] == "images 300 of 2,000, 9.1 a second, 3 min left"
    assert told[-2] == "images 1,800 of 2,000, 9.1 a second, 22 s left"
    assert told[-1] == "images done in 220.0 s (9.1 a second)"
    assert len(told) == 8


def test_a_stage_of_unknown_length_ends_with_the_next():
    stream = io.StringIO()
    lines = progress.LineProgress(stream, clock=ticking())
    lines("scan", 3, 0, "3 frames")
    lines("fuse", 0, 2)
    lines.finish()
    lines.finish()
    assert stream.getvalue() == (
        "scan ...\nscan done in 0.5 s (3 frames)\nfuse ...\nfuse done in 0.5 s\n"
    )


def test_a_stage_that_comes_again_is_shown_again():
    stream = io.StringIO()
    lines = progress.LineProgress(stream, clock=ticking())
    lines("fuse", 1, 1)
    lines("fuse", 1, 1)
    assert stream.getvalue().count("fuse ...") == 2


def test_shown_ends_the_last_stage():
    stream = io.StringIO()
    with progress.show_progress(stream) as report:
        report("scan", 0, 0)
    assert stream.getvalue().endswith(" s\n")


def test_a_stage_that_failed_is_not_called_done():
    stream = io.StringIO()
    with pytest.raises(KeyError), progress.show_progress(stream) as report:
        report("scan", 0, 9)
        raise KeyError
    assert stream.getvalue() == "scan ...\n"


def test_a_terminal_gets_a_bar_with_the_notes_as_they_are():
    stream = Terminal()
    with progress.show_progress(stream) as report:
        report("fuse", 0, 4)
        report("fuse", 4, 4, "frame[red].png")
        report("label", 1, 1)
    text = stream.getvalue()
    assert "fuse" in text
    assert "100%" in text
    assert "frame[red].png" in text
    assert "label" in text
