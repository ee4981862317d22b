"""A hostile page in the same browser, where the user's own tab is open: it learns nothing."""

import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest

# Everything that a page can try on another address; each ends with a word.
TRIES = """
async url => {
  const late = new Promise(resolve => setTimeout(() => resolve("late"), 5000));
  const read = fetch(url + "api/scene", {credentials: "include"}).then(r => r.text(), () => "shut");
  const blind = fetch(url + "api/undo", {method: "POST", mode: "no-cors", credentials: "include",
    headers: {"Content-Type": "text/plain"}, body: "{}"}).then(r => r.type, () => "shut");
  const live = new Promise(resolve => {
    const socket = new WebSocket(url.replace("http", "ws") + "api/live");
    socket.onmessage = event => resolve(event.data);
    socket.onerror = () => resolve("shut");
  });
  const framed = new Promise(resolve => {
    const frame = document.createElement("iframe");
    frame.onload = () => {
      try { resolve(frame.contentDocument ? "blank" : "shut"); } catch { resolve("shut"); }
    };
    frame.src = url;
    document.body.append(frame);
  });
  const script = new Promise(resolve => {
    const tag = document.createElement("script");
    tag.onload = () => resolve("ran");
    tag.onerror = () => resolve("shut");
    tag.src = url + "index.js";
    document.body.append(tag);
  });
  const tries = {read, blind, live, framed, script};
  const ends = Object.entries(tries).map(async ([k, v]) => [k, await Promise.race([v, late])]);
  return Object.fromEntries(await Promise.all(ends));
}
"""


class Page(BaseHTTPRequestHandler):
    def do_GET(self):
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(b"<!doctype html><body>hello")

    def log_message(self, *_):
        pass


@pytest.fixture
def elsewhere():
    """Another server on this machine: to cookies it is the same site."""
    with ThreadingHTTPServer(("127.0.0.1", 0), Page) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()


def test_a_page_of_another_server_neither_reads_nor_edits(browser, server, elsewhere):
    server.session.document.do("fill_box", low=(9, 9, 9), high=(9, 9, 9), class_id=11)
    context = browser.new_context()
    own = context.new_page()
    own.goto(server.link)
    assert own.url == server.url, "the token has left the address bar"
    assert own.evaluate("document.cookie") == ""
    hostile = context.new_page()
    hostile.goto(elsewhere)
    assert hostile.evaluate(TRIES, server.url) == {
        "read": "shut", "blind": "shut", "live": "shut", "framed": "shut", "script": "shut",
    }  # fmt: skip
    assert server.session.rev == 1, "the blind undo was refused"
    assert own.evaluate("fetch('api/scene').then(r => r.status)") == 200
    context.close()
