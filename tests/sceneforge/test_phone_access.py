"""Codes that let one phone in, the sessions of phones, and the address that they see."""

import re

import numpy as np
import pytest

from world2minecraft.core.errors import UsageError
from world2minecraft.sceneforge.phone_access import (
    CODE_LIFE_S,
    MAX_ADDRESSES,
    MAX_WRONG,
    SESSION_LIFE_S,
    WRONG_WINDOW_S,
    PhoneAccess,
    TooManyTriesError,
    WrongCodeError,
    qr_svg_uri,
    qr_text,
)
from world2minecraft.sceneforge.server.local_address import (
    choose_address,
    is_loopback,
    own_addresses,
)

URL = "http://192.168.1.5:8485/"


class Clock:
    now = 1000.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def access(clock):
    return PhoneAccess(URL, clock)


def token_of(link: str) -> str:
    base, _, token = link.partition("#")
    assert base == URL
    return token


def test_a_token_has_128_bits_and_lets_one_phone_in(access):
    token = token_of(access.new_code())
    assert re.fullmatch(r"[\w-]{22}", token)
    session = access.pair(token, "a")
    assert len(session) == 43 and access.phone(session) is access.phones[0]
    with pytest.raises(WrongCodeError, match="used or too old"):
        access.pair(token, "a")
    assert access.link == "" and access.left_s == 0


def test_without_a_code_nobody_is_let_in(access):
    for token in ("", "x", "\ud800"):
        with pytest.raises(WrongCodeError):
            access.pair(token, "a")
    assert access.phone("") is None and access.phones == []


def test_a_code_ends_after_ten_minutes(access, clock):
    token = token_of(access.new_code())
    clock.now += CODE_LIFE_S
    assert access.link == ""
    with pytest.raises(WrongCodeError):
        access.pair(token, "a")


def test_a_new_code_ends_the_one_before(access):
    old, new = (token_of(access.new_code()) for _ in range(2))
    with pytest.raises(WrongCodeError):
        access.pair(old, "a")
    assert access.phone(access.pair(new, "a"))


def test_wrong_tokens_lock_their_address_for_a_minute(access, clock):
    token = token_of(access.new_code())
    for _ in range(MAX_WRONG):
        with pytest.raises(WrongCodeError):
            access.pair("wrong", "a")
        clock.now += 1
    with pytest.raises(TooManyTriesError, match="wait a minute"):
        access.pair(token, "a")
    assert access.link.endswith(token), "the right phone still gets in from elsewhere"
    clock.now += WRONG_WINDOW_S - MAX_WRONG + 0.5
    assert access.pair(token, "a")


def test_other_addresses_are_not_locked_and_few_are_kept(access):
    token = token_of(access.new_code())
    for number in range(MAX_ADDRESSES + 50):
        with pytest.raises(WrongCodeError):
            access.pair("wrong", str(number))
    assert len(access._wrong) == MAX_ADDRESSES
    assert access.pair(token, "b")


def test_sessions_are_apart_and_end(access, clock):
    first, second = (access.pair(token_of(access.new_code()), "a") for _ in range(2))
    access.phone(first).captures.append("den")
    assert access.phone(second).captures == []
    clock.now += SESSION_LIFE_S
    assert access.phone(first) is None and access.phones == []


def test_a_code_is_drawn_dark_on_light_everywhere():
    assert qr_svg_uri(URL).startswith("data:image/svg+xml")
    lines = qr_text(URL + "#" + "x" * 22).splitlines()
    assert all(line.startswith("\x1b[38;5;231;48;5;16m") for line in lines)
    assert len(lines) <= 21 and max(map(len, lines)) < 80


HALVES = {"█": (255, 255), "▀": (255, 0), "▄": (0, 255), " ": (0, 0)}


def test_the_code_of_a_terminal_is_read_by_a_scanner():
    cv2 = pytest.importorskip("cv2")
    link = "http://192.168.100.100:65535/#" + "aB-_9" * 4 + "xy"
    lines = [re.sub(r"\x1b\[[0-9;]*m", "", line) for line in qr_text(link).splitlines()]
    halves = np.array([[HALVES[one] for one in line] for line in lines], np.uint8)
    rows = halves.transpose(0, 2, 1).reshape(2 * len(lines), -1)
    picture = np.pad(rows.repeat(8, 0).repeat(8, 1), 40, constant_values=255)
    assert cv2.QRCodeDetector().detectAndDecode(picture)[0] == link


@pytest.mark.parametrize(
    ("found", "chosen"),
    [
        (["192.168.1.5"], "192.168.1.5"),
        (["127.0.0.1", "169.254.9.9", "10.0.0.2"], "10.0.0.2"),
        (["8.8.8.8", "172.20.10.3"], "172.20.10.3"),
        (["100.64.0.9", "192.168.1.5"], "100.64.0.9"),
    ],
)
def test_the_address_is_one_of_a_local_network(found, chosen):
    assert choose_address(found) == chosen


@pytest.mark.parametrize("found", [[], ["127.0.0.1"], ["8.8.8.8"], ["0.0.0.0"], ["169.254.1.1"]])
def test_without_a_local_network_one_line_teaches(found):
    with pytest.raises(UsageError, match="--host ADDRESS"):
        choose_address(found)


def test_own_addresses_are_each_named_once():
    found = own_addresses()
    assert len(found) == len(set(found))


@pytest.mark.parametrize(
    ("host", "expected"),
    [
        ("localhost", True), ("127.0.0.1", True), ("127.1.2.3", True), ("::1", True),
        ("::ffff:127.0.0.1", True), ("::ffff:10.0.0.7", False), ("10.0.0.7", False),
        ("fe80::1", False), ("testclient", False), ("", False),
    ],
)  # fmt: skip
def test_only_loopback_addresses_are_this_machine(host, expected):
    assert is_loopback(host) is expected
