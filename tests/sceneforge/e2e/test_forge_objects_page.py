"""Objects: chosen, moved, turned, added, split and merged through mouse and keys alone."""

import pytest

SOFA, TABLE = 2, 3


@pytest.fixture
def objects(forge):
    """The room from above in Objects mode."""
    forge.key("Shift+Digit3")
    forge.until("s.mode", "objects")
    forge.page.evaluate("window.__forge.view.lookAlong(2)")
    forge.idle()
    return forge


def centre(forge, number=SOFA) -> list[float]:
    return forge.state(f"s.objects.get({number}).center_m")


def chosen(forge, number=SOFA) -> None:
    forge.page.mouse.click(*forge.object_at(number))
    forge.until("s.selectedObjects", [number])


def test_a_click_selects_and_a_drag_moves_by_whole_cells(objects, shot):
    forge = objects
    chosen(forge)
    before = centre(forge)
    shot(forge, "object")
    x, y = forge.object_at(SOFA)
    forge.drag((x, y), (x - 60, y + 30), up=False)
    shot(forge, "object_dragged")
    assert centre(forge) == before, "it moved before it was let go"
    forge.page.mouse.up()
    forge.until("s.scene.rev", 1)
    steps = [(now - then) / 0.08 for now, then in zip(centre(forge), before, strict=True)]
    assert steps[0] < -1 and steps[1] < -1 and abs(steps[2]) < 1e-6
    assert all(abs(step - round(step)) < 1e-6 for step in steps)
    forge.drag(forge.object_at(SOFA), (x, y), up=False)
    forge.key("Escape")
    forge.page.mouse.up()
    assert forge.rev() == 1
    forge.key("Control+z")
    forge.until(f"s.objects.get({SOFA}).center_m", before)


def test_the_arrow_keys_move_what_g_took_hold_of(objects):
    forge = objects
    chosen(forge, TABLE)
    before = centre(forge, TABLE)
    forge.key("g", "ArrowRight", "ArrowRight", "ArrowUp", "Enter")
    forge.until("s.scene.rev", 1)
    now = centre(forge, TABLE)
    assert [round((a - b) / 0.08) for a, b in zip(now, before, strict=True)] == [2, 1, 0]
    forge.key("g", "ArrowLeft", "Escape")
    forge.until("s.tool", "navigate")
    assert forge.rev() == 1


def test_a_right_click_deletes_and_a_right_drag_turns_the_view(objects):
    forge = objects
    x, y = forge.object_at(TABLE)
    forge.drag((x, y), (x + 40, y + 40), button="right")
    forge.idle()
    assert forge.rev() == 0 and forge.page.locator(".menu").count() == 0
    forge.page.mouse.click(*forge.object_at(TABLE), button="right")
    forge.until(f"s.objects.has({TABLE})", False)
    forge.key("Control+z")
    forge.until(f"s.objects.has({TABLE})", True)


def test_turns_duplicates_and_deletes_by_keys(objects):
    forge = objects
    chosen(forge, TABLE)
    count, yaw = forge.state("s.objects.size"), forge.state(f"s.objects.get({TABLE}).yaw_deg")
    forge.key("Shift+R")
    forge.until("s.scene.rev", 1)
    turned = (forge.state(f"s.objects.get({TABLE}).yaw_deg") - yaw) % 360
    assert turned == 270
    forge.key("Control+z")
    forge.until("s.scene.rev", 2)
    chosen(forge, TABLE)
    forge.key("d")
    forge.until("s.objects.size", count + 1)
    forge.key("Delete")
    forge.until("s.objects.size", count)
    assert not forge.state(f"s.objects.has({TABLE})")


def test_objects_are_added_where_one_clicks(objects):
    forge = objects
    count = forge.state("s.objects.size")
    forge.key("2", "n")
    x, y = forge.object_at(SOFA)
    forge.page.mouse.click(x, y + 190)
    assert "Choose an object class" in forge.page.locator(".toast").last.inner_text()
    forge.key("5")
    forge.page.mouse.click(x, y + 190)
    forge.until("s.objects.size", count + 1)
    assert max(forge.state("[...s.objects.values()].map((o) => o.class_id * 1000 + o.id)")) > 5000


def test_split_merge_snap_and_match_again(objects):
    forge = objects
    count = forge.state("s.objects.size")
    chosen(forge)
    forge.key("s")
    forge.until("s.objects.size", count + 1)
    new = forge.state("Math.max(...s.objects.keys())")
    forge.page.locator(f".tree [data-object='{new}']").click(modifiers=["Shift"])
    forge.until("s.selectedObjects.size", 2)
    forge.key("m")
    forge.until("s.objects.size", count)
    forge.key("Shift+C")
    forge.key("Control+a")
    forge.until("s.selectedObjects.size", count)
    assert forge.page.locator(".panel[data-panel=inspector] strong").inner_text().startswith("1")
    forge.key("Escape")
    forge.until("s.selectedObjects.size", 0)


