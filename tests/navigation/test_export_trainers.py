"""Exports held against the loaders' rules, as their own code has them, in slow and plain words."""

import io
import json
import re

import jinja2
import pyarrow.parquet as pq
import pytest
import yaml
from PIL import Image
from tests.navigation.vln_sets import small_set, with_sums, write_pictures

from world2minecraft.core.errors import (
    ConflictError,
    DamagedFileError,
    InputError,
    UnknownNameError,
    UsageError,
)
from world2minecraft.navigation.exporters import ExportOptions, export_set
from world2minecraft.navigation.exporters.loader_checks import (
    check_easyr1,
    check_llamafactory,
    check_trl,
)
from world2minecraft.navigation.records import read_items, write_items


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return small_set(tmp_path_factory.mktemp("set"))


@pytest.fixture(scope="module")
def items(folder):
    return {item.item_id: item for item in read_items(folder)}


@pytest.fixture(scope="module")
def sft(folder, tmp_path_factory):
    return export_set(folder, "llamafactory", tmp_path_factory.mktemp("sft"))


@pytest.fixture(scope="module")
def grpo(folder, tmp_path_factory):
    return export_set(folder, "easyr1", tmp_path_factory.mktemp("grpo"))


@pytest.fixture(scope="module")
def trl(folder, tmp_path_factory):
    return export_set(folder, "trl", tmp_path_factory.mktemp("trl"))


def converted(root, name):
    """The rows of a set as LLaMA-Factory's sharegpt converter makes them."""
    entry = json.loads((root / "dataset_info.json").read_text())[name]
    tags, columns = entry["tags"], entry["columns"]
    assert entry["formatting"] == "sharegpt"
    for row in json.loads((root / entry["file_name"]).read_text()):
        turns = row[columns["messages"]]
        accepted = ([tags["user_tag"]], [tags["assistant_tag"]])
        for number, turn in enumerate(turns):
            assert turn[tags["role_tag"]] in accepted[number % 2]
        assert len(turns) % 2 == 0
        images = row[columns["images"]] or None
        text = "".join(turn[tags["content_tag"]] for turn in turns)
        assert text.count("<image>") == len(images)
        yield row, [root / image for image in images]


def test_llamafactory_converts_every_row(sft, items):
    names = [one.name for one in sft.written]
    assert names == [
        f"mcvln_{task}_{part}"
        for task in ("next_view", "next_action")
        for part in (
            *("base_train", "base_val_unseen", "extend_train"),
            *("combined_train", "combined_val_unseen"),
        )
    ]
    assert sorted(json.loads((sft.out / "dataset_info.json").read_text())) == sorted(names)
    for one in sft.written:
        rows = list(converted(sft.out, one.name))
        assert len(rows) == one.rows
        for row, paths in rows:
            item = items[row["id"]]
            assert row["messages"][1]["content"] == item.answer
            assert item.instruction.text in row["messages"][0]["content"]
            sums = [path.read_bytes() for path in paths]
            assert len(sums) == len(item.images)


def test_the_sft_recipe_is_the_papers(sft):
    recipe = yaml.safe_load((sft.out / "next_view_base_sft.yaml").read_text())
    paper = {
        "stage": "sft",
        "finetuning_type": "full",
        "freeze_vision_tower": True,
        "freeze_multi_modal_projector": True,
        "template": "qwen2_vl",
        "cutoff_len": 8192,
        "max_samples": 1000,
        "per_device_train_batch_size": 1,
        "gradient_accumulation_steps": 2,
        "learning_rate": 1e-5,
        "num_train_epochs": 5.0,
        "lr_scheduler_type": "cosine",
        "warmup_ratio": 0.1,
        "bf16": True,
    }
    assert {key: recipe[key] for key in paper} == paper
    assert recipe["dataset"] == "mcvln_next_view_base_train"
    assert recipe["image_max_pixels"] == 262_144
    assert not {"val_size", "eval_dataset"} & set(recipe)
    assert (
        json.loads((sft.out / recipe["deepspeed"]).read_text())["zero_optimization"]["stage"] == 3
    )
    told = next(one for one in sft.written if one.name == recipe["dataset"])
    assert told.steps == 15  # 5 rows, 2 an update, 5 epochs.
    assert told.command == "llamafactory-cli train next_view_base_sft.yaml"


