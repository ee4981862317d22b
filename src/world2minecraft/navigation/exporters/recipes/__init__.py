"""Templates of the recipes and scripts that exports write beside the data."""

from importlib.resources import files
from typing import Any

import jinja2


def render_recipe(name: str, /, **values: Any) -> str:
    """Render a recipe template.

    Args:
        name: The file name without ``.jinja``.
        values: The template variables, all of which must be given.
    """
    environment = jinja2.Environment(
        undefined=jinja2.StrictUndefined, trim_blocks=True, keep_trailing_newline=True
    )
    return environment.from_string(read_recipe(f"{name}.jinja")).render(**values)


def read_recipe(name: str) -> str:
    """Return the text of a file in this folder."""
    return files(__name__).joinpath(name).read_text("utf-8")
