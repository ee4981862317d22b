"""What the page says by itself: edits that were recovered, a browser that draws no 3D."""

from forge_driving import opened_page

from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.server.server_process import ForgeServer


def test_edits_that_a_crash_left_are_told_once(browser, room, tmp_path):
    editor = Editor.open(None, out=tmp_path / "room")
    editor.document.notes.append("Recovered 3 edits not saved.")
    with ForgeServer(editor, port=0) as server:
        page = browser.new_context().new_page()
        driver = opened_page(page, server.link, False)
        assert driver.page.locator(".toast", has_text="Recovered 3 edits").count() == 1
        driver.page.locator(".toast").first.wait_for(state="detached")
        editor.do("delete_objects", ids=[min(editor.draft.objects)])
        driver.idle()
        assert driver.page.locator(".toast", has_text="Recovered").count() == 0
        page.context.close()


def test_a_browser_without_webgl_is_told_what_to_do(browser, server):
    context = browser.new_context()
    context.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    page = context.new_page()
    page.goto(server.link)
    message = page.get_by_role("alert")
    message.wait_for()
    assert "WebGL 2" in message.inner_text()
    context.close()
