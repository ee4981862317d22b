"""The phone page's listener: who is refused, what it serves, and what it does not."""

import json
import ssl
import subprocess

import httpx
import pytest
from forge_serving import bearer, client, raw, served
from phone_serving import ONE, announced, paired, phone_browser, phone_served

from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.sceneforge.phone_access import MAX_WRONG
from world2minecraft.sceneforge.phone_captures import MAX_CAPTURES, MAX_PHOTOS
from world2minecraft.sceneforge.server.app import build_app
from world2minecraft.sceneforge.server.phone_guard import PUBLIC, SCAN_AGAIN
from world2minecraft.sceneforge.server.phone_routes import MAX_BODY_BYTES


@pytest.fixture
def server(tmp_path):
    with phone_served(tmp_path / "home") as server:
        yield server


@pytest.fixture
def phone(server):
    with paired(server) as phone:
        yield phone


def test_a_code_is_exchanged_once_for_a_cookie(server):
    token = server.phone.access.link.partition("#")[2]
    with phone_browser(server) as first, phone_browser(server) as second:
        answer = first.post("/api/phone/pair", json={"token": token})
        cookie = answer.headers["set-cookie"]
        assert cookie.startswith(f"w2m_phone_{server.phone.port}=") and token not in cookie
        assert "HttpOnly" in cookie and "SameSite=strict" in cookie and "Secure" not in cookie
        assert first.get("/api/phone").status_code == 200
        again = second.post("/api/phone/pair", json={"token": token})
        assert again.status_code == 403 and "set-cookie" not in again.headers
        assert second.get("/api/phone").status_code == 401


@pytest.mark.parametrize("token", ["", "wrong", None, 5, ["x"], {"a": 1}])
def test_wrong_tokens_set_no_cookie(server, token):
    with phone_browser(server) as phone:
        answer = phone.post("/api/phone/pair", json={"token": token})
        assert answer.status_code == 403 and "set-cookie" not in answer.headers
        assert "used or too old" in answer.json()["error"]
    assert server.phone.access.link, "the code still lets its phone in"


def test_the_sixth_wrong_token_must_wait(server):
    token = server.phone.access.link.partition("#")[2]
    with phone_browser(server) as phone:
        for _ in range(MAX_WRONG):
            assert phone.post("/api/phone/pair", json={"token": "x"}).status_code == 403
        answer = phone.post("/api/phone/pair", json={"token": token})
        assert answer.status_code == 429 and answer.headers["retry-after"] == "60"


def test_a_preview_of_the_link_does_not_use_it_up(server):
    assert httpx.get(server.phone.access.link).status_code == 200
    assert httpx.head(server.phone.access.link).status_code == 200
    assert server.phone.access.link


FOREIGN = [
    {"Host": "evil.example"},
    {"Host": "localhost:PORT"},  # Another name of the same machine.
    {"Host": "127.0.0.1"},
    {"Host": "127.0.0.1:1"},
    {"Host": "192.168.1.5:PORT"},
    {"Host": ""},
    {"Origin": "http://evil.example"},
    {"Origin": "null"},
    {"Origin": "https://127.0.0.1:PORT"},
    {"Origin": "http://127.0.0.1:1"},
    {"Sec-Fetch-Site": "cross-site"},
    {"Sec-Fetch-Site": "same-site"},
]


@pytest.mark.parametrize("changed", FOREIGN)
@pytest.mark.parametrize("path", ["/", "/phone.js", "/api/phone", ONE])
def test_another_site_or_host_is_refused(server, phone, changed, path):
    headers = {
        name: value.replace("PORT", str(server.phone.port)) for name, value in changed.items()
    }
    assert phone.get(path, headers=headers).status_code in (400, 403)


