"""Pages of kept measurements: their files are checked, and the docs hold what they say."""

import pytest
import yaml
from benchmarks.results import PAGES, main, page_text, read_page, written

TABLE = {
    "title": "Speed of it",
    "data": "two rooms",
    "command": "python -m benchmarks --only cli",
    "date": "2026-11-30",
    "commit": "abcdef12",
    "columns": ["what", "seconds"],
    "rows": [["a|b", 1.5]],
}


def page_of(tmp_path, **table):
    path = tmp_path / "speed.yaml"
    raw = {"title": "Speed", "intro": "Words.", "tables": [TABLE | table]}
    path.write_text(yaml.safe_dump(raw))
    return read_page(path)


def test_a_page_holds_figures_and_their_origin(tmp_path):
    text = page_text(page_of(tmp_path, short="It is slow."), "speed.yaml")
    assert "- It is slow. ([Speed of it](#speed-of-it))" in text
    assert "| a\\|b | 1.5 |" in text
    assert "`python -m benchmarks --only cli` on two rooms; 2026-11-30, commit abcdef12." in text


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"date": "yesterday"}, "the date is 'yesterday'"),
        ({"commit": "HEAD"}, "'HEAD' is no commit"),
        ({"rows": [["one"]]}, "2 columns, but the row"),
        ({"rows": []}, "are required"),
        ({"colour": "red"}, "unknown colour"),
    ],
)
def test_a_malformed_table_is_refused_by_name(tmp_path, wrong, said):
    with pytest.raises(ValueError, match=f"^speed.yaml: .*{said}"):
        page_of(tmp_path, **wrong)


def test_pages_of_the_docs_are_those_of_the_files():
    texts = written()
    assert texts
    assert not [name for name, text in texts.items() if (PAGES / name).read_text() != text]
    assert main(["--check"]) == 0
