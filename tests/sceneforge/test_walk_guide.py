"""The way to a thing that a sentence names, by the planner and over HTTP."""

import numpy as np
import pytest
from forge_serving import client, served

from world2minecraft.sceneforge.build_preview import BlockBuild, BuildOptions, SceneSnapshot
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.scene_sources import demo_room
from world2minecraft.sceneforge.walk_guide import WalkGuide, names_like, subject_of

LAMP, SOFA, FEET_M = 16, 2, (1.4, 0.7, 0.0)


@pytest.fixture(scope="module")
def guide() -> WalkGuide:
    """A guide through the demo room at 4 blocks per metre."""
    scene = SceneSnapshot.of(Editor(demo_room()))
    return WalkGuide(BlockBuild.of(scene, BuildOptions()).volume, scene.objects, scene.name)


def test_a_way_leads_over_the_floor_to_the_thing(guide):
    found = guide.answer("Please go to the lamp!", FEET_M)
    assert found["thing"]["id"] == LAMP and found["of"] == 1
    way, floor = np.array(found["corners_m"]), guide.scene.to_room_m(guide.scene.corner_graph.feet)
    assert np.allclose(way[0], FEET_M, atol=0.001)
    off = [np.linalg.norm(floor - corner, axis=1).min() for corner in way[1:]]
    assert max(off) < 0.01
    lengths = np.linalg.norm(np.diff(way, axis=0), axis=1)
    assert found["away_m"] == pytest.approx(lengths.sum(), abs=0.02)
    end = np.linalg.norm(way[-1, :2] - np.array(found["thing"]["center_m"])[:2])
    assert end < np.linalg.norm(np.array(FEET_M[:2]) - found["thing"]["center_m"][:2])


def test_the_nearest_of_several_is_chosen_or_the_one_with_the_id(guide):
    nearest = guide.answer("the television", FEET_M)
    ids = [one.number for one in guide.scene.landmarks if one.noun == "television"]
    ways = {n: guide.answer(f"television {n}", FEET_M) for n in ids}
    assert nearest["of"] == len(ids) > 1
    assert all(way["thing"]["id"] == n for n, way in ways.items())
    assert nearest["away_m"] == min(way["away_m"] for way in ways.values())


def test_what_is_not_there_gets_the_closest_names(guide):
    found = guide.answer("where is the zeppelin?", FEET_M)
    assert found["thing"] is None and found["subject"] == "zeppelin"
    assert {"lamp", "sofa"} <= set(found["near"])
    assert names_like("coffeetable", guide.scene.landmarks) == ["coffee table"]
    assert subject_of("Could you lead me to the   piano?") == "piano"


def test_no_way_leads_from_where_nobody_can_stand(guide):
    found = guide.answer("sofa", (1.4, 0.7, 30.0))
    assert found["thing"]["id"] == SOFA
    assert found["corners_m"] is None and found["away_m"] is None


def test_the_way_is_that_of_the_scene_as_edited(tmp_path):
    editor = Editor(demo_room())
    with served(editor, home=tmp_path) as server, client(server) as script:
        place = {"feet_m": "1.4,0.7,0", "blocks_per_metre": 2, "style": "display"}
        assert script.get("/api/way", params={"to": "lamp"} | place).json()["thing"]["id"] == LAMP
        editor.do("rename_objects", ids=[LAMP], name="Wilson")
        found = script.get("/api/way", params={"to": "go to wilson"} | place).json()
        assert found["thing"]["name"].casefold() == "wilson"
        for wrong, words in (
            ({"to": ""}, "to must be 1 to 200 characters"),
            ({"to": "lamp", "feet_m": "1,2"}, "feet_m must be three numbers"),
            ({"to": "lamp", "feet_m": "1,2,nan"}, "feet_m must be three finite numbers"),
        ):
            answer = script.get("/api/way", params=place | wrong)
            assert answer.status_code == 400 and words in answer.json()["error"]
