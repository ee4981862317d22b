"""What a page of the docs asks its reader to do, in its order.

``sh`` fences hold commands, ``python`` fences snippets, and a ``yaml`` fence whose first line is a
comment with a name is a file to save. Other fences are shown alone. A comment
``<!-- the tests add: WORDS -->`` before a fence adds words to its commands.
"""

import re
from typing import NamedTuple

FENCE = re.compile(
    r"(?:^<!-- the tests add: (?P<more>[^\n]*) -->\n)?^```(?P<kind>\w+)\n(?P<body>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)


class Step(NamedTuple):
    """One thing to do: ``kind`` is sh, python or yaml."""

    kind: str
    body: str
    more: str


def steps_of(page: str) -> list[Step]:
    """Return what a page asks for."""
    found = [Step(one["kind"], one["body"], one["more"] or "") for one in FENCE.finditer(page)]
    return [one for one in found if one.kind in ("sh", "python", "yaml")]