@pytest.mark.parametrize("path", ["/api/phone/pair", ONE, f"{ONE}/x/build"])
def test_what_changes_something_says_that_the_page_asks(server, phone, path):
    del phone.headers["Origin"]
    answer = phone.post(path, json={"token": "x"})
    assert answer.status_code == 403 and "outside the phone page" in answer.json()["error"]


def test_a_phone_that_sends_without_a_session_is_told_so(server):
    with phone_browser(server) as stranger:
        for _ in range(5):  # An answer, and never a reset.
            answer = stranger.put(f"{ONE}/x/files/0?at=0", content=bytes(1 << 20))
            assert answer.status_code == 401 and answer.json() == {"error": SCAN_AGAIN}


def test_two_hosts_are_none(server):
    host = f"127.0.0.1:{server.phone.port}"
    asked = f"GET / HTTP/1.1\r\nHost: {host}\r\nHost: evil.example\r\n\r\n".encode()
    assert int(raw(server.phone, asked).split(b" ", 2)[1]) in (400, 403)


def editor_paths() -> list[str]:
    """Every path of the editor, with names in place of its parts."""
    app = build_app(None, token="t", port=1)  # type: ignore[arg-type]
    paths = [getattr(route, "path", "") for route in app.routes]
    named = [path.replace("{id}", "x").replace("{name}", "floaters") for path in paths]
    assert len(named) > 30
    return [
        *{path.split("{")[0] for path in named if path},
        "/index.html",
        "/index.js",
        "/share.js",
    ]


def test_no_route_of_the_editor_is_there(server, phone):
    with phone_browser(server) as stranger:
        for path in editor_paths():
            for method in ("GET", "POST") if path not in PUBLIC else ():
                assert phone.request(method, path).status_code == 404, path
                assert stranger.request(method, path).status_code == 401, path


def test_the_editor_is_no_phone_page_and_knows_no_cookie_of_it(server, phone):
    cookie = "; ".join(f"{one.name}={one.value}" for one in phone.cookies.jar)
    for headers in ({"Cookie": cookie}, {"Cookie": cookie.replace("phone", "forge")}):
        assert httpx.get(f"{server.url}api/scene", headers=headers).status_code == 403
    assert client(server).get("/api/phone").status_code == 404
    asked = httpx.get(f"{server.phone.url}api/phone", headers=bearer(server))
    assert asked.status_code == 401 and asked.json() == {"error": SCAN_AGAIN}


def test_there_is_no_websocket(server, phone):
    lines = [
        "GET /api/live HTTP/1.1", f"Host: 127.0.0.1:{server.phone.port}", "Connection: Upgrade",
        "Upgrade: websocket", "Sec-WebSocket-Version: 13",
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==", "", "",
    ]  # fmt: skip
    assert b" 403 " in raw(server.phone, "\r\n".join(lines).encode()).split(b"\r\n")[0]


def test_no_page_is_kept_or_framed(server):
    for path in ("", "phone.js", "api/phone"):
        headers = httpx.get(server.phone.url + path).headers
        assert headers["x-frame-options"] == "DENY" and headers["cache-control"] in (
            "no-store",
            "no-cache",
        )
        assert "default-src 'self'" in headers["content-security-policy"]


@pytest.mark.parametrize(
    ("path", "why"),
    [
        ("../x.jpg", "invalid file name"),
        ("/etc/x.jpg", "invalid file name"),
        ("C:\\x.jpg", "invalid file name"),
        ("..\\x.jpg", "invalid file name"),
        ("a\0.jpg", "invalid file name"),
        ("con.jpg", "invalid file name"),
        ("x" * 300 + ".jpg", "invalid file name"),
        ("a/b.jpg", "a phone sends no folders"),
        ("notes.pdf", "neither a photo nor a video"),
        ("room.zip", "neither a photo nor a video"),
        ("capture.json", "neither a photo nor a video"),
        ("jpg", "neither a photo nor a video"),
    ],
)
def test_other_names_never_reach_the_disk(server, phone, path, why):
    answer = announced(phone, (path, 3))
    assert answer.status_code == 400 and why in answer.json()["error"]
    assert not server.workspace.captures.folder.exists()


