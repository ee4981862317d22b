"""``w2m`` itself: help, usage, exit codes, and one line for whatever goes wrong."""

import errno
import re
import subprocess
import sys
from typing import Annotated

import pytest
import typer

from world2minecraft import __version__, cli
from world2minecraft.cli import failures, panels, verbs
from world2minecraft.core.errors import CaptureError, UsageError


@pytest.fixture
def verb(monkeypatch):
    """Put a verb ``probe`` in the table whose run is a function of the test's choice."""

    def put(function):
        module = type(sys)("world2minecraft.cli.probe")
        module.run, module.EXAMPLES = function, "w2m probe      an example\n"
        monkeypatch.setitem(sys.modules, "world2minecraft.cli.probe", module)
        monkeypatch.setitem(verbs.VERBS, "probe", "Probe the skeleton.")

    return put


def failing(error):
    def run() -> None:
        """Fail."""
        raise error

    return run


def test_help_lists_every_verb_under_its_heading(capsys):
    assert cli.run(["--help"]) == 0
    text = capsys.readouterr().out
    for heading, summaries in verbs.VERB_GROUPS.items():
        section = " ".join(text.partition(f"\n{heading}:\n")[2].partition("\n\n")[0].split())
        for name, summary in summaries.items():
            assert f"{name.split()[-1]} {summary}" in section


def test_help_indents_the_verbs_of_a_family(capsys):
    assert cli.run(["--help"]) == 0
    lines = capsys.readouterr().out.splitlines()
    row = next(i for i, line in enumerate(lines) if line.startswith("  rooms generate  "))
    assert lines[row + 1].startswith("        scan      ")


def test_each_verb_stands_in_one_group():
    names = [name for summaries in verbs.VERB_GROUPS.values() for name in summaries]
    assert len(names) == len(set(names)) == len(verbs.VERBS)
    families = {first for first, _, second in (name.partition(" ") for name in names) if second}
    assert set(verbs.FAMILIES) == families - set(names)


