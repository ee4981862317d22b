"""``w2m build --rcon``: what is checked before any work, and what is told."""

import numpy as np
import pytest

from world2minecraft.cli import run
from world2minecraft.core.errors import UsageError
from world2minecraft.minecraft.server.rcon import parse_address


@pytest.mark.parametrize(
    ("text", "address"),
    [
        ("localhost", ("localhost", 25575)),
        ("10.0.0.3:25600", ("10.0.0.3", 25600)),
        ("[::1]:25575", ("::1", 25575)),
    ],
)
def test_addresses(text, address):
    assert parse_address(text) == address


@pytest.mark.parametrize("text", ["", ":25575", "a b:1", "host:0", "host:99999", "host:1:2"])
def test_no_addresses(text):
    with pytest.raises(UsageError, match="the server must be HOST:PORT"):
        parse_address(text)


def test_the_password_comes_from_the_environment_alone(tmp_path, monkeypatch, capsys):
    monkeypatch.delenv("W2M_RCON_PASSWORD", raising=False)
    np.save(tmp_path / "room.npy", np.zeros((2, 2, 2), np.uint8))
    assert run(["build", str(tmp_path / "room.npy"), "--rcon", "localhost"]) == 2
    assert capsys.readouterr().err.strip() == (
        "error: --rcon requires a password; set the environment variable W2M_RCON_PASSWORD to "
        "the value of rcon.password in server.properties"
    )
