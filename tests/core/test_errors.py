"""Errors: their texts byte for byte, their exit codes, and the tree in the docstring."""

import inspect
import pickle
import re

import pytest

from world2minecraft.core import errors
from world2minecraft.core.classes import CLASS_COLOURS, CLASS_COUNT, CLASS_NAMES, class_id

GOLDEN = [
    (
        errors.UnknownNameError("class", "soffa", ["sofa", "bed"]),
        "no class is named 'soffa'; did you mean 'sofa'?",
        2,
    ),
    (
        errors.UnknownNameError("class", "qqq", ["sofa", "bed"]),
        "no class is named 'qqq'; known: bed, sofa",
        2,
    ),
    (
        errors.MissingExtraError("the network labeller", "hf"),
        "the network labeller needs an extra: pip install 'world2minecraft[hf]'",
        2,
    ),
    (errors.InputError("a.png", "is not there"), "a.png: is not there", 3),
    (errors.DamagedFileError("a.nbt", "ends early"), "a.nbt: ends early", 3),
    (errors.LimitError("a.png", "has 400 megapixels"), "a.png: has 400 megapixels", 3),
    (errors.CaptureError("cap", "has no poses"), "cap: has no poses", 3),
    (errors.ConflictError("saves/Home", "is open"), "saves/Home: is open", 3),
    (errors.OutputError("out", "is a file"), "out: is a file", 3),
    (errors.UsageError("give one"), "give one", 2),
    (errors.ServerError("gone"), "gone", 1),
    (errors.WorkerError("ended"), "ended", 1),
    (errors.BudgetError("spent"), "spent", 1),
    (errors.World2MinecraftError("failed"), "failed", 1),
]


@pytest.mark.parametrize(("error", "text", "code"), GOLDEN, ids=lambda value: type(value).__name__)
def test_texts_and_exit_codes(error, text, code):
    assert str(error) == text
    assert error.exit_code == code
    assert isinstance(error, errors.World2MinecraftError)


@pytest.mark.parametrize("error", [one for one, _, _ in GOLDEN], ids=lambda e: type(e).__name__)
def test_an_error_can_be_sent_to_another_process(error):
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), vars(again)) == (type(error), str(error), vars(error))


def test_an_input_error_keeps_its_path_and_reason():
    error = errors.CaptureError("cap", "has no poses")
    assert (error.path, error.reason) == ("cap", "has no poses")


def test_the_drawn_tree_is_the_real_one():
    """Each line of the drawing: indent by depth, name, exit code."""
    rows = re.findall(r"^ {4}([│├└─ ]*)(\w+Error)\s+(?:exit code )?(\d)", errors.__doc__, re.M)
    drawn = {name: (len(indent) // 4, int(code)) for indent, name, code in rows}
    classes = [
        value
        for _, value in inspect.getmembers(errors, inspect.isclass)
        if issubclass(value, errors.World2MinecraftError)
    ]
    depth = {value: len(value.__mro__) - 4 for value in classes}
    assert drawn == {value.__name__: (depth[value], value.exit_code) for value in classes}


def test_every_class_has_a_name_a_colour_and_its_id():
    assert len(CLASS_NAMES) == len(CLASS_COLOURS) == len(set(CLASS_COLOURS)) == CLASS_COUNT
    assert [class_id(name) for name in CLASS_NAMES] == list(range(CLASS_COUNT))
    with pytest.raises(errors.UnknownNameError, match="did you mean 'chair'"):
        class_id("chiar")
