"""The window itself: what is seen first, keys, help, palette, legend, looking around."""

from world2minecraft.core.classes import CLASS_DISPLAY_NAMES


def test_the_demo_room_is_in_view_with_three_hints(open_tab, shot):
    forge = open_tab(hints=True)
    shot(forge, "first")
    assert forge.page.title() == "Demo room · SceneForge"
    assert forge.state("s.view.hidden") == [1]
    assert forge.page.locator(".hints li").count() == 3
    for corner in ([0, 0, 0], [1, 1, 0], [0, 1, 1], [1, 0, 1]):
        share = [f"s.scene.origin_m[{i}]+{corner[i]}*s.scene.shape[{i}]*0.08" for i in range(3)]
        x, y = forge.point_at(forge.state(f"[{','.join(share)}]"))
        assert 244 < x < 992 and 44 < y < 734, "a corner of the room is not in view"
    forge.page.get_by_label("Dismiss").click()
    forge.page.reload()
    forge.page.wait_for_selector(".legend-row")
    assert forge.page.locator(".hints").count() == 0
    assert forge.mistakes == []


def test_drag_turns_wheel_comes_closer_and_keys_look_along_axes(forge):
    page = forge.page
    orbit = "window.__forge.view.orbit"
    before = page.evaluate(orbit)
    forge.drag((620, 600), (700, 560))
    forge.idle()
    turned = page.evaluate(orbit)
    assert turned["azimuth"] != before["azimuth"] and turned["distance"] == before["distance"]
    page.mouse.move(620, 400)
    page.mouse.wheel(0, -240)
    forge.idle()
    assert page.evaluate(orbit)["distance"] < turned["distance"]
    page.keyboard.down("Shift")
    forge.drag((620, 600), (700, 600))
    page.keyboard.up("Shift")
    forge.idle()
    assert page.evaluate(orbit)["target"] != turned["target"]
    forge.key("Numpad7")
    forge.idle()
    assert page.evaluate(orbit)["elevation"] > 1.5
    forge.key("Numpad5")
    assert page.evaluate(orbit)["ortho"] is True
    forge.key("Numpad1", "Shift+F")
    forge.idle()
    before = page.evaluate(orbit)
    forge.key("Control+ArrowLeft", "Control+ArrowUp", "Shift+PageUp")
    forge.idle()
    after = page.evaluate(orbit)
    assert all(before[part] != after[part] for part in ("azimuth", "elevation", "distance"))


def test_the_legend_hides_shows_alone_locks_and_chooses(forge, shot):
    page = forge.page
    sofa = page.locator(".legend-row[data-class='7']")
    assert sofa.locator(".legend-count").inner_text() == f"{forge.state('s.scene.counts[7]'):,}"
    eye = sofa.locator(".mini").nth(2)
    eye.click()
    forge.until("s.view.hidden.has(7)")
    assert eye.get_attribute("aria-pressed") == "false"
    eye.click()
    eye.click(modifiers=["Alt"])
    forge.until("s.view.solo", 7)
    shot(forge, "solo")
    eye.click(modifiers=["Alt"])
    forge.until("s.view.solo", None)
    sofa.hover()
    sofa.locator(".mini").nth(1).click()
    forge.until("s.view.locked.has(7)")
    forge.mode("voxels")
    for key, number in {"8": 8, "0": 10, "-": 11, "=": 0, "1": 1}.items():
        forge.key(key)
        forge.until("s.options.classId", number)
    sofa.locator(".legend-name").click()
    forge.until("s.options.classId", 7)


def test_whole_classes_are_relabelled_and_deleted_by_their_menu(forge):
    page = forge.page
    counts = forge.state("s.scene.counts")
    row = page.locator(".legend-row[data-class='8']")
    row.hover()
    row.locator(".mini").nth(0).click()
    page.get_by_role("menuitem", name="Change class…").click()
    page.get_by_role("menuitem", name="furniture").click()
    forge.until("s.scene.counts[8]", 0)
    assert forge.state("s.scene.counts[10]") == counts[10] + counts[8]
    forge.key("Control+z")
    forge.until("s.scene.counts[8]", counts[8])
    row.hover()
    row.locator(".mini").nth(0).click()
    page.get_by_role("menuitem", name="Delete all cells of class table").click()
    forge.until("s.scene.counts[8]", 0)
    row.locator(".mini").nth(0).click()
    gone = page.get_by_role("menuitem", name="Delete all cells of class table")
    assert gone.get_attribute("aria-description") == "No cells of class table"
    forge.key("Escape")
    assert page.locator(".menu").count() == 0


