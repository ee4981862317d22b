"""Voxels: strokes, selections, clean-up; each gesture is one operation that undo takes back."""

import pytest


@pytest.fixture
def voxels(forge):
    """The sofa seen from above, in Voxels mode, the ceiling hidden."""
    forge.mode("voxels")
    forge.page.evaluate(
        "(() => { const f = window.__forge; f.view.lookAlong(2); const b ="
        " f.store.get().objects.get(2); const half = [0, 1, 2].map((i) => b.size_m[i]);"
        " f.view.focus({ low: b.center_m.map((c, i) => c - half[i]),"
        " high: b.center_m.map((c, i) => c + half[i]) }); })()"
    )
    forge.idle()
    return forge


def counts(forge) -> list[int]:
    return forge.state("s.scene.counts")


def test_a_stroke_is_one_operation_and_escape_cancels_it(voxels, shot):
    forge, before = voxels, counts(voxels)
    x, y = forge.object_at(2)
    forge.key("b", "8")
    forge.drag((x - 40, y), (x + 40, y), up=False)
    shot(forge, "brush")
    assert counts(forge) == before, "a stroke changed the room before it ended"
    forge.key("Escape")
    forge.page.mouse.up()
    assert forge.rev() == 0
    forge.drag((x - 40, y), (x + 40, y))
    forge.until("s.scene.rev", 1)
    after = counts(forge)
    assert after[8] > before[8] and after[7] == before[7], "Add paints empty cells only"
    forge.page.wait_for_selector("[data-action=undo][title^='Undo paint']")
    forge.key("Control+z")
    forge.until("s.scene.counts[8]", before[8])
    forge.key("Control+Shift+z")
    forge.until("s.scene.counts[8]", after[8])


def test_repainting_erasing_and_locks(voxels):
    forge, before = voxels, counts(voxels)
    x, y = forge.object_at(2)
    forge.key("b", "0")
    forge.page.get_by_role("button", name="Replace").click()
    forge.drag((x - 30, y), (x + 30, y))
    forge.until("s.scene.rev", 1)
    painted = counts(forge)
    assert painted[7] < before[7] and sum(painted[1:]) == sum(before[1:])
    forge.key("Shift+B")
    forge.drag((x - 30, y), (x + 30, y))
    forge.until("s.scene.rev", 2)
    assert sum(counts(forge)[1:]) < sum(before[1:])
    for row in forge.page.locator(".legend-row").all()[:-1]:
        row.hover()
        row.locator(".mini").nth(1).click()
    forge.drag((x - 30, y + 20), (x + 30, y + 20))
    forge.idle()
    assert forge.rev() == 2, "a locked class was erased"


def test_the_brush_has_shapes_and_sizes(voxels, shot):
    forge = voxels
    x, y = forge.object_at(2)
    forge.key("b", "[", "[", "[")
    forge.until("s.options.size", 1)
    forge.key("]", "]", "]")
    forge.until("s.options.size", 4)
    forge.page.mouse.move(x, y)
    forge.page.keyboard.down("Control")
    forge.page.mouse.wheel(0, -120)
    forge.page.keyboard.up("Control")
    forge.until("s.options.size", 5)
    forge.key("Shift+X")
    forge.until("s.options.shape", "cube")
    forge.page.get_by_role("button", name="One cell").click()
    forge.until("s.options.shape", "single")
    forge.page.mouse.click(x, y)
    forge.until("s.scene.rev", 1)


