"""Names of objects: renaming, what other edits do with names, and their place in the journal."""

from dataclasses import replace

import pytest
from object_scenes import CHAIR, LAMP, TABLE, furnished_room, plain_tools

from world2minecraft.core.errors import UsageError
from world2minecraft.editing.scene import parse_command
from world2minecraft.editing.scene.journal import pack_objects, unpack_objects
from world2minecraft.editing.scene.object_conversion import instances_of, objects_of

TOOLS = plain_tools()


def named_room():
    """The furnished room, with a bar stool, a desk and a lamp of unknown name."""
    draft = furnished_room()
    for number, name in ((CHAIR, "bar stool"), (TABLE, "desk")):
        draft.objects[number] = replace(draft.objects[number], name=name, name_confidence=0.8)
    return draft


def do(draft, **fields):
    operation = parse_command(fields).plan(draft, TOOLS)
    draft.apply(operation)
    return operation


def names(draft):
    return {number: one.name for number, one in draft.objects.items()}


@pytest.mark.parametrize(
    ("text", "name", "confidence"),
    [
        ("couch", "sofa", 1.0),
        ("  Grandma's\t chair ", "Grandma's chair", 1.0),
        ("", "chair", 0.0),
    ],
)
def test_renaming_uses_the_vocabulary_or_own_words(text, name, confidence):
    draft = named_room()
    operation = do(draft, op="rename_objects", ids=[CHAIR], name=text)
    one = draft.objects[CHAIR]
    assert (one.name, one.name_confidence, one.class_id) == (name, confidence, 5)
    assert one.placements and not len(operation.cells)
    draft.apply(operation.inverse())
    assert names(draft) == names(named_room())


@pytest.mark.parametrize("text", ["a" * 61, "a\x00b", "\u202eevil"])
def test_names_must_be_short_printable_text(text):
    with pytest.raises(UsageError, match="rename_objects: name"):
        parse_command({"op": "rename_objects", "ids": [CHAIR], "name": text})


def test_renaming_without_change_is_refused():
    with pytest.raises(UsageError, match="already have this name"):
        do(named_room(), op="rename_objects", ids=[TABLE], name="desk")


def test_edits_keep_names():
    draft = named_room()
    do(draft, op="turn_objects", ids=[CHAIR], quarter_turns=1)
    do(draft, op="rematch", ids=[CHAIR, TABLE])
    do(draft, op="split_object", id=TABLE, parts=2)
    parts = [one for one in draft.objects.values() if one.name == "desk"]
    assert len(parts) == 2
    do(draft, op="duplicate_object", id=CHAIR)
    assert sorted(names(draft).values()) == ["", "bar stool", "bar stool", "desk", "desk"]
    do(draft, op="merge_objects", ids=[CHAIR, *(one.id for one in parts)])
    assert draft.objects[CHAIR].name == "bar stool"
    assert names(draft)[LAMP] == ""


def test_relabelling_drops_names_of_another_class():
    draft = named_room()
    draft.objects[LAMP] = replace(draft.objects[LAMP], name="Wilson", name_confidence=1.0)
    do(draft, op="relabel_objects", ids=[CHAIR, LAMP], class_id=8)
    assert names(draft) == {CHAIR: "", TABLE: "desk", LAMP: "Wilson"}


def test_added_furniture_has_the_name_of_its_template():
    draft = furnished_room()
    where = {"at_m": [1.5, 0.5, 0.0], "template": "office_chair"}
    do(draft, op="add_object", class_id=5, **where)
    added = draft.objects[max(draft.objects)]
    assert (added.name, added.name_confidence) == ("office chair", 1.0)


def test_names_survive_the_journal_and_older_files_have_none():
    draft = named_room()
    held = tuple(draft.objects.values())
    read = unpack_objects(pack_objects(held), "a.bin")
    assert [(one.name, one.name_confidence) for one in read] == [
        ("bar stool", 0.8),
        ("desk", 0.8),
        ("", 0.0),
    ]
    unnamed = pack_objects([replace(one, name="", name_confidence=0.0) for one in held])
    assert b"name" not in unnamed
    assert {one.name for one in unpack_objects(unnamed, "a.bin")} == {""}
    assert [one.name for one in objects_of(instances_of(held, draft.instance))] == [
        "bar stool",
        "desk",
        "",
    ]
