"""Exports in the hands of the trainers themselves: LLaMA-Factory, TRL, and EasyR1's loader.

Each trainer has an environment of its own under ``.trainers/``, made when it is not there, because
their pins contradict each other and ours. ``make test-trainers`` runs this; nothing else does.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from tests.navigation.vln_sets import small_set

from world2minecraft.navigation.exporters import ExportOptions, export_set

pytestmark = pytest.mark.trainers

HERE = Path(__file__).resolve().parent
ROOMS = Path(os.environ.get("TRAINERS_DIR", HERE.parents[1] / ".trainers"))
PINS = {
    "llamafactory": ("llamafactory==0.9.5", "torch==2.13.0"),
    "trl": ("trl==1.16.0", "transformers==5.23.0", "torch==2.13.0", "torchvision", "pillow"),
    # EasyR1's loader alone, of the checkout that EASYR1_DIR names.
    "easyr1": (
        *("transformers==4.57.3", "torch==2.13.0", "torchvision", "pillow", "datasets"),
        *("jinja2", "qwen-vl-utils", "codetiming", "omegaconf"),
    ),
}
# What the tiny model's processor takes: the same for all, so that they see the same pictures.
PIXELS = 16 * 784
PART = "mcvln_next_view_base_train"


def python_of(trainer):
    """The interpreter of a trainer's environment, which is made when it is not whole."""
    room = ROOMS / trainer
    python, done = room / "bin" / "python", room / ".pins"
    pins = "\n".join(PINS[trainer])
    if not done.is_file() or done.read_text() != pins:
        subprocess.run([sys.executable, "-m", "venv", "--clear", room], check=True)
        free = {key: value for key, value in os.environ.items() if key != "PIP_CONSTRAINT"}
        fetch = [python, "-m", "pip", "install", "--quiet", *PINS[trainer]]
        subprocess.run(fetch, check=True, env=free)
        done.write_text(pins)
    return python


def run(trainer, folder, *words):
    """Run a program in a trainer's environment, in a folder, on one thread of the CPU."""
    quiet = {"PYTHONPATH": "", "OMP_NUM_THREADS": "1", "HF_HUB_OFFLINE": "1", "WANDB_MODE": "off"}
    done = subprocess.run(
        [python_of(trainer), *map(str, words)],
        cwd=folder,
        env={**os.environ, **quiet},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    return done.stdout


def history(out):
    """The lines of a trainer's log, in their order."""
    return json.loads((out / "trainer_state.json").read_text())["log_history"]


def losses(out):
    return [line["loss"] for line in history(out) if "loss" in line]


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    return tmp_path_factory.mktemp("trainers")


@pytest.fixture(scope="module")
def folder(room):
    return small_set(room / "set", width=224, height=224)


def exported(folder, room, trainer, format):
    model = room / f"tiny_{trainer}"
    if not model.is_dir():
        run(trainer, room, HERE / "tiny_qwen.py", model)
    rule = ExportOptions(model=str(model))
    return export_set(folder, format, room / format, rule).out


@pytest.fixture(scope="module")
def llamafactory_losses(folder, room):
    root = exported(folder, room, "llamafactory", "llamafactory")
    out = room / "sft_llamafactory"
    changes = ("deepspeed=null", "bf16=false", "use_cpu=true", "preprocessing_num_workers=1")
    changes += ("max_steps=3", "logging_steps=1", f"output_dir={out}")
    run("llamafactory", root, HERE / "run_llamafactory.py", "next_view_base_sft.yaml", *changes)
    return losses(out)


@pytest.fixture(scope="module")
def trl_losses(folder, room):
    root = exported(folder, room, "trl", "trl")
    out = room / "sft_trl"
    words = ("--cpu", "--max-steps", 3, "--max-pixels", PIXELS, "--out", out)
    run("trl", root, HERE / "run_script.py", "sft.py", f"{PART}.jsonl", *words)
    return losses(out)


def test_llamafactory_and_trl_have_equal_losses_for_three_steps(llamafactory_losses, trl_losses):
    print(f"llamafactory {llamafactory_losses} trl {trl_losses}")
    assert len(llamafactory_losses) == len(trl_losses) == 3
    assert llamafactory_losses == pytest.approx(trl_losses, abs=1e-4)
    assert all(5 < loss < 6.2 for loss in trl_losses)  # Of chance: the log of 270 is 5.6.


def test_two_steps_of_grpo_with_trl(folder, room):
    root = exported(folder, room, "trl", "trl")
    out = room / "grpo_trl"
    words = ("--cpu", "--max-steps", 2, "--batch", 1, "--rollouts", 4, "--answer-tokens", 16)
    words += ("--max-pixels", PIXELS, "--out", out)
    run("trl", root, HERE / "run_script.py", "grpo.py", f"{PART}.jsonl", *words)
    steps = [line for line in history(out) if "reward" in line]
    print([(line["step"], line["reward"], line["loss"]) for line in steps])
    assert [line["step"] for line in steps] == [1, 2]
    assert all(0 <= line["reward"] <= 1 and line["kl"] == pytest.approx(0, abs=1) for line in steps)


@pytest.mark.skipif(not os.environ.get("EASYR1_DIR"), reason="EASYR1_DIR names no checkout")
@pytest.mark.parametrize("style", ["paths", "embedded"])
def test_easyr1s_own_loader_takes_every_row(folder, room, style):
    model = room / "tiny_easyr1"
    if not model.is_dir():
        run("easyr1", room, HERE / "tiny_qwen.py", model)
    rule = ExportOptions(model=str(model), image_style=style)
    root = export_set(folder, "easyr1", room / f"easyr1_{style}", rule).out
    told = run("easyr1", root, HERE / "read_easyr1.py", "next_view_combined_grpo.yaml", model)
    assert told.split()[-2:] == ["10", "rows"]