def test_box_lasso_and_flood_selection_with_all_modes(voxels, shot):
    forge, page = voxels, voxels.page
    x, y = forge.object_at(2)
    size = "s.selectedCells.size"
    forge.key("x")
    forge.drag((x - 40, y - 40), (x + 40, y + 40))
    surface = forge.state(size)
    assert surface > 0
    shot(forge, "box")
    page.locator("input[data-field='surface']").uncheck()
    forge.drag((x - 40, y - 40), (x + 40, y + 40))
    through = forge.state(size)
    assert through > surface, "the depth limit changes nothing"
    forge.slide("depth", 2)
    forge.drag((x - 40, y - 40), (x + 40, y + 40))
    assert surface < forge.state(size) < through
    forge.key("u")
    forge.until("s.options.surfaceOnly", True)
    forge.drag((x - 40, y - 40), (x + 40, y + 40))
    page.keyboard.down("Control")
    forge.drag((x - 40, y - 40), (x, y + 40))
    page.keyboard.up("Control")
    half = forge.state(size)
    assert 0 < half < surface
    page.keyboard.down("Shift")
    forge.drag((x - 40, y - 40), (x + 40, y + 40))
    page.keyboard.up("Shift")
    assert forge.state(size) == surface
    forge.key("Alt+z")
    forge.until(size, half)
    forge.key("Alt+Shift+Z")
    forge.until(size, surface)
    forge.key("k")
    page.keyboard.down("Shift")
    page.keyboard.down("Control")
    page.mouse.click(x, y)
    page.keyboard.up("Control")
    page.keyboard.up("Shift")
    assert 0 < forge.state(size) <= surface
    forge.key("l", "Escape", "Escape", "l")
    page.mouse.move(x - 60, y - 60)
    page.mouse.down()
    for dx, dy in ((60, -60), (60, 60), (-60, 60), (-60, -50)):
        page.mouse.move(x + dx, y + dy, steps=4)
    shot(forge, "lasso")
    page.mouse.up()
    assert forge.state(size) > surface


def test_selected_cells_are_relabelled_filled_and_deleted(voxels, shot):
    forge, before = voxels, counts(voxels)
    x, y = forge.object_at(2)
    forge.key("k")
    forge.page.mouse.click(x, y)
    forge.until("s.selectedCells.size", before[7])
    shot(forge, "flood")
    forge.key("6", "Enter")
    forge.until("s.scene.counts[6]", before[7])
    forge.key("Shift+Enter")
    forge.until("s.scene.rev", 2)
    assert counts(forge)[6] > before[7]
    forge.key("Delete")
    forge.until("s.scene.rev", 3)
    assert forge.state("s.selectedCells.size") == 0
    forge.key("Control+z", "Control+z", "Control+z")
    forge.until("s.scene.rev", 6)
    assert counts(forge) == before
    forge.key("Control+a")
    assert forge.state("s.selectedCells.size") == sum(before[2:])
    forge.key("Control+i")
    assert forge.state("s.selectedCells.size") == 0


def test_copied_cells_are_mirrored_moved_and_set_down(voxels, shot):
    forge, before = voxels, counts(voxels)
    x, y = forge.object_at(2)
    forge.key("k")
    forge.page.mouse.click(x, y)
    forge.until("s.selectedCells.size", before[7])
    forge.key("Control+c", "Control+v")
    forge.page.mouse.move(x, y + 60)
    forge.page.mouse.move(x, y + 62)
    forge.key("x", "ArrowUp", "PageUp")
    shot(forge, "paste")
    forge.key("Escape")
    assert forge.rev() == 0
    forge.key("Control+v", *["PageUp"] * 6, "Enter")
    forge.until("s.scene.rev", 1)
    forge.page.wait_for_selector("[data-action=undo][title^='Undo paste']")
    assert counts(forge)[7] > before[7]


def test_a_class_is_smoothed_by_its_panel(voxels):
    forge, page = voxels, voxels.page
    page.locator(".panel[data-panel=smoothing] .panel-title").click()
    forge.key("3")
    button = page.get_by_role("button", name="Smooth wall")
    assert "object class" in button.get_attribute("aria-description")
    forge.key("0")
    page.get_by_role("button", name="Smooth furniture").click()
    forge.until("s.scene.rev", 1)
    page.wait_for_selector("[data-action=undo][title^='Undo smooth']")


def test_eyedropper_measure_and_the_region_under_the_pointer(voxels, shot):
    forge, page = voxels, voxels.page
    x, y = forge.object_at(2)
    before = counts(forge)
    forge.key("b", "i")
    page.mouse.click(x, y)
    forge.until("s.options.classId", 7)
    forge.until("s.tool", "brush")
    forge.key("j")
    forge.drag((x - 50, y), (x + 50, y))
    shot(forge, "measure")
    assert " m " in page.locator("[data-mark=measure] text").text_content()
    assert forge.state("s.status").startswith("Distance")
    forge.key("q")
    assert page.locator("[data-mark=measure]").count() == 0
    page.mouse.move(x, y)
    assert page.locator("[data-status=class]").inner_text() == "sofa"
    forge.key("Shift+Delete")
    forge.until("s.scene.counts[7]", 0)
    assert before[7] > 0
    forge.key("Control+z")
    forge.until("s.scene.counts[7]", before[7])
    page.mouse.click(x, y, button="right")
    page.get_by_role("menuitem", name="Hide sofa").click()
    forge.until("s.view.hidden.has(7)")