@pytest.mark.parametrize("name", verbs.VERBS)
def test_the_first_part_of_each_help_fits_a_screen(name):
    command = verbs.load(name)
    context = command.make_context(f"w2m {name}", [], resilient_parsing=True, terminal_width=80)
    first = command.get_help(context).partition(f"\n{panels.MORE}:\n")[0].splitlines()
    rows = [max(1, -(-len(line) // 80)) for line in first]  # As a terminal wraps them.
    assert sum(rows) <= panels.FIRST_LINES


@pytest.mark.parametrize("name", verbs.VERBS)
def test_descriptions_of_examples_fit_the_width(name):
    for width in (80, 120):
        for line in verbs.load(name).examples.strip().splitlines():
            shown = verbs.fit_example(f"  {line}", width)
            assert shown.split() == line.split()
            assert len(shown.splitlines()[-1]) <= width or not verbs.EXAMPLE.fullmatch(shown)


@pytest.mark.parametrize("name", verbs.FAMILIES)
def test_a_family_without_a_verb_shows_its_help(name, capsys):
    assert cli.run([name]) == 0
    assert verbs.FAMILIES[name] in capsys.readouterr().out


def test_no_words_at_all_ask_for_help(capsys):
    assert cli.run([]) == 0
    assert capsys.readouterr().out.startswith("Usage: w2m")


def test_version(capsys):
    assert cli.run(["--version"]) == 0
    assert capsys.readouterr().out == f"w2m {__version__}\n"


@pytest.mark.parametrize("name", verbs.VERBS)
def test_each_verb_has_a_help_with_examples(name, capsys):
    assert cli.run([*name.split(), "--help"]) == 0
    text = capsys.readouterr().out
    assert text.startswith(f"Usage: w2m {name}")
    assert f"  w2m {name}" in text.partition("Examples:")[2]
    assert "Args:" not in text


@pytest.fixture
def verb_of_two_words(monkeypatch):
    """Put a verb ``pro be`` in the table that counts to a number."""
    module = type(sys)("world2minecraft.cli.pro.be")

    def run(number: int) -> int:
        """Be a probe."""
        return number

    module.run, module.EXAMPLES = run, "w2m pro be 5      an example\n"
    monkeypatch.setitem(sys.modules, "world2minecraft.cli.pro.be", module)
    monkeypatch.setitem(verbs.VERBS, "pro be", "Probe two words.")


def test_a_verb_of_two_words_is_called_and_helped(verb_of_two_words, capsys):
    assert cli.run(["pro", "be", "5"]) == 5
    assert cli.run(["pro", "be", "--help"]) == 0
    assert capsys.readouterr().out.startswith("Usage: w2m pro be")


def test_the_first_of_two_words_shows_its_verbs(verb_of_two_words, capsys):
    assert cli.run(["pro", "--help"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("Usage: w2m pro")
    assert "be  Probe two words." in text
    assert "reconstruct" not in text


def test_a_wrong_second_word_names_the_right_verb(verb_of_two_words, capsys):
    assert cli.run(["pro", "bee"]) == 2
    line = "error: no verb is named 'pro bee'; did you mean 'pro be'?\n"
    assert capsys.readouterr().err == line


def test_more_options_are_listed_last(verb, capsys):
    def run(
        out: panels.OutFolder,
        seed: Annotated[int, panels.more_option("--seed", help="Choose the room.")] = 7,
        style: Annotated[str | None, typer.Option(help="Pick one.", show_default="oak")] = None,
    ) -> None:
        """Probe."""

    verb(run)
    assert cli.run(["probe", "--help"]) == 0
    first, _, more = capsys.readouterr().out.partition("\nMore options:\n")
    assert re.search(r"Options:\n  -o, --out PATH|Options:\n  --out, -o PATH", first)
    assert "[default: oak]" in first
    assert first.rstrip().endswith("w2m probe      an example")
    assert more == "  --seed N  Choose the room.  [default: 7]\n"


def test_help_imports_nothing_heavy():
    code = (
        "import sys; from world2minecraft import cli; cli.run(['--help']); "
        "print(sorted({'numpy', 'numba', 'scipy', 'pydantic', 'rich', 'torch'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["doctr"], "error: no verb is named 'doctr'; did you mean 'doctor'?\n"),
        (["--nope"], "error: no such option: --nope; see w2m --help\n"),
        (["doctor", "x"], "error: got unexpected extra argument(s) (x); see w2m doctor --help\n"),
        (["convert"], "error: missing argument 'SOURCE'; see w2m convert --help\n"),
        (["convert", "--forc"], "--force"),
    ],
)
def test_wrong_usage_is_one_line_and_exit_code_2(words, line, capsys):
    assert cli.run(words) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert line in err
    assert err.count("\n") == 1


FAILURES = [
    (UsageError("give --out"), "error: give --out\n", 2),
    (CaptureError("cap", "has no poses"), "error: cap: has no poses\n", 3),
    (CaptureError("cap", "a\n\n b"), "error: cap: a b\n", 3),
    (KeyboardInterrupt(), "interrupted; run the same command again to continue\n", 130),
    (
        MemoryError(),
        "error: out of memory; close other programs, or use a larger --voxel\n",
        1,
    ),
    (
        OSError(errno.ENOSPC, "No space left on device", "OUT/room.npz"),
        "error: OUT/room.npz: the disk is full; free some space and run the same command again\n",
        3,
    ),
    (
        KeyError("x"),
        "error: unexpected KeyError: 'x'; please report it with the output of --traceback\n",
        1,
    ),
    (
        ZeroDivisionError(),
        "error: unexpected ZeroDivisionError; please report it with the output of --traceback\n",
        1,
    ),
]


@pytest.mark.parametrize(
    ("error", "line", "code"), FAILURES, ids=lambda value: type(value).__name__
)
def test_what_goes_wrong_is_one_line_and_an_exit_code(verb, capsys, error, line, code):
    verb(failing(error))
    assert cli.run(["probe"]) == code
    assert capsys.readouterr().err == line


@pytest.mark.parametrize("words", [["probe", "--traceback"], ["--traceback", "probe"]])
def test_a_traceback_is_shown_where_it_is_asked_for(verb, capsys, words):
    verb(failing(KeyError("x")))
    assert cli.run(words) == 1
    text = capsys.readouterr().err
    assert "Traceback" in text
    assert text.endswith(
        "error: unexpected KeyError: 'x'; please report it with the output of --traceback\n"
    )


def test_the_environment_asks_for_a_traceback_too(verb, capsys, monkeypatch):
    monkeypatch.setenv("W2M_TRACEBACK", "1")
    verb(failing(UsageError("no")))
    assert cli.run(["probe"]) == 2
    assert "Traceback" in capsys.readouterr().err


@pytest.mark.parametrize(("returned", "code"), [(None, 0), (0, 0), (1, 1)])
def test_a_verb_returns_its_exit_code(verb, returned, code):
    def run() -> int | None:
        """Return it."""
        return returned

    verb(run)
    assert cli.run(["probe"]) == code


def test_a_verbs_help_shows_its_docstring_to_its_args(verb, capsys):
    def run(scale: float = 4.0) -> None:
        """Not shown: the table has the line.

        Shown, as a paragraph.

        Args:
            scale: not shown.
        """

    verb(run)
    assert cli.run(["probe", "--help"]) == 0
    text = capsys.readouterr().out
    assert "Probe the skeleton." in text
    assert "Shown, as a paragraph." in text
    assert "shown: the table" not in text
    assert "scale: not" not in text
    assert "4.0" in text


def test_system_exit_keeps_its_code():
    assert failures.report_error(SystemExit(7)) == 7
    assert failures.report_error(SystemExit(None)) == 0


def test_main_leaves_with_the_exit_code(monkeypatch):
    monkeypatch.setattr(sys, "argv", ["w2m", "doctr"])
    with pytest.raises(SystemExit) as caught:
        cli.main()
    assert caught.value.code == 2
