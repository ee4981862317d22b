"""Who is refused, over HTTP and websocket, by bytes as an attacker would send them."""

import json
from types import SimpleNamespace

import httpx
import pytest
from forge_serving import bearer, client, heard, raw, served, small_editor, tab
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from world2minecraft.sceneforge.server.guard import OPEN_THE_LINK, Guard, new_token

OTHER_NAME = "unknown host name; use the link that w2m forge printed"
OTHER_SITE = "requests from other sites are not allowed"
OTHER_LINK = "links from other sites are not allowed; paste the link into the address bar"


@pytest.fixture(scope="module")
def server():
    with served(small_editor()) as server:
        yield server


@pytest.fixture(scope="module")
def cookie(server):
    with httpx.Client() as browser:
        return browser.get(server.link).headers["set-cookie"].partition(";")[0]


# What a page elsewhere can make a browser send, with the cookie that the browser may add; 8484
# stands for the server's port.
FOREIGN = [
    ({"Host": "evil.example"}, OTHER_NAME),
    ({"Host": "evil.example:8484", "Origin": "http://evil.example:8484"}, OTHER_NAME),  # Rebound.
    ({"Host": "127.0.0.1.evil.example"}, OTHER_NAME),
    ({"Host": "localhost.evil.example:8484"}, OTHER_NAME),
    ({"Host": "evil@127.0.0.1:8484"}, OTHER_NAME),
    ({"Host": "127.0.0.1:8484/evil"}, OTHER_NAME),
    ({"Host": "127.0.0.1:8484, evil.example"}, OTHER_NAME),
    ({"Host": "169.254.1.1:8484"}, OTHER_NAME),
    ({"Host": "0.0.0.0:8484"}, OTHER_NAME),
    ({"Host": "[::1"}, OTHER_NAME),
    ({"Host": ""}, OTHER_NAME),
    ({"Origin": "http://evil.example"}, OTHER_SITE),
    ({"Origin": "null"}, OTHER_SITE),
    ({"Origin": "http://127.0.0.1:1"}, OTHER_SITE),  # Another program of this machine.
    ({"Origin": "http://localhost:8484"}, OTHER_SITE),  # The same server, by another name.
    ({"Origin": "http://127.0.0.1"}, OTHER_SITE),
    ({"Sec-Fetch-Site": "cross-site"}, OTHER_LINK),
    ({"Sec-Fetch-Site": "same-site"}, OTHER_LINK),
]
UNKNOWN = [
    {},
    {"Cookie": "w2m_forge_8484="},
    {"Cookie": "w2m_forge_8484=wrong"},
    {"Cookie": "w2m_forge_1=COOKIE"},
    {"Cookie": "w2m_forge_8484=TOKEN"},  # The link's token is not the cookie's.
    {"Cookie": "\x80\xff; =;;"},
    {"Authorization": "Bearer"},
    {"Authorization": "Bearer wrong"},
    {"Authorization": "Bearer COOKIE"},
    {"Authorization": "Basic TOKEN"},
    {"Authorization": "TOKEN"},
]
OWN = [
    {"Cookie": "COOKIE_PAIR"},
    {"Cookie": "a=b; COOKIE_PAIR; c=d", "Origin": "http://127.0.0.1:8484"},
    {"Cookie": "COOKIE_PAIR", "Sec-Fetch-Site": "same-origin"},
    {"Authorization": "Bearer TOKEN"},
    {"Authorization": "bearer TOKEN", "Host": "localhost:8484"},
    {"Authorization": "Bearer TOKEN", "Host": "LOCALHOST:9", "Origin": "http://localhost:9"},
    {"Authorization": "Bearer TOKEN", "Host": "[::1]:8484", "Origin": "http://[::1]:8484"},
]  # The ninth port is the near end of an SSH tunnel.


def request(server, headers, cookie="", path="/api/scene", method="GET", end="") -> bytes:
    """The bytes of a request, with the stand-ins in its headers filled in."""
    filled = {"Host": "127.0.0.1:8484", "Connection": "close"} | headers
    secret = cookie.partition("=")[2]
    lines = [f"{method} {path} HTTP/1.1"]
    for name, value in filled.items():
        told = value.replace("COOKIE_PAIR", cookie).replace("COOKIE", secret)
        told = told.replace("TOKEN", server.token).replace("8484", str(server.port))
        lines.append(f"{name}: {told}")
    return ("\r\n".join(lines) + "\r\n\r\n" + end).encode("latin-1")


