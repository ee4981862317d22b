"""A judge's grades: what is asked, what is read, and that nothing is ever made up."""

import pytest
from tests.external_models.scripted_server import proper, scripted

from world2minecraft.core.errors import UsageError
from world2minecraft.external_models.chat_client import open_chat
from world2minecraft.external_models.chat_messages import Picture
from world2minecraft.external_models.reply_cache import ReplyStore
from world2minecraft.external_models.structured_replies import UnreadableError
from world2minecraft.paper.layouts.judge import (
    ASPECTS,
    Grades,
    grade,
    means_of,
    prompt_sum,
    prompt_text,
    read_grades,
)
from world2minecraft.paper.layouts.score_table import grade_table

SHOWN = (Picture(b"one"), Picture(b"two"))


def said(realism, completeness, atmosphere):
    return (
        f'{{"why": "so", "realism": {realism}, "completeness": {completeness}, '
        f'"atmosphere": {atmosphere}}}'
    )


def test_repeats_ask_anew_and_the_record_replays_them(tmp_path):
    with scripted([said(5, 6, 7), said(6, 6, 7), said(7, 6, 7)]) as server:
        chat = open_chat(server.url, store=ReplyStore(tmp_path / "r.jsonl"), temperature=None)
        told = grade(chat, "room", "ours", SHOWN, wish="A bedroom.")
        assert [row["realism"] for row in told.rows if row] == [5, 6, 7]
        assert told.mean("realism") == 6.0
        again = grade(chat, "room", "ours", SHOWN, wish="A bedroom.")
        assert again.rows == told.rows and len(server.requests) == 3
        asked = server.requests[0]["messages"][0]["content"]
        text = "".join(part.get("text", "") for part in asked)
        assert text.startswith(prompt_text()) and "A bedroom." in text
        assert "ours" not in text and "room, built of blocks" in text
        assert sum(part["type"] == "image_url" for part in asked) == 2


def test_what_is_no_grade_is_asked_again_and_then_left_out():
    with scripted([proper("nine out of ten"), said(0, 5, 5), proper("9"), said(8, 8, 8)]) as server:
        told = grade(open_chat(server.url), "room", "ours", SHOWN, repeats=2)
    assert told.rows == (None, dict.fromkeys(ASPECTS, 8))
    assert told.unread == 1 and told.mean("realism") == 8.0


def test_without_any_grade_the_score_is_empty():
    none = Grades("a", "ours", (None, None), ())
    assert none.mean("realism") is None and none.told()["mean"]["realism"] is None
    assert means_of([none])["ours"]["realism"] is None
    assert grade_table(means_of([none]))[1] == ["ours", "0", "", "", ""]


def test_means_are_over_scenes():
    rows = [Grades(str(n), "ours", (dict.fromkeys(ASPECTS, n),), ()) for n in (4, 8)]
    assert means_of(rows)["ours"]["atmosphere"] == (6.0, 2.0, 2)
    assert grade_table(means_of(rows))[1][:3] == ["ours", "2", "6.000 +- 2.000"]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("good", "the reply does not contain a JSON object"),
        ('{"realism": 5}', "completeness must be an integer from 1 to 10"),
        (said(11, 5, 5), "realism must be an integer from 1 to 10"),
        (said(5.5, 5, 5), "realism must be an integer from 1 to 10"),
        (said("true", 5, 5), "realism must be an integer from 1 to 10"),
    ],
)
def test_a_bad_reply_is_told_why(text, problem):
    with pytest.raises(UnreadableError, match=problem):
        read_grades(text)


def test_a_grade_with_a_point_nought_is_one():
    assert read_grades(said("7.0", 5, 5))["realism"] == 7


def test_the_prompt_is_fixed():
    """Grades of different prompts do not compare; a change of it is meant, and told."""
    assert prompt_sum()[:12] == "7aa772e36000"
    assert all(aspect in prompt_text() for aspect in ASPECTS)


def test_a_room_is_graded_at_least_once():
    with pytest.raises(UsageError, match="repeats must be 1 or more"):
        grade(None, "a", "b", SHOWN, repeats=0)
