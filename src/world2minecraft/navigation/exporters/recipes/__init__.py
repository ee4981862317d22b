"""The recipes and scripts that exports put beside the data, as templates."""

from importlib.resources import files
from typing import Any

import jinja2


def render_recipe(name: str, /, **values: Any) -> str:
    """Return a recipe, its blanks filled.

    Args:
        name: of the file, without ``.jinja``.
        values: what the blanks are filled with; each must be there.
    """
    environment = jinja2.Environment(
        undefined=jinja2.StrictUndefined, trim_blocks=True, keep_trailing_newline=True
    )
    return environment.from_string(read_recipe(f"{name}.jinja")).render(**values)


def read_recipe(name: str) -> str:
    """Return a file of this folder as it is."""
    return files(__name__).joinpath(name).read_text("utf-8")
