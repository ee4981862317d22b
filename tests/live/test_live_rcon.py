"""A 20,000-block room is built on a running server, cut off twice, and is whole block for block."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from test_live_walk import HERE, free_port, node  # noqa: F401  # A fixture.

from world2minecraft.core.jit import user_cache_dir
from world2minecraft.minecraft.server.rcon import RconClient
from world2minecraft.minecraft.worlds.world_writer import read_world

pytestmark = pytest.mark.live

LIMIT_S = 240
PASSWORD = "correct horse"
AT = (-5, 70, 3)
CUT, STALL = 100, 300  # Commands: the server hangs up; it falls silent, and the builder is killed.
LEAST_BLOCKS = 20_000


@pytest.fixture(scope="module")
def room(tmp_path_factory) -> Path:
    """The build of a generated room at one block a voxel."""
    folder = tmp_path_factory.mktemp("room")
    script = """
import sys
import numpy as np
from world2minecraft.procgen import generate_room
room = generate_room(7, kind="living")
stride = round(0.08 / room.voxel_m)
np.save(sys.argv[1], room.labels[::stride, ::stride, ::stride])
"""
    subprocess.run([sys.executable, "-c", script, folder / "room.npy"], check=True)
    build = [*W2M, "build", folder / "room.npy", "--out", folder / "run"]
    subprocess.run([*build, "--blocks-per-metre", "12.5"], check=True, capture_output=True)
    return folder / "run"


W2M = [sys.executable, "-m", "world2minecraft"]


def address_of(server: dict) -> str:
    return f"127.0.0.1:{server['console']['port']}"


def build_on(server: dict, room: Path) -> list[str]:
    place = [str(value) for value in AT]
    address = address_of(server)
    return [
        *W2M,
        "build",
        str(room),
        "--blocks-per-metre",
        "12.5",
        "--rcon",
        address,
        "--at",
        *place,
    ]


@pytest.fixture(params=["1.20.1", "1.21.4"])
def server(request, node, tmp_path):  # noqa: F811
    plan = {
        "world": str(tmp_path / "server"),
        "version": request.param,
        "port": free_port(),
        "limit_s": LIMIT_S,
        "console": {
            "port": free_port(),
            "password": PASSWORD,
            "cut": CUT,
            "stall": STALL,
            "stalled": str(tmp_path / "stalled"),
        },
    }
    Path(plan["world"]).mkdir()
    (tmp_path / "plan.json").write_text(json.dumps(plan))
    command = ["node", str(HERE / "rcon.js"), str(tmp_path / "plan.json")]
    with subprocess.Popen(command, env=node, stderr=subprocess.PIPE, text=True) as process:
        try:
            wait_until_it_answers(plan, process)
            yield plan
        finally:
            process.kill()


def wait_until_it_answers(plan, process) -> None:
    for _ in range(200):
        if process.poll() is not None:
            pytest.fail(process.stderr.read()[-3000:])
        try:
            console(plan).connect()
        except OSError:
            time.sleep(0.2)
        else:
            return
    pytest.fail("the server does not answer")


def console(plan) -> RconClient:
    return RconClient("127.0.0.1", plan["console"]["port"], PASSWORD, 60)


def servers_noted() -> set[str]:
    notes = (user_cache_dir() / "rcon").glob("*.json")
    return {json.loads(path.read_text())["server"] for path in notes}


def test_a_room_built_live_and_cut_off_twice_is_whole(server, room, tmp_path):
    environment = {**os.environ, "W2M_RCON_PASSWORD": PASSWORD}
    command = build_on(server, room)
    with subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL) as first:
        while not Path(server["console"]["stalled"]).is_file():
            assert first.poll() is None, "the builder ended before it could be cut off"
            time.sleep(0.05)
        first.send_signal(signal.SIGKILL)
    assert address_of(server) in servers_noted()
    second = subprocess.run(
        command, env=environment, check=False, capture_output=True, text=True, timeout=LIMIT_S
    )
    assert second.returncode == 0, second.stderr
    assert "goes on" in second.stdout
    assert address_of(server) not in servers_noted()

    volume = read_world(room / "build" / "world")
    assert (volume.states > 0).sum() >= LEAST_BLOCKS
    low = np.array([AT[0], AT[1] + volume.corner[1] - 64, AT[2]])  # Its least x and z, its floor.
    high = low + volume.states.shape - 1
    ends = " ".join(str(value) for value in [*low.tolist(), *high.tolist()])
    with console(server) as client:
        assert client.command(f"dump {ends} {tmp_path / 'states.json'}") == "dumped"
    found = np.array(json.loads((tmp_path / "states.json").read_text()))
    wanted = np.array(volume.palette)[volume.states].ravel()
    # Barriers can hold water since 1.20.2: what an older game has no word for is the default.
    found = np.where(found == "minecraft:barrier[waterlogged=false]", "minecraft:barrier", found)
    differing = np.flatnonzero(found != wanted)
    assert not len(differing), [(wanted[i], found[i]) for i in differing[:5]]
