"""A run as YAML: there and back, and what is refused."""

from dataclasses import replace

import pytest

from world2minecraft.core.errors import DamagedFileError, UnknownNameError, UsageError
from world2minecraft.networks.config import (
    PRESETS,
    DataSource,
    RunConfig,
    config_text,
    parse_config,
    read_config,
    write_config,
)

PLAIN = RunConfig("monoscene", (DataSource("sets/a"), DataSource("C:/b", 0.25)))


@pytest.mark.parametrize("config", [PLAIN, *(PLAIN.with_preset(name) for name in PRESETS)])
def test_a_run_comes_back_from_its_file(config, tmp_path):
    write_config(tmp_path / "run.yaml", config)
    assert read_config(tmp_path / "run.yaml") == config


def test_numbers_are_read_as_people_write_them():
    text = "network: iso\ndata: sets/a:3\ngrid: 0.08\nlearning_rate: 1e-4\nprecision: 32\nflip: 0\n"
    config = parse_config(text, "run.yaml")
    expected = RunConfig(
        "iso", (DataSource("sets/a", 3.0),), grid="0.08", learning_rate=1e-4, precision="32", flip=0
    )
    assert config == expected


@pytest.mark.parametrize(
    ("text", "path", "weight"),
    [("a", "a", 1.0), ("a:2", "a", 2.0), ("C:\\sets", "C:\\sets", 1.0), ("C:/a:0.5", "C:/a", 0.5)],
)
def test_a_weight_follows_the_last_colon(text, path, weight):
    assert DataSource.parse(text) == DataSource(path, weight)


GOLDEN = {
    "networ: iso\ndata: a": (
        UnknownNameError,
        "no setting is named 'networ'; did you mean 'network'?",
    ),
    "network: iso\ndata: a\nstep: 3": (
        UnknownNameError,
        "no setting is named 'step'; did you mean 'steps'?",
    ),
    "network: iso": (DamagedFileError, "run.yaml: missing settings: data"),
    "[]": (DamagedFileError, "run.yaml: contains no settings; expected network: NAME, data: ..."),
    "network: iso\ndata: a\nsteps: many": (
        DamagedFileError,
        "run.yaml: steps must be an integer, got 'many'",
    ),
    "network: iso\ndata: a\nsteps: true": (
        DamagedFileError,
        "run.yaml: steps must be an integer, got True",
    ),
    "network: iso\ndata: a\nsteps: 0": (UsageError, "steps must be from 1 to 1e+08, got 0"),
    "network: iso\ndata: a\ngrid: 0.8": (
        UnknownNameError,
        "no grid is named '0.8'; did you mean '0.08'?",
    ),
    "network: iso\ndata:\n- path: a\n  wait: 2": (
        UnknownNameError,
        "no data setting is named 'wait'; did you mean 'weight'?",
    ),
    "network: iso\ndata: a:0": (UsageError, "the weight of a must be above 0 and finite, got 0"),
    "network: iso\ndata: a:inf": (
        UsageError,
        "the weight of a must be above 0 and finite, got inf",
    ),
    "network: iso\ndata: []": (
        UsageError,
        "no training data; add a data set from w2m dataset build (--data DIR)",
    ),
}


@pytest.mark.parametrize("text", GOLDEN)
def test_invalid_settings_are_reported(text):
    kind, message = GOLDEN[text]
    with pytest.raises(kind) as caught:
        parse_config(text, "run.yaml")
    assert str(caught.value) == message


def test_invalid_yaml_is_reported_in_one_line():
    with pytest.raises(DamagedFileError, match="not valid YAML") as caught:
        parse_config("a: [", "run.yaml")
    assert "\n" not in str(caught.value)


def test_the_file_keeps_the_order_of_the_settings():
    names = [line.split(":")[0] for line in config_text(PLAIN).splitlines() if line[0].isalpha()]
    assert names[:4] == ["network", "data", "size", "backbone"]
    assert replace(PLAIN).cells.shape == (30, 30, 18)
