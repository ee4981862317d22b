"""Rows by EasyR1's own loader: ``EASYR1_DIR=CHECKOUT python read_easyr1.py RECIPE.yaml MODEL``.

Its packages import vLLM and Ray when they are imported; the loader needs neither, so their places
are taken by empty packages with the same folders.
"""

import os
import sys
import types
from pathlib import Path

import cpu_shims  # noqa: F401
import yaml
from transformers import AutoProcessor

PACKAGES = ("verl", "verl.utils", "verl.models", "verl.models.transformers")


def loader():
    checkout = Path(os.environ["EASYR1_DIR"])
    for name in PACKAGES:
        package = types.ModuleType(name)
        package.__path__ = [str(checkout.joinpath(*name.split(".")))]
        sys.modules[name] = package
    from verl.utils.dataset import RLHFDataset

    return RLHFDataset


def main(recipe, model):
    data = yaml.safe_load(Path(recipe).read_text())["data"]
    processor = AutoProcessor.from_pretrained(model)
    rows = loader()(
        data_path=data["train_files"],
        tokenizer=processor.tokenizer,
        processor=processor,
        prompt_key=data["prompt_key"],
        answer_key=data["answer_key"],
        image_key=data["image_key"],
        image_dir=data["image_dir"],
        max_prompt_length=data["max_prompt_length"],
        truncation="right",
        format_prompt=data["format_prompt"],
        min_pixels=data["min_pixels"],
        max_pixels=data["max_pixels"],
        filter_overlong_prompts=True,
        filter_overlong_prompts_workers=1,
    )
    for number in range(len(rows)):
        row = rows[number]
        assert row["input_ids"].shape == (data["max_prompt_length"],)
        assert len(row["multi_modal_data"]["images"]) == 7
        assert row["ground_truth"] in "ABCD"
    print(len(rows), "rows")


if __name__ == "__main__":
    main(*sys.argv[1:])