def test_floaters_are_found_by_size_and_deleted_at_once(voxels, shot):
    forge, page = voxels, voxels.page
    shape = forge.state("s.scene.shape")
    start = ((shape[0] // 2) * shape[1] + shape[1] // 2) * shape[2] + shape[2] - 8
    page.evaluate(
        f"window.__forge.connection.do({{op:'set_cells',cells:[[{start},3]],class_id:11}})"
    )
    forge.until("s.scene.rev", 1)
    forge.slide("floater-size", 10)
    page.locator("[data-do=find-floaters]").click()
    page.wait_for_selector(".panel[data-panel=floaters] .found")
    found = page.locator(".panel[data-panel=floaters] .found")
    assert "3 cells" in found.all_inner_texts()[0].replace("\n", " ") or found.count() >= 1
    shot(forge, "floaters")
    found.first.click()
    assert forge.state("s.selectedCells.size") > 0
    page.locator("[data-do=delete-floaters]").click()
    forge.until("s.scene.rev", 2)
    page.get_by_text("No floaters up to this size").wait_for()


def test_holes_of_a_plane_are_listed_and_filled(voxels, shot):
    forge, page = voxels, voxels.page
    floor = counts(forge)[2]
    hole = forge.state(
        "(() => { const [X, Y, Z] = s.scene.shape; const runs = []; for (let x = 8; x < 14; x++)"
        " for (let y = 8; y < 14; y++) { const at = (x * Y + y) * Z; for (let z = 0; z < 3; z++)"
        " if (s.labels[at + z] === 2) runs.push([at + z, 1]); } return runs; })()"
    )
    page.evaluate(f"window.__forge.connection.do({{op:'set_cells',cells:{hole},class_id:0}})")
    forge.until("s.scene.rev", 1)
    missing = counts(forge)[2]
    assert missing < floor
    forge.key("h")
    row = page.locator(".found[data-plane=floor]")
    row.wait_for()
    shot(forge, "holes")
    row.click()
    forge.until("s.scene.rev", 2)
    assert counts(forge)[2] > missing
    forge.key("Shift+S")
    page.wait_for_timeout(50)


def test_slices_and_the_section_box_hide_what_lies_outside(voxels, shot):
    forge, page = voxels, voxels.page
    forge.key("PageDown")
    high = forge.state("s.view.slice.high")
    forge.key("PageUp", "PageUp")
    forge.until("s.view.slice.high", high + 2)
    page.locator(".panel[data-panel=slices] .panel-title").click()
    page.get_by_role("group", name="Slice along").get_by_role("button", name="X").click()
    forge.until("s.view.slice.axis", 0)
    forge.slide("slice-high", 20)
    forge.until("s.view.slice.high", 20)
    shot(forge, "slice")
    page.get_by_role("group", name="Slice along").get_by_role("button", name="Off").click()
    page.locator("input[data-field=section]").check()
    forge.slide("section-z-high", 9)
    forge.until("s.view.section.high[2]", 9)
    shot(forge, "section")
    page.locator("input[data-field=section]").uncheck()
    forge.until("s.view.section", None)


def test_sliders_change_how_cells_are_drawn(voxels, shot):
    forge = voxels
    forge.slide("voxel-size", 0.6)
    forge.slide("opacity", 0.4)
    forge.slide("center-size", 0.3)
    assert forge.state("[s.view.voxelSize, s.view.opacity, s.view.centerSize]") == [0.6, 0.4, 0.3]
    shot(forge, "small_cells")
    forge.key("e")
    forge.until("s.view.edges", False)
    forge.page.get_by_role("button", name="Confidence", exact=True).click()
    forge.until("s.view.colourBy", "confidence")
    shot(forge, "confidence")
