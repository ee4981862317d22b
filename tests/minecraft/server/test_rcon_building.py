"""Building on a server: whole after any cuts, resumed, checked, and told plainly what is wrong."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rcon_console import Console
from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import ServerError, UsageError
from world2minecraft.core.types import AIR, BlockEntity, BlockVolume, Entity
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.server.rcon import MAX_COMMAND_BYTES, RconClient
from world2minecraft.minecraft.server.server_build import LiveBuilder, plan_build
from world2minecraft.minecraft.versions import game_version

NAMES = ("white_concrete", "oak_stairs[facing=west]", "torch", "oak_sign")
PALETTE = (AIR, *(str(complete(parse_state(name))) for name in NAMES))
VERSION = game_version("1.20.1")


def volume_of(states, corner=(-3, 64, 5), **more):
    states = np.asarray(states, np.uint16)
    empty = np.zeros(states.shape, np.uint8)
    to_room = block_to_room(np.zeros(2), 4.0)
    return BlockVolume(states, PALETTE, empty, empty.astype(np.uint16), corner, to_room, **more)


def random_volume(seed=0, shape=(9, 5, 7)):
    rng = np.random.default_rng(seed)
    states = rng.integers(0, len(PALETTE), shape)
    states[:, 0] = 1
    return volume_of(states)


def expected(volume):
    cells = np.argwhere(volume.states)
    return {
        tuple((cell + volume.corner).tolist()): volume.palette[volume.states[tuple(cell)]]
        for cell in cells
    }


def client_of(console, password="secret"):
    return RconClient("127.0.0.1", console.port, password, timeout_s=5)


def build(console, volume, note=None, **options):
    plan = plan_build(volume, VERSION, **options)
    return LiveBuilder(client_of(console), plan, note, sleep=lambda _: None).run()


def test_a_reply_longer_than_a_packet_comes_whole():
    with Console() as console, client_of(console) as client:
        assert client.command("help") == "help " * 2000
        assert client.command("summon x") == "Summoned new Block Display"


def test_a_wrong_password_is_told():
    with Console() as console, pytest.raises(ServerError, match="rejected the RCON password"):
        client_of(console, "guess").connect()


@pytest.mark.parametrize("text", ["say a\nop me", "say \0", "x" * (MAX_COMMAND_BYTES + 1)])
def test_no_second_command_slips_into_one(text):
    with Console() as console, client_of(console) as client:
        with pytest.raises(UsageError):
            client.command(text)
        assert not console.commands


@settings(max_examples=15, deadline=None)
@given(st.sets(st.integers(0, 300), max_size=5), st.integers(0, 5))
def test_whatever_is_cut_the_blocks_are_whole(cuts, seed):
    volume = random_volume(seed)
    with Console(cuts=cuts) as console:
        console.blocks[(0, 66, 6)] = "minecraft:stone"  # What stood there makes way.
        result = build(console, volume)
        assert console.blocks == expected(volume)
        assert result.repaired == 0
        assert not console.forced


def test_without_clearing_what_stands_there_stays():
    volume = volume_of(np.zeros((2, 2, 2)))
    with Console() as console:
        console.blocks[(-3, 64, 5)] = "minecraft:stone"
        build(console, volume, built=np.zeros(volume.states.shape, bool))
        assert console.blocks == {(-3, 64, 5): "minecraft:stone"}


def test_a_second_run_goes_on_where_the_first_was_stopped(tmp_path):
    volume, note = random_volume(3), tmp_path / "rcon.json"
    with Console() as console:
        plan = plan_build(volume, VERSION)

        class Stopped(Exception):
            pass

        def stop(stage, done, total, note=""):
            if stage == "build" and done == total // 2:
                raise Stopped

        with pytest.raises(Stopped):
            LiveBuilder(client_of(console), plan, note, stop, sleep=lambda _: None).run()
        assert note.is_file()
        before = len(console.commands)
        LiveBuilder(client_of(console), plan, note, sleep=lambda _: None).run()
        assert console.blocks == expected(volume)
        assert len(console.commands) - before < len(plan.work) // 2 + len(plan.probes) + 10
        assert not note.exists()


def test_notes_of_other_plans_or_damaged_notes_are_ignored(tmp_path):
    note = tmp_path / "rcon.json"
    for held in ('{"server": "x", "plan": "y", "done": 90}', "{", "[]"):
        note.write_text(held)
        volume = random_volume(4)
        with Console() as console:
            build(console, volume, note)
            assert console.blocks == expected(volume)


def test_entities_stand_once_however_often_they_are_cut():
    held = tuple(
        Entity((0.5 + n, 65.0, 6.5), "minecraft:block_display", {"Tags": ["chair"]})
        for n in range(9)
    )
    volume = replace(random_volume(1, (4, 3, 4)), entities=held)
    with Console() as quiet:
        build(quiet, volume)
        total = len(quiet.commands)
    for cut in range(total - 40, total):
        with Console(cuts=[cut]) as console:
            build(console, volume)
            assert len(console.entities) == 9


def test_chunks_that_come_late_are_waited_for():
    volume = random_volume(2)
    with Console(load_after=7) as console:
        build(console, volume)
        assert console.blocks == expected(volume)


def test_chunk_loading_is_checked_on_servers_before_1_19_4():
    volume = random_volume(2)
    with Console(is_old=True) as console:
        build(console, volume)
        assert console.blocks == expected(volume)


def test_what_a_neighbour_of_the_place_changes_is_no_fault():
    palette = (AIR, *(str(complete(parse_state(f"minecraft:{name}"))) for name in (
        "glass_pane", "oak_stairs", "chest", "oak_slab[type=double]", "grass_block")))  # fmt: skip
    states = np.arange(1, 6, dtype=np.uint16).reshape(5, 1, 1)
    volume = replace(volume_of(np.zeros((5, 1, 1))), states=states, palette=palette)
    plan = plan_build(volume, VERSION)
    assert [state for *_, state in plan.probes if state != AIR] == [
        "minecraft:glass_pane",
        "minecraft:oak_stairs[facing=north,half=bottom]",
        "minecraft:chest[facing=north]",
        "minecraft:oak_slab[type=double]",
        "minecraft:grass_block",
    ]
    assert any(c.startswith("setblock -3 64 5 minecraft:glass_pane[east=") for c in plan.work)
    joined = palette[1].replace("west=false", "west=true")

    class Joining(Console):
        def _set(self, places, state, done, same):
            return super()._set(places, joined if "pane" in state else state, done, same)

    with Joining() as console:
        assert build(console, volume).repaired == 0


@pytest.mark.parametrize(
    ("said", "advice"),
    [
        ("Too many blocks in the specified area (maximum 9, specified 27)", "commandModification"),
        ("That position is out of this world!", "choose another position"),
    ],
)
def test_a_refusal_comes_with_what_helps(said, advice):
    class Refusing(Console):
        def _set(self, *_):
            return said

    with Refusing() as console, pytest.raises(ServerError, match=advice):
        build(console, random_volume())


@pytest.mark.parametrize("host", ["localhost..", "x" * 64])
def test_a_host_that_can_be_no_name_is_told(host):
    with pytest.raises(ServerError, match="is not a valid host name; check the address"):
        RconClient(host, 1, "x", 1).connect()


def test_a_server_that_forbids_the_place_is_told_of():
    with Console(deaf_to="torch") as console, pytest.raises(ServerError) as caught:
        build(console, random_volume(5))
    assert "checked blocks are wrong after the build" in str(caught.value)
    assert "minecraft:torch" in str(caught.value)


def test_a_refused_command_is_shown_with_what_the_server_said():
    volume = volume_of(np.ones((1, 1, 1)))
    volume = replace(volume, palette=(AIR, "tmeo:shafa"))
    with Console() as console, pytest.raises(ServerError) as caught:
        build(console, volume)
    assert str(caught.value) == (
        "the server rejected 'setblock -3 64 5 tmeo:shafa': Unknown block type 'tmeo:shafa'; "
        "check that the version (--mc-version) is the server's"
    )


def test_nobody_there_is_one_line():
    with Console() as console:
        port = console.port
    plan = plan_build(random_volume(), VERSION)
    builder = LiveBuilder(RconClient("127.0.0.1", port, "x", 1), plan, sleep=lambda _: None)
    with pytest.raises(ServerError, match="no reply from .*enable-rcon=true"):
        builder.run()


def test_a_lost_server_is_reported_after_some_retries():
    waits = []

    def wait(seconds):
        waits.append(seconds)
        console.__exit__()

    with Console(cuts=[5]) as console:
        plan = plan_build(random_volume(), VERSION)
        with pytest.raises(
            ServerError, match="no reply from .*; run the same command again to resume"
        ):
            LiveBuilder(client_of(console), plan, sleep=wait).run()
    assert waits == [0.5, 1.0, 2.0, 4.0, 8.0, 8.0]


def test_data_too_long_for_a_packet_is_counted():
    held = BlockEntity((-3, 64, 5), "minecraft:sign", {"text": "x" * 2000})
    losses = Losses()
    plan_build(replace(random_volume(), block_entities=(held,)), VERSION, losses=losses)
    assert list(losses) == [("block entities whose data is too long for RCON", 1)]


def test_a_build_that_leaves_the_world_is_refused():
    with pytest.raises(
        UsageError, match="has layers 316 to 320, but the world has layers -64 to 319"
    ):
        plan_build(replace(random_volume(), corner=(0, 316, 0)), VERSION)
