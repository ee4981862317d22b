"""Runs of a toy network: they learn, stop, go on where they were killed, and say what they did."""

import json
import shutil
import subprocess
import sys

import numpy as np
import pytest
import torch
from safetensors.torch import load_file
from tests.networks import toy_network
from tests.networks.toy_sets import toy_config, write_toy_store

from world2minecraft.core.errors import ConflictError, DamagedFileError, InputError, UsageError
from world2minecraft.networks import training
from world2minecraft.networks.batch import OccOutput
from world2minecraft.networks.checkpoints import (
    load_weights,
    read_facts,
    read_weights_config,
    write_checkpoint,
)
from world2minecraft.networks.config import RunConfig, read_config
from world2minecraft.networks.csv_logger import read_metrics
from world2minecraft.networks.data.training_data import CacheLocation
from world2minecraft.networks.lightning_module import learning_rate_at
from world2minecraft.networks.training import load_trained_network, train_run

torch.set_num_threads(1)


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    return write_toy_store(tmp_path_factory.mktemp("sets") / "toy")


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    return CacheLocation(root=tmp_path_factory.mktemp("frames"))


@pytest.fixture(autouse=True)
def toy(monkeypatch):
    monkeypatch.setattr(training, "make_network", toy_network.make_toy)


def trained(config, folder, cache, **words):
    return train_run(config, folder, device="cpu", cache=cache, **words)


def figures(folder, name):
    return [value for _, kind, value in read_metrics(folder / "metrics.csv") if kind == name]


@pytest.fixture(scope="module")
def whole(store, cache, tmp_path_factory):
    """A run of six steps, done at once."""
    folder = tmp_path_factory.mktemp("runs") / "whole"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(training, "make_network", toy_network.make_toy)
        trained(toy_config(store), folder, cache)
    return folder


def test_a_run_leaves_its_files(whole, store):
    names = {path.name for path in whole.iterdir()}
    assert names == {
        "run.yaml", "weights.safetensors", "last.safetensors", "checkpoint.safetensors",
        "metrics.csv", "tensorboard", "run.json",
    }  # fmt: skip
    assert read_config(whole / "run.yaml") == toy_config(store)
    assert read_weights_config(whole / "weights.safetensors") == toy_config(store)
    facts = json.loads((whole / "run.json").read_text())
    assert facts["steps"] == 6 and facts["seconds"] > 0 and facts["parameters"] > 100
    assert [row[0] for row in read_metrics(whole / "metrics.csv") if row[1] == "val_miou"] == [3, 6]
    assert any((whole / "tensorboard").glob("events*"))


@pytest.mark.parametrize("stop_at", [4, 5])
def test_a_killed_run_goes_on_to_the_same_bytes(whole, store, cache, tmp_path, stop_at):
    def kill(stage, done, total, note=""):
        if stage == "train" and done == stop_at:
            raise RuntimeError("killed")

    with pytest.raises(RuntimeError, match="killed"):
        trained(toy_config(store), tmp_path / "run", cache, progress=kill)
    assert read_facts(tmp_path / "run" / "checkpoint.safetensors")["step"] == 3
    trained(toy_config(store), tmp_path / "run", cache)
    for name in ("last.safetensors", "weights.safetensors", "metrics.csv"):
        assert (tmp_path / "run" / name).read_bytes() == (whole / name).read_bytes(), name


def test_a_run_killed_before_its_last_files_is_completed(whole, store, cache, tmp_path):
    """Such a run counted as finished, and lacked last.safetensors and run.json for good."""

    def kill(stage, done, total, note=""):
        if stage == "train" and done == 6:
            raise RuntimeError("killed")

    with pytest.raises(RuntimeError, match="killed"):
        trained(toy_config(store), tmp_path / "run", cache, progress=kill)
    assert not (tmp_path / "run/last.safetensors").exists()
    trained(toy_config(store), tmp_path / "run", cache)
    for name in ("last.safetensors", "weights.safetensors", "metrics.csv"):
        assert (tmp_path / "run" / name).read_bytes() == (whole / name).read_bytes(), name
    assert json.loads((tmp_path / "run/run.json").read_text())["steps"] == 6


def test_a_loss_that_is_no_number_ends_a_run(store, cache, tmp_path, monkeypatch):
    class Lost(toy_network.Toy):
        calls = 0

        def forward(self, inputs):
            self.calls += self.training
            said = super().forward(inputs)
            return OccOutput(said.logits * (float("nan") if self.calls > 4 else 1.0))

    monkeypatch.setattr(training, "make_network", lambda *_, **__: Lost())
    told = r"the loss at step 5 is not finite \(learning rate .*\); use a lower learning rate"
    with pytest.raises(UsageError, match=told):
        trained(toy_config(store), tmp_path / "run", cache)
    assert read_facts(tmp_path / "run" / "checkpoint.safetensors")["step"] == 3
    load_weights(tmp_path / "run" / "weights.safetensors", toy_network.Toy())


def test_foreign_files_in_a_run_folder_are_reported(whole, store, cache, tmp_path):
    shutil.copytree(whole, tmp_path / "run")
    (tmp_path / "run/metrics.csv").write_text("step;name;value\n1;train_loss;2.0\n")
    with pytest.raises(DamagedFileError, match=r"metrics.csv: must contain rows .*; delete"):
        read_metrics(tmp_path / "run/metrics.csv")
    write_checkpoint(
        tmp_path / "run/checkpoint.safetensors",
        network := toy_network.Toy(),
        torch.optim.AdamW(network.parameters()),
        {"step": 3, "mood": "good"},
    )
    with pytest.raises(DamagedFileError, match="written by another version of w2m train; choose"):
        trained(toy_config(store), tmp_path / "run", cache)


