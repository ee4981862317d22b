"""The examples that help pages and docs show: each names a verb, and gives it what it takes."""

import re
import shlex
from pathlib import Path

import pytest

from world2minecraft.cli.verbs import EXAMPLES, VERBS, load

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
TAKES = {verb: load(verb) for verb in VERBS}


def commands_of(text):
    """Return the commands of lines that begin with w2m, without what is said of them.

    A line with an ellipsis is no whole command.
    """
    for line in text.splitlines():
        if line.startswith("w2m ") and " ... " not in line:
            yield from re.split(r" && |; ", re.split(r"\s{2,}|\s+#", line)[0])


def shown(pages):
    for page in pages:
        for block in re.findall(r"^```\w*\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL):
            yield from (
                pytest.param(line, id=f"{page.name}: {line}")
                for line in commands_of(block.replace("\\\n", " "))
            )


def parse(line):
    """Let a verb read a line's words and check each, and run nothing."""
    words = shlex.split(line, comments=True)[1:]
    name = " ".join(words[:2]) if " ".join(words[:2]) in VERBS else words[0]
    return TAKES[name].make_context(name, words[len(name.split()) :])


@pytest.mark.parametrize("verb", VERBS)
def test_each_example_of_a_help_page_is_taken(verb):
    examples = list(commands_of(TAKES[verb].examples))
    assert examples
    for line in examples:
        assert parse(line)


@pytest.mark.parametrize("line", list(commands_of(EXAMPLES)))
def test_each_example_of_the_whole_is_taken(line):
    assert parse(line)


@pytest.mark.parametrize("line", list(shown(PAGES)))
def test_each_command_of_the_docs_is_taken(line):
    assert parse(line)


@pytest.mark.parametrize("line", ["w2m demo --nope", "w2m convert", "w2m paper figure"])
def test_what_no_verb_takes_is_found(line):
    with pytest.raises(Exception) as caught:
        parse(line)
    assert re.match("(?i)no such option|missing argument", caught.value.format_message())


@pytest.mark.parametrize("verb", VERBS)
def test_what_is_to_be_given_stands_in_capitals(verb):
    for one in TAKES[verb].params:
        if one.param_type_name == "argument" or not one.is_flag:
            assert one.metavar, one.name
    usage = " ".join(
        TAKES[verb].collect_usage_pieces(TAKES[verb].make_context(verb, [], resilient_parsing=True))
    )
    assert not re.search(r"[{}<>]|\[\[", usage)
