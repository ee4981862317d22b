"""The tables of the paper, each with what we measured beside it, or with what we lack for it.

``tables`` holds them as printed, a YAML file each, with notes where the paper contradicts itself.
``measured.yaml`` holds our figures, each with what it was measured on, the command, and the page
that tells it. ``from_program`` reads what the program itself knows: the mapping of classes, the
recipes of fine-tuning, the sizes. ``layout`` puts all of it into one table, ``writing`` prints it.
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