def loaded(root, recipe):
    """The rows of a recipe's training file as EasyR1's loader makes them."""
    data = recipe["data"]
    form = jinja2.Template((root / data["format_prompt"]).read_text().strip())
    for row in pq.read_table(root / data["train_files"]).to_pylist():
        prompt = form.render(content=row[data["prompt_key"]])
        parts = []
        for number, text in enumerate(prompt.split("<image>")):
            parts += [{"type": "image"}] if number else []
            parts += [{"type": "text", "text": text}] if text else []
        images = []
        for told in row[data["image_key"]]:
            is_path = isinstance(told, str)
            image = root / data["image_dir"] / told if is_path else io.BytesIO(told["bytes"])
            images.append(Image.open(image).convert("RGB"))
        assert sum(part["type"] == "image" for part in parts) == len(images)
        yield row["id"], parts, images, row[data["answer_key"]]


@pytest.mark.parametrize("style", ["paths", "embedded"])
def test_easyr1_loads_every_row_of_both_styles(folder, items, tmp_path, style):
    done = export_set(folder, "easyr1", tmp_path / "out", ExportOptions(image_style=style))
    assert (done.out / "images").is_dir() == (style == "paths")
    for stem in ("next_view_combined", "next_action_extend"):
        recipe = yaml.safe_load((done.out / f"{stem}_grpo.yaml").read_text())
        assert (recipe["data"]["image_dir"] is None) == (style == "embedded")
        rows = list(loaded(done.out, recipe))
        assert len(rows) == {"next_view_combined": 10, "next_action_extend": 8}[stem]
        for name, parts, images, answer in rows:
            assert answer == items[name].answer
            assert len(images) <= recipe["worker"]["rollout"]["limit_images"]
            assert parts[-1]["text"].endswith("inside <answer> </answer>.")
            assert all(image.size == (64, 36) for image in images)


def test_the_grpo_recipe_is_the_papers(grpo):
    recipe = yaml.safe_load((grpo.out / "next_action_base_grpo.yaml").read_text())
    data, algorithm = recipe["data"], recipe["algorithm"]
    actor, rollout = recipe["worker"]["actor"], recipe["worker"]["rollout"]
    assert (data["max_prompt_length"], data["max_response_length"]) == (4096, 1024)
    assert (data["prompt_key"], data["answer_key"]) == ("content", "answer")
    assert (algorithm["kl_penalty"], algorithm["kl_coef"]) == ("low_var_kl", 1e-2)
    assert algorithm["adv_estimator"] == "grpo" and algorithm["use_kl_loss"] is True
    assert (actor["optim"]["lr"], actor["optim"]["weight_decay"]) == (1e-6, 1e-2)
    assert actor["model"]["freeze_vision_tower"] is False
    assert actor["fsdp"]["enable_full_shard"] and actor["offload"]["offload_params"]
    assert (rollout["n"], rollout["temperature"], rollout["tensor_parallel_size"]) == (5, 1.0, 2)
    assert (recipe["trainer"]["total_epochs"], recipe["trainer"]["n_gpus_per_node"]) == (30, 8)


def test_the_grpo_recipe_trains_on_few_rows_and_says_so(grpo):
    for path in grpo.out.glob("*_grpo.yaml"):
        recipe = yaml.safe_load(path.read_text())
        rows = pq.read_metadata(grpo.out / recipe["data"]["train_files"]).num_rows
        batch = recipe["data"]["rollout_batch_size"]
        assert rows // batch >= 1  # The loader drops what fills no batch, and needs one.
        assert batch % recipe["worker"]["actor"]["global_batch_size"] == 0
        per_gpu = recipe["worker"]["actor"]["global_batch_size"] * recipe["worker"]["rollout"]["n"]
        assert per_gpu % recipe["trainer"]["n_gpus_per_node"] == 0
        assert recipe["data"]["max_pixels"] == 262_144 and recipe["data"]["min_pixels"] == 3136
    assert (
        "mcvln_next_view_combined_train: 10 rows are fewer than the paper's batch size of 128; "
        "the recipe uses a batch size of 8"
    ) in grpo.notes
    assert (
        "mcvln_next_view_combined_train: the loader drops the incomplete last batch, which is "
        "2 of 10 rows in each epoch (different rows each time)"
    ) in grpo.notes
    assert (
        "mcvln_next_view_base_train: no recipe was written, because 5 rows do not fill one "
        "batch on 8 GPUs; use 5 or fewer (--gpus)"
    ) in grpo.notes
    extend = yaml.safe_load((grpo.out / "next_action_extend_grpo.yaml").read_text())
    assert extend["trainer"]["val_before_train"] is False  # Nothing of it is held out.
    assert "mcvln_next_action_extend_train: the set has no held-out items" in "\n".join(grpo.notes)


