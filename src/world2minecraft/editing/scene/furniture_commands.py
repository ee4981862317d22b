"""Commands for the furniture of objects: add a piece, choose a template, match again."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from world2minecraft.core.classes import display_name
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import OWN_CELLS, Operation, Placement, SceneObject
from world2minecraft.core.vocabulary import read_vocabulary
from world2minecraft.editing.scene.cell_patch import Patch
from world2minecraft.editing.scene.command import Command, Tools
from world2minecraft.editing.scene.object_boxes import (
    free_object_id,
    object_by_id,
    objects_by_ids,
    with_placement,
)
from world2minecraft.editing.scene.object_conversion import instance_of, object_of
from world2minecraft.editing.scene.object_naming import with_name_of
from world2minecraft.editing.scene.object_placement import standing_box
from world2minecraft.editing.scene.object_transforms import Id, Ids, Point, QuarterTurns, is_free
from world2minecraft.editing.scene.scene_draft import SceneDraft
from world2minecraft.furniture import Template, template, template_cells, templates_of_class

ObjectClass = Annotated[int, Field(ge=5, le=11)]
TemplateName = Annotated[str, Field(min_length=1, max_length=200)]


class AddObject(Command):
    """Add a piece of furniture of typical size at a position, on top of what is below.

    Wall-mounted furniture is centred at ``at_m``, and ceiling-mounted furniture extends up to the
    surface above. Without ``template``, the simplest template of the class is used. Without
    ``quarter_turns``, the furniture faces away from the nearest wall, or towards an adjacent table.
    It only occupies free cells.
    """

    op: Literal["add_object"] = "add_object"
    class_id: ObjectClass
    at_m: Point
    template: TemplateName | None = None
    quarter_turns: QuarterTurns | None = None

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the new object and its cells."""
        chosen = self._template()
        corner, counts, turns = standing_box(draft, chosen, self.at_m, self.quarter_turns)
        size_m = np.round(np.array(counts) * draft.voxel_m, 9)
        solid = template_cells(chosen, size_m, None, turns, corner.tolist(), draft.voxel_m)
        cells = solid[is_free(draft, solid)]
        if not len(cells):
            sides = " x ".join(f"{side:.2f}" for side in size_m)
            raise UsageError(f"no free cells at this position for {chosen.title}, {sides} m")
        number = free_object_id(draft)
        sides = np.array(counts)[[1, 0, 2]] if turns % 2 else np.array(counts)
        middle = draft.origin_m + (corner + sides / 2) * draft.voxel_m
        iou = round(len(cells) / len(solid), 4)
        box = (np.round(middle, 9), size_m, turns, iou, chosen.complete())
        placed = Placement(number, self.class_id, chosen.name, *box)
        shown = read_vocabulary().of_template(chosen.name)
        named = (shown.name, 1.0) if shown else ("", 0.0)
        box = (placed.center_m, size_m, 90.0 * turns)
        one = SceneObject(number, self.class_id, *box, 1.0, (), *named)
        patch = Patch(draft)
        patch.fill(cells, self.class_id, number)
        details = {"counts_as": "add", "class_id": self.class_id}
        return patch.plan_operation("add_object", objects=[with_placement(one, placed)], **details)

    def _template(self) -> Template:
        if self.template is None:
            return templates_of_class(self.class_id)[0]
        return template_for(self.template, self.class_id)


class SetTemplate(Command):
    """Choose the furniture template of an object, fitted to the object's cells.

    Without ``quarter_turns``, the best-fitting rotation is used. The object adopts the bounding box
    and rotation of the furniture, and keeps its cells. ``cells`` builds the object from its own
    cells.
    """

    op: Literal["set_template"] = "set_template"
    id: Id
    template: TemplateName
    quarter_turns: QuarterTurns | None = None

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the object and its furniture."""
        one = object_by_id(draft, self.id)
        if self.template != OWN_CELLS:
            template_for(self.template, one.class_id)
        turns = None if self.quarter_turns is None else self.quarter_turns % 4
        found = instance_of(one, draft.cells_of(one.id))
        placed = tools.fit(draft.grid(), found, self.template, turns)
        same = [p.template for p in one.placements] == [placed.template]
        counted = "orient" if same else "other"
        details = {"counts_as": counted, "class_id": one.class_id}
        return Patch(draft).plan_operation(
            "set_template", objects=[with_placement(one, placed)], **details
        )


class Rematch(Command):
    """Match the furniture of objects again from their cells, as in the reconstruction."""

    op: Literal["rematch"] = "rematch"
    ids: Ids

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the objects and their furniture."""
        grid, objects = draft.grid(), []
        for one in objects_by_ids(draft, self.ids):
            cells = draft.cells_of(one.id)
            if not len(cells):
                raise UsageError(f"object {one.id} has no cells to match; choose a template for it")
            found = with_name_of(one, tools.measure(grid, one.id, one.class_id, cells))
            objects.append(object_of(found, tools.match(grid, found)))
        return Patch(draft).plan_operation("rematch", objects=objects)


def template_for(name: str, class_id: int) -> Template:
    """Return the template with a name, which must be a template for the given class.

    Raises:
        UnknownNameError: If the template is unknown.
        UsageError: If the template is for another class.
    """
    found = template(name)
    if found.class_id != class_id:
        own, other = display_name(found.class_id), display_name(class_id)
        raise UsageError(
            f"{name} is for class {own}, but the object is a {other}; relabel it first"
        )
    return found
