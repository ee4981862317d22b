"""The benchmark's tables: made of runs that are done once, and a verdict that can go either way."""

import numpy as np
import pytest
from benchmarks import train_joint, train_table
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from tests.networks import toy_network
from tests.networks.toy_sets import write_toy_store

from world2minecraft.evaluation.metrics.occupancy import OccupancyCounts, count_occupancy
from world2minecraft.networks import training


@pytest.fixture(autouse=True)
def toy(monkeypatch):
    monkeypatch.setattr(training, "make_network", toy_network.make_toy)


@pytest.fixture(scope="module")
def stores(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sets")
    return write_toy_store(folder / "a"), write_toy_store(folder / "b", count=6, scenes=3)


COMMON = ["--preset", "smoke", "--threads", "1", "--device", "cpu", "--val-share", "0.34"]


def test_a_table_is_made_once_and_read_the_next_time(stores, tmp_path, capsys):
    words = ["--set", str(stores[0]), "--out", str(tmp_path / "R"), "--steps", "3",
             "--networks", "monoscene", "symphonies+depth", "--cache", str(tmp_path / "c"),
             "--markdown", str(tmp_path / "t.md"), *COMMON]  # fmt: skip
    assert train_table.main(words) == 0
    first = capsys.readouterr()
    assert "Training ..." in first.err and "paper, 8k: monoscene" in first.out
    text = (tmp_path / "t.md").read_text()
    assert text.startswith("| network | million weights") and "| 40.66 |" in text
    blind = next(line for line in text.splitlines() if line.startswith("| no picture | - |"))
    assert blind.count("|") == text.splitlines()[0].count("|")
    assert train_table.main(words) == 0
    again = capsys.readouterr()
    assert "Training ..." not in again.err and again.out == first.out
    given = training.read_config(tmp_path / "R/symphonies+depth/run.yaml").depth
    assert (given, training.read_config(tmp_path / "R/monoscene/run.yaml").depth) == (
        "given",
        "taught",
    )


def test_the_average_box_is_the_majority_of_training_frames():
    frames = [np.zeros((2, 1, 1), np.uint8) for _ in range(4)]
    for frame in frames[:3]:
        frame[0] = 3
    frames[3][0], frames[0][1] = 2, 255
    times = train_table.class_times(frames)
    assert times[:, 0, 0, 0].tolist() == [0, 0, 1, 3] + [0] * 8 and times[:, 1].sum() == 3
    assert train_table.average_labels(times).ravel().tolist() == [3, 0]


@given(arrays(np.uint8, (5, 3, 2, 2), elements=st.sampled_from([0, 1, 4, 255])),
       arrays(np.uint8, (3, 2, 2), elements=st.sampled_from([0, 1, 4])))  # fmt: skip
def test_the_iou_of_a_constant_box_is_that_of_its_counts(frames, said):
    expected = sum((count_occupancy(said, one) for one in frames), OccupancyCounts()).iou
    assert train_table.iou_of(train_table.class_times(frames), said) == pytest.approx(expected)


def test_a_table_tells_what_was_learned_when(tmp_path):
    for name, lines in (("a", "2,val_miou,0.1\n4,val_miou,0.25"), ("b", "4,val_miou,0.5")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "metrics.csv").write_text(f"step,name,value\n2,val_iou,0.9\n{lines}\n")
    head, rows = train_table.learning_rows({name: tmp_path / name for name in "ab"})
    assert head[1:] == ("2", "4")
    assert rows == [["a", "10.00", "25.00"], ["b", "-", "50.00"]]


def test_joint_runs_share_their_test_scenes(stores, tmp_path, capsys):
    words = ["--target", str(stores[0]), "--others", f"{stores[1]}:2",
             "--out", str(tmp_path / "R"),
             "--seeds", "0", "1", "--steps", "3", "--ways", "alone", "joint",
             "--cache", str(tmp_path / "c"), *COMMON]  # fmt: skip
    assert train_joint.main(words) == 0
    out = capsys.readouterr().out
    assert "joint - alone" in out and "no picture" in out
    names = {path.name for path in (tmp_path / "R").iterdir()}
    assert names == {f"{way}-{seed}" for way in ("alone", "joint") for seed in (0, 1)}


def counts(right, wrong):
    table = np.zeros((12, 12), np.int64)
    table[2, 2], table[2, 3] = right, wrong
    return table


@pytest.mark.parametrize(
    ("joint", "expected"), [((90, 10), "win"), ((30, 70), "loss"), ((50, 50), "undecided")]
)
def test_the_verdict_follows_the_interval(joint, expected):
    rng = np.random.default_rng(0)

    def runs(right, wrong):
        return [
            {f"s{n}": counts(right + int(rng.integers(-5, 6)), wrong) for n in range(8)}
            for _ in range(3)
        ]

    lines = train_joint.rows_of({"alone": runs(50, 50), "joint": runs(*joint)}, 200)
    assert lines[-1][0] == "joint - alone" and lines[-1][-1] == expected
    low_high = lines[0][5]
    mean = np.mean([float(value) for value in lines[0][6].split(", ")])
    assert float(low_high.split()[0]) == pytest.approx(mean, abs=0.011)


def test_resampled_scenes_that_are_alike_give_the_same_figure():
    runs = [{"a": counts(3, 1), "b": counts(3, 1)}]
    expected = OccupancyCounts(counts(3, 1)).miou
    assert train_joint.drawn_figures(runs, "miou", 20) == pytest.approx(np.full(20, expected))
