"""The tables of the paper, with this project's measurements beside the published values.

``tables`` contains the published tables as YAML files, with notes where the paper contradicts
itself. ``measured.yaml`` contains our measurements with their data, command and documentation page.
``table_rows`` combines both with facts from the program, such as class mappings and recipes, and
``table_writer`` formats the result.
"""

from world2minecraft.paper.table_reader import (
    Ours,
    PaperTable,
    read_results,
    read_table,
    table_names,
)
from world2minecraft.paper.table_rows import fill_table

__all__ = ["Ours", "PaperTable", "fill_table", "read_results", "read_table", "table_names"]