def test_a_finished_run_is_left_as_it_is(whole, store, cache):
    before = (whole / "last.safetensors").stat().st_mtime_ns
    told = []
    trained(toy_config(store, threads=2), whole, cache, progress=lambda *step: told.append(step))
    assert (whole / "last.safetensors").stat().st_mtime_ns == before
    assert not [step for step in told if step[0] == "train"]
    trained(toy_config(store), whole, cache)


def test_a_folder_of_another_run_is_refused(whole, store, cache):
    with pytest.raises(ConflictError, match=r"other settings \(steps is 6, requested 9\)"):
        trained(toy_config(store, steps=9), whole, cache)


def test_a_run_that_cannot_begin_leaves_nothing_behind(store, cache, tmp_path):
    nowhere = toy_config(tmp_path / "none")
    with pytest.raises(InputError):
        trained(nowhere, tmp_path / "run", cache)
    assert not (tmp_path / "run").exists()
    trained(toy_config(store, steps=1), tmp_path / "run", cache)
    assert read_config(tmp_path / "run" / "run.yaml").steps == 1


def test_another_seed_is_another_run(whole, store, cache, tmp_path):
    trained(toy_config(store, seed=1), tmp_path / "run", cache)
    assert (tmp_path / "run/last.safetensors").read_bytes() != (
        whole / "last.safetensors"
    ).read_bytes()


def test_it_learns_and_early_stop_ends_what_gets_no_better(store, cache, tmp_path):
    config = toy_config(store, steps=40, learning_rate=0.02, validate_every=20, flip=0.0)
    trained(config, tmp_path / "run", cache)
    losses = figures(tmp_path / "run", "train_loss")
    assert losses[-1] < 0.95 * losses[0]
    stuck = toy_config(store, learning_rate=1e-9, steps=30, patience=2)
    state = trained(stuck, tmp_path / "stuck", cache).state
    assert state.stopped and state.step == 9 and state.best_step == 3
    assert trained(stuck, tmp_path / "stuck", cache).state.step == 9


def test_bfloat16_learns_too(store, cache, tmp_path):
    trained(toy_config(store, precision="bf16"), tmp_path / "run", cache)
    assert np.isfinite(figures(tmp_path / "run", "train_loss")).all()
    assert json.loads((tmp_path / "run/run.json").read_text())["precision"] == "bf16"


def test_last_weights_are_scored_separately_from_the_best(store, cache, tmp_path):
    config = toy_config(store, steps=9, validate_every=3, learning_rate=0.3)
    found = trained(config, tmp_path / "run", cache)
    best, last = (training.score_run(found, config, "cpu", last=which) for which in (False, True))
    files = {name: json.loads((tmp_path / f"run/{name}.json").read_text())
             for name in ("scores", "scores_last")}  # fmt: skip
    assert (files["scores"]["step"], files["scores_last"]["step"]) == (found.state.best_step, 9)
    for said, kept, is_last in ((best, "scores", False), (last, "scores_last", True)):
        network = load_trained_network(tmp_path / "run", config, "cpu", last=is_last)
        weights = load_file(tmp_path / "run" / f"{'last' if is_last else 'weights'}.safetensors")
        assert all((network.state_dict()[name] == one).all() for name, one in weights.items())
        assert said["step"] == files[kept]["step"]


def test_best_weights_make_the_network_again(whole, store):
    config = read_config(whole / "run.yaml")
    network = load_trained_network(whole, config, "cpu")
    assert not network.training
    other = toy_network.Toy(width=5)
    with pytest.raises(DamagedFileError, match="belongs to another network"):
        load_weights(whole / "weights.safetensors", other)
    with pytest.raises(InputError, match="create it with w2m train NET --data DIR --out RUN"):
        load_weights(whole / "nothing.safetensors", other)
    (whole.parent / "odd.safetensors").write_bytes(b"no weights at all")
    with pytest.raises(DamagedFileError, match="not a valid safetensors file"):
        load_weights(whole.parent / "odd.safetensors", other)


def test_two_processes_do_not_train_in_one_folder(store, cache, tmp_path):
    code = (
        "import sys, time; from pathlib import Path; from world2minecraft.core.locks import Lock\n"
        "Lock(Path(sys.argv[1]) / '.lock', 'trained').acquire(); print('held', flush=True)\n"
        "time.sleep(60)"
    )
    (tmp_path / "run").mkdir()
    holder = subprocess.Popen(
        [sys.executable, "-c", code, str(tmp_path / "run")], stdout=subprocess.PIPE, text=True
    )
    try:
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(ConflictError, match="is being trained by"):
            trained(toy_config(store), tmp_path / "run", cache)
    finally:
        holder.kill()
        holder.wait()


@pytest.mark.parametrize("schedule", ["cosine", "step", "constant"])
def test_rates_rise_first_and_never_after(schedule):
    config = RunConfig("x", ("d",), steps=90, warmup_steps=10, schedule=schedule)
    rates = [learning_rate_at(config, step) for step in range(90)]
    assert rates[9] == max(rates) == config.learning_rate
    assert rates[:10] == sorted(rates[:10])
    assert rates[10:] == sorted(rates[10:], reverse=True)
    if schedule == "step":
        assert rates[60] == pytest.approx(0.1 * rates[59])
