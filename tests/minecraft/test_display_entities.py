"""Display entities: what is written is what is drawn, in every file and in no game too old."""

import io
import zlib
from dataclasses import replace

import nbtlib
import numpy as np
import pytest
from block_volumes import random_volume
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Entity
from world2minecraft.minecraft.commands.datapack import datapack_files
from world2minecraft.minecraft.commands.writer import entity_commands, entity_tag
from world2minecraft.minecraft.entities import (
    block_display,
    check_displays,
    display_cubes,
    owner_of,
    owner_tags,
)
from world2minecraft.minecraft.schematics.sponge import read_schem, write_schem
from world2minecraft.minecraft.turn_and_mirror import turn_volume
from world2minecraft.minecraft.versions import GameVersion, game_version
from world2minecraft.minecraft.worlds.world_writer import read_world, write_world

CHAIR = block_display(
    "minecraft:oak_planks", np.array([-1.5, 0, -0.5, 1.0, 0.5, 0.75]), (3.25, 65.5, -2.0),
    yaw_deg=30.0, class_id=5, instance=12, view_range=2.0, light=15,
)  # fmt: skip
UNIT = np.array([[x, y, z, 1.0] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
side = st.floats(-3, 3, allow_nan=False)


def corners_of(entity: Entity) -> np.ndarray:
    """The eight corners, float64 [8, 3], of what an entity draws."""
    (cube,) = display_cubes((entity,))
    return (UNIT @ cube.cube_to_world.T)[:, :3]


@given(
    st.tuples(side, side, side), st.tuples(*[st.floats(0.01, 3)] * 3), st.floats(-720, 720), side
)
def test_a_display_is_its_box_turned_about_its_position(low, size, yaw_deg, east):
    box = np.array([*low, *np.add(low, size)])
    position = np.array([east, 64.0, -east])
    entity = block_display("minecraft:stone", box, position.tolist(), yaw_deg=yaw_deg)
    angle = np.radians(yaw_deg)
    expected = []
    for corner in UNIT[:, :3]:
        x, y, z = box[:3] + corner * (box[3:] - box[:3])
        # Counter-clockwise from above: east (x) turns to north (-z).
        turned = [x * np.cos(angle) + z * np.sin(angle), y, z * np.cos(angle) - x * np.sin(angle)]
        expected.append(position + turned)
    found = corners_of(entity)
    for corner in expected:
        assert np.abs(found - corner).max(axis=1).min() < 1e-4


def test_a_quarter_turn_needs_no_rotation():
    entity = block_display("stone", np.array([0, 0, 0, 2, 1, 1]), (0.0, 0.0, 0.0), yaw_deg=270.0)
    parts = entity.nbt["transformation"]
    assert parts["left_rotation"] == [0, 0, 0, 1]
    assert parts["scale"] == [1, 1, 2]


def test_the_nbt_is_what_the_game_reads():
    assert CHAIR.id == "minecraft:block_display"
    assert CHAIR.nbt["block_state"] == {"Name": "minecraft:oak_planks"}
    assert CHAIR.nbt["brightness"] == {"block": 15, "sky": 15}
    assert CHAIR.nbt["view_range"] == 2.0
    assert CHAIR.nbt["Tags"] == ["w2m", "w2m_class_chair", "w2m_object_12"]
    assert set(CHAIR.nbt["transformation"]) == {
        "left_rotation", "right_rotation", "scale", "translation",
    }  # fmt: skip
    log = block_display("oak_log[axis=x]", np.array([0, 0, 0, 1, 1, 1]), (0, 0, 0))
    assert log.nbt["block_state"]["Properties"] == {"axis": "x"}


def test_the_owner_is_told_by_tags_where_a_file_forgot_it():
    bare = replace(CHAIR, class_id=0, instance=0)
    assert owner_of(bare) == owner_of(CHAIR) == (5, 12)
    odd = replace(bare, nbt={"Tags": ["w2m_class_dragon", "w2m_object_99999999", "w2m_object_x"]})
    assert owner_of(odd) == (0, 0)
    assert owner_of(replace(bare, nbt={"Tags": "w2m_object_3"})) == (0, 0)
    assert owner_tags(0, 0) == ["w2m"]


def furnished():
    return replace(random_volume((20, 9, 18), 12, (-3, 60, -5)), entities=(CHAIR,))


@pytest.mark.parametrize("schem_version", [2, 3])
def test_schematics_keep_displays(tmp_path, schem_version):
    write_schem(furnished(), tmp_path / "a.schem", schem_version=schem_version)
    (back,) = read_schem(tmp_path / "a.schem").entities
    assert np.allclose(corners_of(back), corners_of(CHAIR), atol=1e-5)
    assert owner_of(back) == (5, 12)


def test_worlds_keep_displays_in_their_entity_regions(tmp_path):
    write_world(furnished(), tmp_path / "w", name="x", spawn=(0, 64, 0), spawn_yaw_deg=0.0)
    (back,) = read_world(tmp_path / "w").entities
    assert np.allclose(corners_of(back), corners_of(CHAIR), atol=1e-5)
    raw = (tmp_path / "w" / "entities" / "r.0.-1.mca").read_bytes()
    start = int.from_bytes(raw[31 * 128 : 31 * 128 + 3]) * 4096  # Chunk (0, -1).

    root = nbtlib.File.parse(io.BytesIO(zlib.decompress(raw[start + 5 :])))
    (stored,) = root["Entities"]
    assert stored["id"] == "minecraft:block_display"
    assert isinstance(stored["transformation"]["scale"][0], nbtlib.Float)
    assert [float(v) for v in stored["Pos"]] == [3.25, 65.5, -2.0]


def test_a_data_pack_run_again_summons_each_display_once():
    volume = furnished()
    files = datapack_files(volume, game_version(), "room")
    (path,) = [name for name in files if name.endswith("functions/build/part_0.mcfunction")]
    lines = files[path].splitlines()
    gone, summoned = f"kill @e[tag={entity_tag(volume)}]", entity_commands(volume)
    assert lines.index(gone) < lines.index(summoned[0])
    assert len(summoned) == 1
    assert len(summoned[0]) < 1446  # What one packet of RCON holds.
    assert f'"{entity_tag(volume)}"' in summoned[0]
    clear = [
        text for name, text in files.items() if name.endswith("functions/clear/part_0.mcfunction")
    ]
    assert gone in clear[0]


@pytest.mark.parametrize("turns", [1, 2, 3])
def test_turning_a_volume_turns_its_displays(turns):
    volume = furnished()
    turned = turn_volume(volume, turns)
    to_room = [one.block_to_room for one in (volume, turned)]
    before, after = (
        np.array([matrix @ [*corner, 1] for corner in corners_of(one.entities[0])])
        for matrix, one in zip(to_room, (volume, turned), strict=True)
    )
    assert np.allclose(before, after, atol=1e-5)


def test_an_old_game_is_refused_with_what_to_do_instead():
    old = GameVersion("1.19.3", 3218, 10)
    check_displays(replace(furnished(), entities=()), old)
    check_displays(furnished(), game_version("1.20.1"))
    expected = (
        "Minecraft 1.19.3 does not support display entities (new in 1.19.4); use "
        "build.style=blocks or another version (--mc-version)"
    )
    with pytest.raises(UsageError) as told:
        datapack_files(furnished(), old, "room")
    assert str(told.value) == expected