def test_the_menu_of_a_class_merges_matches_and_detects_again(forge):
    """The room has three televisions: a screen and two cushions."""
    page = forge.page
    tvs = "[...s.objects.values()].filter((one) => one.class_id === 9).length"
    before = forge.state(tvs)
    assert before == 3

    def choose(label: str, rev: int) -> None:
        row = page.locator(".legend-row[data-class='9']")
        row.hover()
        row.locator(".mini").nth(0).click()
        page.get_by_role("menuitem", name=label).click()
        forge.until("s.scene.rev", rev)

    choose("Merge all objects into one", 1)
    assert forge.state(tvs) == 1
    choose("Detect objects again", 2)
    assert forge.state(tvs) > 1
    forge.key("Control+z", "Control+z")
    forge.until("s.scene.rev", 4)
    assert forge.state(tvs) == before
    choose("Split each object in two", 5)
    assert forge.state(tvs) == 2 * before
    choose("Match templates again", 6)
    assert forge.state("s.scene.undo") == "rematch"


def test_help_and_palette_are_made_of_the_one_table(forge, shot):
    page = forge.page
    forge.key("?")
    shot(forge, "help")
    assert page.locator(".help").is_visible()
    words = page.locator(".help").inner_text()
    for name in CLASS_DISPLAY_NAMES:
        assert f"Set the current class: {name}" in words
    assert "Ctrl+Shift+Z" in words and "Next issue" in words
    forge.key("Escape")
    assert not page.locator(".help").is_visible()
    forge.key("Control+k")
    page.keyboard.type("measure")
    shot(forge, "palette")
    forge.key("Enter")
    forge.until("s.tool", "measure")
    forge.key("Control+k")
    page.keyboard.type("undo")
    row = page.locator(".palette-row[data-action='undo']")
    assert row.get_attribute("aria-disabled") == "true"
    assert "Nothing to undo" in row.inner_text()


def test_the_palette_offers_nothing_that_would_do_nothing(forge):
    page = forge.page

    def reasons(mode: str) -> dict[str, str | None]:
        page.locator(f".mode-tab[data-action='mode.{mode}']").click()
        forge.key("Control+k")
        rows = page.locator(".palette-row").all()
        told = {
            row.get_attribute("data-action"): row.locator(".palette-group").inner_text()
            if row.get_attribute("aria-disabled")
            else None
            for row in rows
        }
        forge.key("Escape")
        marks = [why is not None for why in told.values()]
        assert marks == sorted(marks), "what can be done does not come first"
        return told

    inspecting, painting = reasons("inspect"), reasons("voxels")
    assert inspecting["cursor.right"] == inspecting["tool.brush"] == "Only in Voxels"
    assert inspecting["mode.inspect"] == inspecting["tool.navigate"] == "Chosen already"
    assert inspecting["class.5"] == "Only in Voxels, Objects"
    assert painting["tool.brush"] is painting["mode.inspect"] is None
    assert painting["select.none"] == "Nothing selected" and painting["view.unhide"] is None
    forge.key("Control+k")
    page.keyboard.type("next object")
    forge.key("Enter")
    assert "Only in Objects" in page.locator(".toast").last.inner_text()
    assert not forge.state("s.selectedObjects.size")
    assert reasons("walk")["view.top"] == "Not in Walk"


def test_what_cannot_be_done_says_why(forge):
    page = forge.page
    undo = forge.action("undo")
    assert undo.get_attribute("aria-disabled") == "true"
    assert undo.get_attribute("aria-description") == "Nothing to undo"
    assert "Nothing to undo" in undo.get_attribute("title")
    undo.click(force=True)  # Playwright itself clicks nothing that is disabled.
    assert "Nothing to undo" in page.locator(".toast").inner_text()
    forge.mode("objects")
    assert forge.action("object.merge").get_attribute("aria-description") == "No object selected"