@pytest.mark.parametrize(
    ("files", "why"),
    [
        ([], '"files" must be a list'),
        ([("a.jpg", 0)], "is empty"),
        ([("a.jpg", -1)], "must be an integer"),
        ([("a.jpg", 5 << 20)], "the upload limit is 4 MB"),
        ([("a.jpg", 1), ("A.JPG", 1)], "occurs twice"),
        ([("a.jpg", 1), ("a.mp4", 1)], "photos alone, or one video alone"),
        ([("a.mp4", 1), ("b.mp4", 1)], "photos alone, or one video alone"),
        ([(f"{n}.jpg", 1) for n in range(MAX_PHOTOS + 1)], f"the limit is {MAX_PHOTOS}"),
    ],
)
def test_wrong_lists_are_refused(server, phone, files, why):
    answer = announced(phone, *files)
    assert answer.status_code == 400 and why in answer.json()["error"]
    assert not server.workspace.captures.folder.exists()


def test_a_phone_sends_so_many_captures_and_no_more(phone):
    for _ in range(MAX_CAPTURES):
        assert announced(phone, ("a.jpg", 1)).status_code == 200
    assert "scan a new code" in announced(phone, ("a.jpg", 1)).json()["error"]


def test_a_phone_sees_its_own_captures_alone(server, phone):
    mine = announced(phone, ("a.jpg", 3)).json()["id"]
    theirs = server.workspace.captures.create("den", [{"path": "a.jpg", "size": 3}]).id
    with paired(server) as other:
        for who, number in ((other, mine), (phone, theirs), (phone, "%2e%2e")):
            for method, path in (
                ("GET", ""), ("GET", "/room"), ("GET", "/picture"), ("POST", "/build"),
                ("POST", "/cancel"), ("PUT", "/files/0"),
            ):  # fmt: skip
                answer = who.request(method, f"{ONE}/{number}{path}")
                assert answer.status_code in (400, 404), (number, path)
                assert theirs not in answer.text
    assert phone.get(f"{ONE}/{mine}").json()["held"] == [0]


def test_more_bytes_than_were_announced_are_refused(server, phone):
    number = announced(phone, ("a.jpg", 4)).json()["id"]
    answer = phone.put(f"{ONE}/{number}/files/0?at=0", content=b"12345")
    assert answer.status_code == 400 and "exceeds the announced 4 bytes" in answer.json()["error"]
    answer = phone.put(f"{ONE}/{number}/files/1?at=0", content=b"1")
    assert answer.status_code == 400 and "file 1 not found" in answer.json()["error"]
    large = phone.put(f"{ONE}/{number}/files/0?at=0", content=bytes(MAX_BODY_BYTES + 1))
    assert large.status_code == 413


def test_a_room_is_not_built_of_half_a_capture(phone):
    number = announced(phone, ("a.jpg", 4)).json()["id"]
    assert "is incomplete" in phone.post(f"{ONE}/{number}/build").json()["error"]
    for path in ("room", "picture"):
        answer = phone.get(f"{ONE}/{number}/{path}")
        assert answer.status_code == 400 and "build the room first" in answer.json()["error"]


def test_a_room_runs_apart_from_the_phone_page(server, phone):
    number = announced(phone, ("a.jpg", 4)).json()["id"]
    folder = server.workspace.captures.named(number).folder
    (folder / "room.html").write_text("<script>1</script>")
    headers = phone.get(f"{ONE}/{number}/room").headers
    policy = headers["content-security-policy"]
    assert policy.startswith("sandbox allow-scripts") and "allow-same-origin" not in policy
    assert "default-src 'none'" in policy and headers["x-frame-options"] == "DENY"


