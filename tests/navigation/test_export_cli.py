"""``w2m vln export``: what it says, and what it does not take."""

import pytest
from tests.navigation.vln_sets import small_set

from world2minecraft.cli import run as w2m


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return small_set(tmp_path_factory.mktemp("set"))


def call(*words):
    return w2m([str(word) for word in words])


def test_an_export_tells_rows_tokens_steps_and_the_command(folder, tmp_path, capsys):
    out = tmp_path / "out"
    words = ("--task", "next_view", "--composition", "base", "--model", "models/tiny")
    assert call("vln", "export", folder, "--to", "llamafactory", "--out", out, *words) == 0
    told = capsys.readouterr().out.splitlines()
    assert told == [
        "mcvln_next_view_base_train: 5 rows, at most 388 tokens a row, 15 steps",
        "mcvln_next_view_base_val_unseen: 5 rows, at most 388 tokens a row",
        f"next: cd {out} && llamafactory-cli train next_view_base_sft.yaml",
    ]
    assert 'model_name_or_path: "models/tiny"' in (out / "next_view_base_sft.yaml").read_text()


def test_notes_are_told(folder, tmp_path, capsys):
    assert call("vln", "export", folder, "--to", "easyr1", "--out", tmp_path / "out") == 0
    told = capsys.readouterr().out
    assert (
        "note: mcvln_next_view_combined_train: 10 rows are fewer than the paper's batch size"
    ) in told
    assert "python3 -m verl.trainer.main config=next_view_combined_grpo.yaml" in told


def test_what_is_no_format_and_no_set_is_told(folder, tmp_path, capsys):
    assert call("vln", "export", folder, "--to", "lamafactory", "--out", tmp_path / "x") == 2
    assert "no format is named 'lamafactory'; did you mean 'llamafactory'?" in (
        capsys.readouterr().err
    )
    assert call("vln", "export", tmp_path, "--to", "trl", "--out", tmp_path / "y") == 3
    assert (
        "items.jsonl: not found; w2m vln build SCENE --out SET writes it" in capsys.readouterr().err
    )