def test_the_keyboard_alone_reaches_and_does_everything(forge):
    page = forge.page
    forge.key("Shift+Digit3")
    forge.until("s.mode", "objects")
    forge.key("ArrowRight")
    forge.until("s.selectedObjects.size", 1)
    forge.key("Tab")
    stops = set()
    for _ in range(60):
        stops.add(
            page.evaluate(
                "(() => { const a = document.activeElement; return a.closest('.mode-tabs, .rail,"
                " .legend, .tree, .corner, .side.right, .top-page, .canvas')?.className ?? ''; })()"
            )
        )
        forge.key("Tab")
    wanted = ("mode-tabs", "rail", "legend", "tree", "corner", "side right", "top-page", "canvas")
    for place in wanted:
        assert any(place in stop for stop in stops), f"Tab does not reach {place}: {stops}"
    page.locator("[role=tab][aria-selected=true]").focus()
    forge.key("ArrowLeft")
    assert page.evaluate("document.activeElement.dataset.action") == "mode.voxels"
    forge.key("Enter")
    forge.until("s.mode", "voxels")
    page.locator("canvas.canvas").focus()
    forge.key("0", "ArrowRight")  # The class furn, and the cell cursor.
    for _ in range(40):
        if forge.state("s.status").endswith(": empty"):
            break
        forge.key("Alt+ArrowUp")
    first = forge.state("s.status")
    forge.key("ArrowRight", "ArrowUp", "ArrowLeft", "ArrowDown")
    assert forge.state("s.status") == first, "four steps lead around to where one was"
    assert page.locator("[data-status='said']").inner_text() == first
    furn = forge.state("s.scene.counts[10]")
    forge.key("Space")
    forge.until("s.scene.rev", 1)
    assert forge.state("s.scene.counts[10]") == furn + 1
    forge.until("s.status", first.replace("empty", "furniture"))
    forge.key("Shift+Space")
    forge.until("s.scene.rev", 2)
    forge.until("s.status", first)


def test_theme_and_a_narrow_window(open_tab, shot):
    forge = open_tab(width=1024, height=700)
    for mode in ("inspect", "voxels", "objects"):
        forge.mode(mode)
        overflow = forge.page.evaluate("document.documentElement.scrollWidth > innerWidth")
        assert not overflow
        for bar in forge.page.locator(".top, .side, .status").all():
            assert forge.page.evaluate("e => e.scrollWidth <= e.clientWidth", bar.element_handle())
    shot(forge, "narrow")
    forge.action("theme").click()
    forge.until("s.theme", "light")
    shot(forge, "light")
    assert forge.page.evaluate("document.documentElement.dataset.theme") == "light"
    assert forge.mistakes == []


def test_a_room_that_is_read_only_says_so_and_lets_one_look(open_tab, server):
    server.session.document.document.read_only = "another SceneForge has it open"
    forge = open_tab()
    assert forge.page.locator(".saved").inner_text() == "Read-only"
    forge.key("Shift+Digit3", "ArrowRight")
    forge.until("s.selectedObjects.size", 1)
    why = "Read-only: another SceneForge has it open"
    for name in ("object.turn", "delete", "save", "tool.add"):
        assert forge.action(name).get_attribute("aria-description") == why
    forge.key("Delete")
    assert why in forge.page.locator(".toast").last.inner_text()
    assert forge.rev() == 0


def test_a_lost_server_is_told_and_nothing_can_be_changed(forge, server):
    server.stop()
    forge.until("s.online", False)
    assert forge.page.locator(".saved").inner_text() == "Disconnected"
    forge.key("Shift+Digit3", "ArrowRight")
    forge.until("s.selectedObjects.size", 1)
    assert "connection" in forge.action("object.turn").get_attribute("aria-description")
    forge.mistakes.clear()  # The browser itself reports that it cannot connect.


def test_a_narrow_window_has_the_scene_above_its_panels(open_tab):
    forge = open_tab(width=390, height=844)
    page = forge.page
    sides = "[document.querySelector('.stage').clientWidth, document.documentElement.scrollWidth]"
    assert page.evaluate(sides) == [390, 390]
    for mode in ("build", "objects"):
        forge.mode(mode)  # A click on each tab: none lies under another control.
    page.get_by_role("treeitem").last.click()
    assert forge.state("s.selectedObjects.size") in (0, 1)
    forge.key("?")
    bar, sheet = (page.locator(one).bounding_box() for one in (".top", ".sheet.help"))
    assert sheet["y"] >= bar["y"] + bar["height"]