def test_a_deleted_capture_says_what_to_do(server, phone):
    number = announced(phone, ("a.jpg", 4)).json()["id"]
    server.workspace.captures.delete(number)
    answer = phone.get(f"{ONE}/{number}")
    assert answer.status_code == 400 and "scan the room again" in answer.json()["error"]
    assert phone.get("/api/phone").json()["capture"] is None


def test_the_start_page_shows_the_code_and_makes_new_ones(server):
    with client(server) as script:
        told = script.get("/api/start").json()["phone"]
        assert told["link"] == server.phone.access.link and told["code"].startswith(
            "data:image/svg"
        )
        renewed = script.post("/api/start/phone").json()
        assert renewed["link"] != told["link"] and 590 < renewed["left_s"] <= 600
        with paired(server) as phone:
            number = announced(phone, ("a.jpg", 1)).json()["id"]
            told = script.get("/api/start/phone").json()
            assert (told["link"], told["phones"]) == ("", 1)
            assert told["captures"] == [[number, False, False, False]]
            assert script.get("/api/start").json()["captures"][0]["title"].startswith("Phone scan")


def test_without_being_asked_there_is_no_phone_page(tmp_path):
    with served(home=tmp_path / "home") as server, client(server) as script:
        assert server.phone is None and script.get("/api/start").json()["phone"] is None
        answer = script.post("/api/start/phone")
        assert answer.status_code == 400 and "w2m forge --phone" in answer.json()["error"]


@pytest.mark.parametrize("address", ["0.0.0.0", "::", "203.0.113.7"])
def test_the_phone_page_has_one_address_of_this_machine(tmp_path, address):
    with pytest.raises(UsageError, match="--host|cannot listen"):
        served_phone(tmp_path, address)


def served_phone(tmp_path, address, tls=None):
    with served(home=tmp_path / "home", phone=address, tls=tls) as server:
        return server


@pytest.fixture(scope="module")
def certificate(tmp_path_factory):
    """A certificate for loopback and its key, by the openssl of the system."""
    folder = tmp_path_factory.mktemp("tls")
    words = (
        "openssl req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=127.0.0.1 "
        "-addext subjectAltName=IP:127.0.0.1 -keyout key.pem -out cert.pem"
    )
    try:
        subprocess.run(words.split(), cwd=folder, check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("there is no openssl on this machine")
    return folder / "cert.pem", folder / "key.pem"


def test_with_a_certificate_the_page_is_encrypted(tmp_path, certificate):
    with served(home=tmp_path / "home", phone="127.0.0.1", tls=certificate) as server:
        assert server.phone.url.startswith("https://") and server.url.startswith("http://")
        token = server.phone.access.new_code().partition("#")[2]
        trust = ssl.create_default_context(cafile=str(certificate[0]))
        origin = server.phone.url.rstrip("/")
        with httpx.Client(base_url=origin, headers={"Origin": origin}, verify=trust) as phone:
            answer = phone.post("/api/phone/pair", json={"token": token})
            assert "Secure" in answer.headers["set-cookie"]
            assert phone.get("/api/phone").status_code == 200
            plain = phone.get("/api/phone", headers={"Origin": origin.replace("https", "http")})
            assert plain.status_code == 403


def test_a_certificate_that_is_none_is_refused_in_one_line(tmp_path, certificate):
    (tmp_path / "bad.pem").write_text("no certificate")
    for pair in (
        (tmp_path / "none.pem", certificate[1]),
        (tmp_path / "bad.pem", certificate[1]),
        (certificate[0], certificate[0]),
    ):
        with pytest.raises(InputError, match="--tls needs") as caught:
            served_phone(tmp_path, "127.0.0.1", pair)
        assert "\n" not in str(caught.value)


def test_json_of_the_page_is_bounded(phone):
    deep = "[" * 40 + "]" * 40
    answer = phone.post(ONE, content=json.dumps({"files": json.loads(deep)}))
    assert answer.status_code == 400 and "nested" in answer.json()["error"]