def test_the_three_trainers_are_told_the_same(sft, grpo, trl):
    name = "mcvln_next_view_combined_train"
    rows = json.loads((sft.out / f"{name}.json").read_text())
    lines = [json.loads(line) for line in (trl.out / f"{name}.jsonl").read_text().splitlines()]
    table = pq.read_table(grpo.out / f"{name}.parquet").to_pylist()
    assert [row["id"] for row in rows] == [line["id"] for line in lines]
    assert [row["id"] for row in rows] == [row["id"] for row in table]
    for row, line, entry in zip(rows, lines, table, strict=True):
        assert row["images"] == line["images"] == entry["images"]
        asked = row["messages"][0]["content"]
        parts = line["prompt"][0]["content"]
        assert asked == "".join(part.get("text", "<image>") for part in parts)
        assert asked == f"{entry['content']}\nAnswer with its letter alone."
        told = line["completion"][0]["content"][0]["text"]
        assert row["messages"][1]["content"] == told == entry["answer"] == line["answer"]


def test_the_scripts_of_trl_are_python(trl):
    for name in ("sft.py", "grpo.py", "reward.py"):
        text = (trl.out / name).read_text()
        compile(text, name, "exec")
        assert "{{" not in text and "{%" not in text
    assert re.search(r"EPOCHS, BATCH, ACCUMULATED = 5, 1, 2", (trl.out / "sft.py").read_text())
    grpo = (trl.out / "grpo.py").read_text()
    assert "EPOCHS, BATCH, ROLLOUTS, GPUS = 30, 128, 5, 8" in grpo
    assert "beta=1e-2" in grpo and "learning_rate=1e-6" in grpo and "weight_decay=1e-2" in grpo


@pytest.mark.parametrize("format", ["llamafactory", "easyr1", "trl", "vlnce", "r2r"])
def test_the_same_set_gives_the_same_bytes(folder, tmp_path, format):
    files = []
    for name in ("one", "two"):
        root = export_set(folder, format, tmp_path / name).out
        export_set(folder, format, root)  # Again, over itself.
        files.append({p.relative_to(root): p.read_bytes() for p in root.rglob("*") if p.is_file()})
    assert files[0] == files[1]


def test_max_samples_takes_first_rows_of_a_shuffled_file(folder, tmp_path):
    done = export_set(folder, "llamafactory", tmp_path / "out", ExportOptions(max_samples=6))
    assert done.notes == [
        "mcvln_next_view_combined_train: --max-samples 6 omits the same 4 rows in every epoch, "
        "as in the paper; use --max-samples 0 for all rows",
        "mcvln_next_action_base_train: --max-samples 6 omits the same 2 rows in every epoch, "
        "as in the paper; use --max-samples 0 for all rows",
        "mcvln_next_action_extend_train: --max-samples 6 omits the same 2 rows in every epoch, "
        "as in the paper; use --max-samples 0 for all rows",
        "mcvln_next_action_combined_train: --max-samples 6 omits the same 10 rows in every "
        "epoch, as in the paper; use --max-samples 0 for all rows",
    ]
    rows = json.loads((done.out / "mcvln_next_action_combined_train.json").read_text())
    scenes = {row["id"].split("-")[0] for row in rows[:6]}
    assert scenes == {"kitchen", "villa"}
    all_rows = export_set(folder, "llamafactory", tmp_path / "all", ExportOptions(max_samples=0))
    assert not all_rows.notes
    assert "max_samples" not in (all_rows.out / "next_action_base_sft.yaml").read_text()


def test_pictures_that_overflow_a_prompt_are_told(tmp_path):
    folder = small_set(tmp_path / "set", width=1280, height=720)
    with pytest.raises(UsageError) as caught:
        export_set(folder, "easyr1", tmp_path / "out", ExportOptions(max_pixels=1 << 24))
    assert re.fullmatch(
        r"item \S+ needs up to 8,\d\d\d tokens, more than the 4,096 of a prompt; export with a "
        r"lower pixel limit \(--max-pixels\)",
        str(caught.value),
    )
    done = export_set(folder, "easyr1", tmp_path / "capped")
    assert 7 * 336 < max(one.tokens for one in done.written) < 4096


def test_a_picture_that_was_changed_or_lost_is_told(tmp_path):
    folder = small_set(tmp_path / "set")
    picture = folder / "images/kitchen/t0/003.jpg"
    kept = picture.read_bytes()
    picture.write_bytes(kept[:-20])
    with pytest.raises(
        DamagedFileError, match=("the image's SHA-256 does not match the one recorded in the items")
    ):
        export_set(folder, "trl", tmp_path / "out")
    picture.unlink()
    with pytest.raises(InputError, match="003.jpg: cannot be read"):
        export_set(folder, "trl", tmp_path / "out")


