"""Which figures a published file of LayoutGPT is held to."""

import pytest
from benchmarks import check_layouts
from tests.paper.layouts.made_layouts import gpt_record, write

CHAIR = ("dining_chair", 2.0, 1.5, 0.45, 0.5, 0.5, 0.9, 0)
OUTSIDE = ("sofa", 4.2, 1.5, 0.4, 0.9, 0.9, 0.8, 0)


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("gpt4.bedroom.json", "reaching_out: 0.5000, expected 0.138: MISSED"),
        ("gpt4.livingroom.k_4.json", "reaching_out: 0.5000, expected 0.203: MISSED"),
        ("mine.json", "mine.json: nothing is expected of it"),
    ],
)
def test_a_file_is_held_to_the_figures_of_its_kind_of_room(name, told, tmp_path, capsys):
    path = write(tmp_path / name, [gpt_record([CHAIR, OUTSIDE])])
    code = check_layouts.main(["--layoutgpt", str(path)])
    assert told in capsys.readouterr().out
    assert code == (0 if name == "mine.json" else 1)
