"""A link is opened beside the verb that printed it, and never in its terminal."""

import threading
import webbrowser

import pytest

from world2minecraft.cli.browser import open_link


class Slow:
    name = "firefox"


@pytest.mark.parametrize(("name", "opened"), [("/usr/bin/w3m", False), ("firefox", True)])
def test_a_browser_of_the_terminal_is_left_alone(name, opened, monkeypatch):
    seen, is_opened = [], threading.Event()
    browser = Slow()
    browser.name = name
    monkeypatch.setattr(webbrowser, "get", lambda: browser)
    monkeypatch.setattr(webbrowser, "open", lambda link: (seen.append(link), is_opened.set()))
    open_link("http://127.0.0.1:1/")
    assert is_opened.wait(20 if opened else 0.1) == opened
    assert seen == ["http://127.0.0.1:1/"] * opened


def test_a_browser_that_waits_for_its_end_holds_nobody_up(monkeypatch):
    ended, begun = threading.Event(), threading.Event()

    def waiting(link):
        begun.set()
        ended.wait(20)

    monkeypatch.setattr(webbrowser, "open", waiting)
    monkeypatch.setattr(webbrowser, "get", Slow)
    open_link("http://127.0.0.1:1/")
    assert begun.wait(20)
    ended.set()
