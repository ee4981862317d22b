"""``w2m completion``: scripts for shells, and the answers that they ask for."""

import os
import shutil
import subprocess
import sys

import pytest

from world2minecraft import cli
from world2minecraft.cli.verbs import VERBS, complete_verbs

HEAVY = "{'numpy', 'numba', 'scipy', 'torch'}"
CODE = (
    "import sys, atexit; from world2minecraft import cli; "
    f"atexit.register(lambda: print(sorted({HEAVY} & set(sys.modules)), file=sys.stderr)); "
    "cli.main()"
)


def complete(line):
    """Return the words that bash is given for the last word of a line, and heavy imports."""
    words = line.split(" ")
    asked = {
        "COMP_WORDS": line,
        "COMP_CWORD": str(len(words) - 1),
        "_W2M_COMPLETE": "complete_bash",
    }
    done = subprocess.run(
        [sys.executable, "-c", CODE],
        env={**os.environ, **asked},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stderr == "[]\n"
    return done.stdout.split()


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("w2m re", ["reconstruct", "render"]),
        ("w2m dataset ve", ["verify"]),
        ("w2m forge st", ["stats"]),
        ("w2m demo --se", ["--seed"]),
        ("w2m dataset build --see", ["--seed"]),
        ("w2m forge --por", ["--port"]),
        ("w2m forge ", []),
        ("w2m rooms ", ["generate", "scan"]),
    ],
)
def test_a_shell_completes_without_importing_numpy(line, words):
    assert complete(line) == words


def test_each_first_word_is_completed_once():
    first = [one.value for one in complete_verbs("", "")]
    assert first == list(dict.fromkeys(verb.partition(" ")[0] for verb in VERBS))
    assert all(one.help for one in complete_verbs("", ""))


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_each_shell_has_a_script(shell, capsys):
    assert cli.run(["completion", shell]) == 0
    text = capsys.readouterr().out
    assert f"_W2M_COMPLETE=complete_{shell}" in text


def test_bash_accepts_the_script(capsys):
    if not shutil.which("bash"):
        pytest.skip("no bash on this machine")
    assert cli.run(["completion", "bash"]) == 0
    script = capsys.readouterr().out
    done = subprocess.run(
        ["bash", "-c", f"{script}\ncomplete -p w2m"], capture_output=True, text=True, check=True
    )
    assert done.stdout.endswith(" w2m\n")


def test_an_unknown_shell_is_an_error_that_names_the_known(capsys):
    assert cli.run(["completion", "bsh"]) == 2
    assert "no shell is named 'bsh'; did you mean 'bash'?" in capsys.readouterr().err