def test_the_inspector_changes_class_furniture_and_turn(objects, shot):
    forge, page = objects, objects.page
    chosen(forge)
    rows = page.locator(".template")
    rows.nth(1).wait_for()
    shot(forge, "inspector")
    other = rows.nth(1).get_attribute("data-template")
    # By its name: the list is made anew when all turns of all templates have been tried.
    page.locator(f".template[data-template='{other}']").first.click()
    forge.until(f"s.objects.get({SOFA}).placements[0].template", other)
    forge.page.locator("canvas.canvas").focus()
    rev = forge.rev()
    forge.key("t")
    forge.until("s.scene.rev", rev + 1)
    assert forge.state(f"s.objects.get({SOFA}).placements[0].template") != other
    now = round(forge.state(f"s.objects.get({SOFA}).yaw_deg") / 90) % 4
    page.locator(f".segment [data-turn='{(now + 2) % 4}']").click()
    forge.until(f"Math.round(s.objects.get({SOFA}).yaw_deg / 90 + 4) % 4", (now + 2) % 4)
    page.locator("select[data-field=class]").select_option("6")
    forge.until(f"s.objects.get({SOFA}).class_id", 6)


def test_clusters_are_previewed_live_and_doubtful_places_visited(objects, shot):
    forge, page = objects, objects.page
    page.locator(".panel[data-panel=recluster] .panel-title").click()
    forge.slide("density_threshold", 0.3)
    page.wait_for_selector(".centre-preview i")
    shot(forge, "recluster")
    assert forge.rev() == 0
    page.get_by_role("button", name="Detect again").click()
    forge.until("s.scene.rev", 1)
    assert page.locator(".centre-preview i").count() == 0
    forge.key("Shift+Digit1", ".")
    page.wait_for_selector("[data-doubt='0']", state="attached")
    assert forge.state("s.status") != ""
    shot(forge, "doubtful")


def test_two_tabs_stay_in_step_and_saving_writes_the_files(forge, open_tab, tmp_path):
    other = open_tab()
    forge.key("Shift+Digit3", "ArrowRight", "Shift+Digit2", "b")
    other.key("Shift+Digit3", "ArrowRight", "Delete")
    for tab in (forge, other):
        tab.until("s.scene.rev", 1)
    assert forge.state("s.objects.size") == other.state("s.objects.size")
    assert forge.state("s.mode") == "voxels", "a tab follows the mode of another"
    assert forge.state("s.scene.counts") == other.state("s.scene.counts")
    assert other.page.locator(".saved").inner_text() == "Unsaved changes"
    forge.key("Control+z")
    other.until("s.scene.rev", 2)
    assert other.page.locator(".saved").inner_text() == "Saved", "all is undone"
    forge.key("Control+Shift+z")
    for tab in (forge, other):
        tab.until("s.scene.rev", 3)
        assert tab.page.locator(".saved").inner_text() == "Unsaved changes"
    other.key("Control+s")
    forge.until("s.scene.saved", True)
    assert forge.page.locator(".saved").inner_text() == "Saved"
    assert (tmp_path / "room.npz").is_file() and (tmp_path / "centers.json").is_file()
    assert other.mistakes == []


def test_objects_are_renamed_and_found_by_name(objects, shot):
    forge, page = objects, objects.page
    chosen(forge)
    field = page.locator("input[data-field=name]")
    assert field.input_value() == forge.state(f"s.objects.get({SOFA}).title")
    field.fill("couch")
    field.press("Enter")
    forge.until(f"s.objects.get({SOFA}).name", "sofa")
    field.fill("Grandma's seat")
    field.press("Enter")
    forge.until(f"s.objects.get({SOFA}).title", "Grandma's seat")
    search, leaves = page.locator("input.tree-search"), page.locator(".tree-leaf .tree-word")
    search.fill("grandma")
    assert leaves.all_inner_texts() == [f"Grandma's seat {SOFA}"]
    shot(forge, "names")
    search.fill("nothing of this name")
    assert leaves.count() == 0
    search.fill("")
    assert leaves.count() == forge.state("s.objects.size")


def test_a_turn_shows_the_new_fit_and_what_collides(objects, shot):
    forge, page = objects, objects.page
    chosen(forge, TABLE)
    fit = page.locator(f".tree-leaf[data-object='{TABLE}'] .legend-count")
    before = fit.inner_text()
    forge.key("r")
    forge.until("s.scene.rev", 1)
    assert fit.inner_text() != before and fit.inner_text().startswith("IoU ")
    assert page.locator(".clashes").inner_text() == ""
    at = centre(forge, SOFA)
    command = {
        "op": "move_object",
        "id": TABLE,
        "to_m": [at[0] - 0.3, at[1], centre(forge, TABLE)[2]],
    }
    page.evaluate("(command) => window.__forge.connection.do(command)", command)
    mark = page.locator(f".tree-leaf[data-object='{TABLE}'] .tree-clash")
    mark.wait_for()
    assert "Collides with sofa 2" in mark.get_attribute("aria-label")
    shot(forge, "collision")
    page.locator(f".clash [data-clash='{SOFA}']").click()
    forge.until("s.selectedObjects", [SOFA])
    assert f"table {TABLE}" in page.locator(".clashes").inner_text()
    forge.key("Control+z")
    mark.wait_for(state="detached")
