"""Progress on stderr: plain lines into a file, bars on a terminal."""

import io

import pytest

from world2minecraft.api import progress, time_left


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
    text = "Fusing depth into voxels"
    assert stream.getvalue() == f"{text} ...\n{text}: done in 20.5 s\n"


def test_a_long_stage_prints_its_progress_and_time_left():
    stream, now = io.StringIO(), [0.0]
    lines = progress.LineProgress(stream, clock=lambda: now[0])
    for done in range(0, 2001, 100):
        lines("images", done, 2000, "9.1 a second")
        now[0] += 11
    told = stream.getvalue().splitlines()
    assert told[1] == "Rendering images: 300 of 2,000, 9.1 a second, 3 min left"
    assert told[-2] == "Rendering images: 1,800 of 2,000, 9.1 a second, 22 s left"
    assert told[-1] == "Rendering images: done in 220.0 s (9.1 a second)"
    assert len(told) == 8


def test_a_stage_of_unknown_length_ends_with_the_next():
    stream = io.StringIO()
    lines = progress.LineProgress(stream, clock=ticking())
    lines("mesh", 3, 0, "3 parts")
    lines("write", 0, 2)
    lines.finish()
    lines.finish()
    assert stream.getvalue() == (
        "Reading the mesh ...\nReading the mesh: done in 1.0 s (3 parts)\n"
        "Writing files ...\nWriting files: done in 1.0 s\n"
    )


def test_a_stage_that_comes_again_is_shown_again():
    stream = io.StringIO()
    lines = progress.LineProgress(stream, clock=ticking())
    lines("fuse", 1, 1)
    lines("fuse", 1, 1)
    assert stream.getvalue().count("voxels ...") == 2


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
    assert stream.getvalue() == "Reading the capture ...\n"


def test_a_terminal_gets_a_bar_with_the_notes_as_they_are():
    stream = Terminal()
    with progress.show_progress(stream) as report:
        report("fuse", 0, 4)
        report("fuse", 4, 4, "frame[red].png")
        report("label", 1, 1)
    text = stream.getvalue()
    assert "Fusing depth into voxels" in text
    assert "100%" in text
    assert "frame[red].png" in text
    assert "Labelling voxels" in text
    assert progress.WHOLE_RUN not in text


def test_a_terminal_shows_one_bar_for_the_whole_run():
    stream = Terminal()
    with progress.show_progress(stream) as report:
        report("scan", 4, 4)
        report("fuse", 0, 4)
    lines = [line for line in stream.getvalue().splitlines() if progress.WHOLE_RUN in line]
    assert lines
    assert "100%" in lines[-1]


def test_lines_state_the_time_left_after_the_first_stage():
    stream, now = io.StringIO(), [0.0]
    lines = progress.LineProgress(stream, lambda: now[0], progress.WholeRun(until="register"))
    lines("scan", 0, 1)
    now[0] = 8.0
    lines("scan", 1, 1)
    lines("register", 0, 40)
    printed = stream.getvalue().splitlines()
    assert printed[0] == "Reading the capture ..."
    assert printed[-1] == "Refining camera poses ... (about 4 s left in total)"


def test_stages_without_a_known_run_state_no_time_left():
    whole = progress.WholeRun()
    whole.report("render", 1, 2, 0.0)
    whole.report("write", 0, 2, 9.0)
    assert whole.text(9.0) == ""


def test_every_stage_of_a_whole_run_has_a_text():
    assert set(time_left.COSTS) <= set(progress.STAGE_TEXTS)
