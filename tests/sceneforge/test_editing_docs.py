"""The page on editing commands names every command and query on cells, with its fields."""

import re
from pathlib import Path

from world2minecraft.editing.scene import COMMANDS
from world2minecraft.editing.scene.voxel_commands import CellCommand
from world2minecraft.sceneforge.queries import CELL_QUERIES, Doubtful

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "forge-commands.md").read_text()
ROWS = dict(re.findall(r"^\| `(\w+)` \| (.*)$", PAGE, re.M))


def test_every_command_on_cells_has_a_row_with_its_fields():
    ours = {name: kind for name, kind in COMMANDS.items() if issubclass(kind, CellCommand)}
    assert {name for name in ROWS if name in COMMANDS} == set(ours)
    for name, kind in ours.items():
        fields = kind.model_fields.keys() - {"op", "locked"}
        assert all(f"`{field}`" in ROWS[name] for field in fields), name


def test_every_query_on_cells_and_every_doubt_is_named():
    assert all(f"`{name}`" in PAGE for name in [*CELL_QUERIES, "doubtful"])
    kinds = set(re.findall(r"``(\w+)``", Doubtful.__doc__ or "")) - {"why", "kind"}
    assert len(kinds) == 11 and all(f"`{kind}`" in PAGE for kind in kinds)