UPGRADE = {
    "Connection": "Upgrade",
    "Upgrade": "websocket",
    "Sec-WebSocket-Version": "13",
    "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
}


def status(answer: bytes) -> int:
    return int(answer.split(b" ", 2)[1])


@pytest.mark.parametrize(("headers", "why"), FOREIGN)
def test_another_site_is_refused_though_it_brings_the_cookie(server, cookie, headers, why):
    answer = raw(server, request(server, {"Cookie": "COOKIE_PAIR"} | headers, cookie))
    assert status(answer) == 403
    assert json.loads(answer.partition(b"\r\n\r\n")[2]) == {"error": why}


@pytest.mark.parametrize(("headers", "why"), FOREIGN)
def test_another_site_with_the_cookie_opens_no_websocket(server, cookie, headers, why):
    asked = request(server, UPGRADE | {"Cookie": "COOKIE_PAIR"} | headers, cookie, "/api/live")
    assert status(raw(server, asked)) in (400, 403)  # 400: no Host that HTTP knows.


@pytest.mark.parametrize("headers", UNKNOWN)
def test_without_the_token_nothing_is_told(server, cookie, headers):
    answer = raw(server, request(server, headers, cookie))
    assert status(answer) == 403 and OPEN_THE_LINK.encode() in answer
    asked = request(server, UPGRADE | headers, cookie, "/api/live")
    assert status(raw(server, asked)) == 403


@pytest.mark.parametrize("headers", OWN)
def test_the_page_and_scripts_are_let_in(server, cookie, headers):
    assert status(raw(server, request(server, headers, cookie))) == 200
    asked = request(server, headers | UPGRADE, cookie, "/api/live")
    assert status(raw(server, asked, most=20)) == 101


@pytest.mark.parametrize("path", ["/", "/index.js", "/api/none", "/api/live", "/none", "//", "*"])
def test_every_path_is_behind_the_guard(server, path):
    assert status(raw(server, request(server, {}, path=path))) == 403


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS", "HEAD", "BREW"])
def test_every_method_is_behind_the_guard(server, method):
    assert status(raw(server, request(server, {}, method=method, path="/api/do"))) == 403


def test_two_hosts_are_none(server, cookie):
    asked = request(server, {"Cookie": "COOKIE_PAIR"}, cookie)
    twice = asked.replace(b"Connection", b"Host: evil.example\r\nConnection")
    assert status(raw(server, twice)) in (400, 403)


@pytest.mark.parametrize(
    "query", ["", "token=", "token=wrong", "token=TOKEN&token=wrong", "TOKEN=token", "tokens=TOKEN"]
)
def test_a_wrong_link_sets_no_cookie(server, query):
    answer = httpx.get(f"{server.url}?{query.replace('TOKEN', server.token)}")
    assert answer.status_code == 403 and "set-cookie" not in answer.headers


def test_the_link_is_for_the_page_alone(server):
    params = {"token": server.token}
    assert httpx.get(f"{server.url}api/scene", params=params).status_code == 403
    assert httpx.post(server.url, params=params).status_code == 403
    assert httpx.get(server.link, headers={"Host": "evil.example"}).status_code == 403
    assert httpx.get(server.link, headers={"Origin": "http://evil.example"}).status_code == 403


def test_tokens_are_256_bits_and_never_the_same(server, cookie):
    secrets = {new_token() for _ in range(100)}
    assert len(secrets) == 100 and all(len(one) == 43 for one in secrets)
    assert server.token not in cookie


def test_a_server_that_starts_again_knows_no_old_link(server, cookie):
    with served(small_editor()) as again:
        with pytest.raises(InvalidStatus, match="403"):
            connect(
                f"ws://127.0.0.1:{again.port}/api/live",
                additional_headers={"Cookie": cookie.replace(str(server.port), str(again.port))},
            )
        assert httpx.get(f"{again.url}?token={server.token}").status_code == 403


def test_a_refused_websocket_never_reaches_the_scene(server):
    tabs = server.session.broadcaster.count
    for headers in ({}, bearer(server) | {"Origin": "http://evil.example"}):
        with pytest.raises(InvalidStatus, match="403"):
            connect(f"ws://127.0.0.1:{server.port}/api/live", additional_headers=headers)
    assert server.session.broadcaster.count == tabs