def test_a_picture_that_no_trainer_reads_is_told(tmp_path):
    write_pictures(tmp_path, "kitchen")
    small_set(tmp_path)
    import hashlib
    from dataclasses import replace

    picture = tmp_path / "images/kitchen/t0/003.jpg"
    picture.write_bytes(b"GIF89a no picture")
    total = hashlib.sha256(picture.read_bytes()).hexdigest()
    items = [
        replace(item, sha256={**item.sha256, "images/kitchen/t0/003.jpg": total})
        for item in read_items(tmp_path)
    ]
    write_items(tmp_path / "items.jsonl", [with_sums(items[0]), *items[1:]])
    write_items(tmp_path / "items.jsonl", items)
    with pytest.raises(DamagedFileError, match="not an image that trainers can read"):
        export_set(tmp_path, "llamafactory", tmp_path / "out")


def test_a_folder_of_something_else_is_left_alone(folder, tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/thesis.tex").write_text("...")
    with pytest.raises(
        ConflictError,
        match=("the folder is not empty and does not contain an export; choose another folder"),
    ):
        export_set(folder, "trl", tmp_path / "mine")
    export_set(folder, "trl", tmp_path / "trl")
    with pytest.raises(
        ConflictError, match=(r"with other options \(seed " r"0, not 1\); choose another")
    ):
        export_set(folder, "trl", tmp_path / "trl", ExportOptions(seed=1))
    with pytest.raises(UnknownNameError, match="did you mean 'easyr1'"):
        export_set(folder, "easyr2", tmp_path / "x")


@pytest.mark.parametrize("format", ["llamafactory", "easyr1", "trl", "vlnce", "r2r"])
def test_a_failed_export_leaves_nothing_and_can_be_repeated(format, tmp_path):
    """A folder that a slip of the path had marked was refused to every other choice."""
    with pytest.raises(InputError):
        export_set(tmp_path / "no_set", format, tmp_path / "out")
    assert not (tmp_path / "out").exists()
    large = small_set(tmp_path / "large", width=1280, height=960)
    if format in ("llamafactory", "easyr1", "trl"):
        with pytest.raises(UsageError, match="export with a lower pixel limit"):
            export_set(large, format, tmp_path / "out", ExportOptions(max_pixels=1 << 24))
        assert not (tmp_path / "out").exists()
    assert export_set(large, format, tmp_path / "out").written


def broken(root, name, change):
    path = root / name
    rows = json.loads(path.read_text())
    change(rows[0])
    path.write_text(json.dumps(rows))


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (
            lambda row: row["messages"].reverse(),
            (r"row 0: user and assistant turns " r"must alternate, got \('assistant', "),
        ),
        (
            lambda row: row["messages"].pop(),
            (r"row 0: user and assistant turns " r"must alternate, got \('user',\)"),
        ),
        (
            lambda row: row["images"].pop(),
            ("row 0: the text has 1 <image> placeholders for 0 images"),
        ),
        (lambda row: row["images"].__setitem__(0, "images/x.jpg"), "image images/x.jpg not found"),
        (
            lambda row: row["images"].__setitem__(0, "../x.jpg"),
            ("must be a path inside the folder of the set"),
        ),
        (
            lambda row: row.pop("images"),
            (r"not have the structure that the " r"trainer expects \(KeyError: 'images'\)"),
        ),
        (lambda row: row.update(messages=[3]), "not have the structure that the trainer expects"),
    ],
)
def test_rows_that_llamafactory_would_drop_are_named(folder, tmp_path, change, reason):
    root = export_set(folder, "llamafactory", tmp_path / "out").out
    check_llamafactory(root)
    broken(root, "mcvln_next_action_base_train.json", change)
    with pytest.raises(DamagedFileError, match=reason):
        check_llamafactory(root)


def test_a_form_that_loses_the_prompt_is_named(folder, tmp_path):
    root = export_set(folder, "easyr1", tmp_path / "out").out
    check_easyr1(root, ".")
    (root / "mc.jinja").write_text("{{ problem }} Think.")
    with pytest.raises(
        DamagedFileError, match=("row 0: the text has 0 <image> placeholders for 1 images")
    ):
        check_easyr1(root, ".")


def test_text_that_holds_a_mark_is_named(folder, tmp_path):
    root = export_set(folder, "trl", tmp_path / "out").out
    path = root / "mcvln_next_action_base_train.jsonl"
    path.write_text(path.read_text().replace("Go ", "<image> ").replace("You see", "<image>"))
    with pytest.raises(DamagedFileError, match="row 0: a text must not contain <image>"):
        check_trl(root)
