"""Items as questions: a mark for each picture, and no mark that is none."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.navigation.vln_sets import next_action, next_view

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.item_prompts import IMAGE, question_of
from world2minecraft.navigation.types import Instruction

ASKED = """\
You walk through a Minecraft world and follow an instruction.
Instruction: Turn left at the door, walk past the table and stop at the piano.
You saw before, oldest first: <image><image>
You see now: <image>
Which of these views do you see next?
A. <image>
B. <image>
C. <image>
D. <image>"""


def test_a_next_view_item_is_asked_in_these_words():
    item = next_view(step=2)
    asked = question_of(item)
    assert asked.text == ASKED
    assert asked.images == (*item.history, item.current, *(one.image for one in item.options))
    assert asked.answer == "C"


def test_the_parts_are_the_text_and_the_pictures_in_their_order():
    asked = question_of(next_view(step=2))
    parts = list(asked.parts)
    assert "".join(IMAGE if kind == "image" else value for kind, value in parts) == asked.text
    assert tuple(value for kind, value in parts if kind == "image") == asked.images


@given(st.text(min_size=1, max_size=80).filter(lambda text: text.strip()))
def test_each_picture_has_one_mark_whatever_the_words(words):
    item = replace(next_action(step=1), instruction=Instruction(words))
    try:
        asked = question_of(item)
    except UsageError:
        assert "<" in words
        return
    assert asked.text.count(IMAGE) == len(asked.images) == 1
    assert len(asked.text.splitlines()) >= 8


@pytest.mark.parametrize("mark", ["<image>", "<VIDEO>", "<|im_end|>", "<|image_pad|>"])
def test_words_that_hold_a_mark_are_refused(mark):
    item = replace(next_action(), instruction=Instruction(f"Go {mark} there."))
    with pytest.raises(UsageError) as caught:
        question_of(item)
    assert str(caught.value) == (
        f"item kitchen-t0-na-0: the text contains {mark!r}, which trainers and models "
        "interpret as an image or the end of a turn; reword it"
    )