VISIT = {"Sec-Fetch-Site": "same-site", "Sec-Fetch-Mode": "navigate", "Cookie": "COOKIE_PAIR"}


@pytest.fixture(scope="module")
def shown():
    """A server that notebooks may show in a frame, and its cookie."""
    with served(small_editor(), in_notebook=True) as server, httpx.Client() as browser:
        yield server, browser.get(server.link).headers["set-cookie"].partition(";")[0]


def test_a_notebook_of_this_machine_shows_the_page(shown, server, cookie):
    assert status(raw(shown[0], request(shown[0], VISIT, shown[1], path="/"))) == 200
    assert status(raw(server, request(server, VISIT, cookie, path="/"))) == 403
    headers = httpx.get(shown[0].url).headers
    allowed = "frame-ancestors http://localhost:* http://127.0.0.1:*"
    assert headers["content-security-policy"].endswith(allowed)
    assert "x-frame-options" not in headers
    headers = httpx.get(server.url).headers
    assert headers["content-security-policy"].endswith("frame-ancestors 'none'")
    assert headers["x-frame-options"] == "DENY"


@pytest.mark.parametrize(
    ("changed", "path"),
    [
        ({}, "/api/scene"),
        ({"Sec-Fetch-Mode": "cors"}, "/"),
        ({"Sec-Fetch-Mode": "no-cors"}, "/"),
        ({"Sec-Fetch-Site": "cross-site"}, "/"),
        ({"Cookie": "w2m_forge_8484=wrong"}, "/"),
        ({"Origin": "http://127.0.0.1:1"}, "/"),
    ],
)
def test_a_notebook_shows_the_page_and_nothing_else(shown, changed, path):
    asked = request(shown[0], VISIT | changed, shown[1], path)
    assert status(raw(shown[0], asked)) == 403


@pytest.mark.parametrize(("headers", "why"), FOREIGN)
def test_a_server_for_notebooks_refuses_other_sites(shown, headers, why):
    asked = request(shown[0], {"Cookie": "COOKIE_PAIR"} | headers, shown[1])
    assert status(raw(shown[0], asked)) == 403


def open_guard(**options):
    return Guard(SimpleNamespace(), token="t", port=1, **options)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("host", "is_let_in"),
    [
        ("192.168.1.5:8484", True),
        ("[fe80::1]:8484", True),
        ("den.lan", True),
        ("evil.example", False),
        ("1.2.3.4.evil.example", False),
        ("999.1.1.1", False),
    ],
)
def test_an_open_server_accepts_addresses_and_named_hosts(host, is_let_in):
    guard = open_guard(hosts=["Den.lan"], any_address=True)
    assert (guard._foreign({"host": [host]}) == "") is is_let_in


@pytest.mark.parametrize("path", [
    "/../app.py", "/%2e%2e/app.py", "/..%2fapp.py", "/..%5capp.py", "/static/../../app.py",
    "//etc/passwd", "/%2fetc/passwd", "/etc/passwd", "/index.js%00.png", "/C:/Windows/win.ini",
    "/....//....//app.py", "/" + "a" * 5000, "/%ff%fe", "/.", "/..", "/assets/",
    "/web/package.json",
])  # fmt: skip
def test_no_path_leads_out_of_the_page(server, path):
    answer = raw(server, request(server, {"Authorization": "Bearer TOKEN"}, path=path))
    assert status(answer) in (200, 400, 404, 307)
    assert b"root:" not in answer and b"def build_app" not in answer and b'"devDep' not in answer
    assert status(answer) != 200 or b"<!doctype html>" in answer


@pytest.mark.parametrize("what", ["../../../etc/passwd", "labels%00", "__class__", "draft"])
def test_a_volume_is_one_of_four(server, what):
    with client(server) as script:
        answer = script.get(f"/api/volume?what={what}")
        assert answer.status_code == 400 and "labels" in answer.json()["error"]


def test_the_scene_is_whole_after_all_this(server):
    assert server.session.rev == 0
    with tab(server) as page:
        page.send('{"type":"undo","seq":1}')
        assert heard(page)["type"] == "refused"
