"""The glossary speaks of names that the code has."""

import re
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
SOURCE = REPOSITORY / "src" / "world2minecraft"
FILE = re.compile(r"\.(npz|json|onnx|md|py)$", re.IGNORECASE)


def test_every_name_of_the_symbols_is_in_the_code():
    page = (REPOSITORY / "docs" / "reference" / "glossary.md").read_text(encoding="utf-8")
    table = page.partition("## Symbols")[2].partition("## Words")[0]
    rows = [line.split("|")[3] for line in table.splitlines() if line.startswith("| ")][1:]
    quoted = [text for row in rows for text in re.findall(r"`([^`]+)`", row)]
    names = {
        name
        for text in quoted
        if not FILE.search(text)
        for name in re.findall(r"[A-Za-z]\w+", text.partition("=")[0])
    }
    assert len(rows) > 15 and {"Camera", "density_threshold", "quarter_turns"} <= names
    code = " ".join(path.read_text(encoding="utf-8") for path in SOURCE.rglob("*.py"))
    assert not names - set(re.findall(r"\w+", code))
