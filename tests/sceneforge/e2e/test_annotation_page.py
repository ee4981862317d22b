"""The annotation page in a browser: a walk is looked at, told on three levels, and kept."""

import json
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
from test_forge_annotation import a_set

from world2minecraft.sceneforge.annotation.app import annotation_server
from world2minecraft.sceneforge.annotation.store import AnnotationStore

WRONG = "Go to the sofa over there."
TEXTS = ("Go to the piano over there.", "Walk on, then turn left.", "On to the piano, at its left.")


@pytest.mark.parametrize("size", [(1400, 860), (390, 844)])
def test_a_walk_is_told_on_three_levels(browser, tmp_path, size):
    from playwright.sync_api import expect  # It is there where the browser is.

    context = browser.new_context(viewport=dict(zip(("width", "height"), size, strict=True)))
    page, failures = context.new_page(), []
    page.on("pageerror", lambda error: failures.append(str(error)))
    with annotation_server(AnnotationStore(a_set(tmp_path)), 0) as server:
        page.goto(server.link)
        page.wait_for_selector("#strip img")
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        page.fill("#annotator", "Ada")
        page.fill("#text", WRONG)
        page.wait_for_selector("#findings .wrong")
        assert page.is_disabled("#keep")
        for text in TEXTS:
            page.fill("#text", text)
            page.wait_for_selector("#keep:enabled")
            page.click("#keep")
            expect(page.locator("#text")).to_have_value("")
        page.wait_for_selector("#walks li:nth-child(2) [aria-current=true]")  # The next walk.
    context.close()
    lines = [json.loads(one) for one in (tmp_path / "annotations.jsonl").read_text().splitlines()]
    assert [one["instruction"] for one in lines] == list(TEXTS)
    assert [one["level"] for one in lines] == ["goal", "route", "landmark"]
    assert {one["trajectory_id"] for one in lines} == {"t0"} and not failures
