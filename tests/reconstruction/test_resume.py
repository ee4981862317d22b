"""What ``--from STAGE`` keeps stays as it was told then; what contradicts it is refused."""

import json
from dataclasses import fields

import pytest

from world2minecraft.core.errors import DamagedFileError, InputError, UsageError
from world2minecraft.reconstruction.parameters import Parameters, first_reader, with_settings
from world2minecraft.reconstruction.pipeline import STAGES
from world2minecraft.reconstruction.resume import (
    Resumed,
    resume_manifest,
    resume_parameters,
)

THEN = ["voxel_m=0.1", "find.cluster_radius=3", "capture.every=2", "blocks_per_metre=2"]
FILES = {"capture": "c", "labels": "l", "plan": None, "predictions": "p", "networks": []}


def told(folder, parameters, **more):
    """Leave the manifest of a run in a folder."""
    facts = {**FILES, "parameters": parameters, **more}
    (folder / "manifest.json").write_text(json.dumps(facts))


def then(*settings) -> dict:
    return with_settings(Parameters(known=("table height", 0.72)), [*THEN, *settings]).as_json()


def test_every_parameter_has_a_stage_that_reads_it_first():
    assert {first_reader(entry.name) for entry in fields(Parameters)} <= set(STAGES)
    assert first_reader("find.min_cells") == "find" and first_reader("gone.min_cells") == ""
    assert first_reader("fuse.voxel_m") == "", "it is a copy of voxel_m"


def test_what_is_left_out_stays_as_it_was(tmp_path):
    told(tmp_path, then())
    kept = resume_parameters(tmp_path, "build", STAGES, Parameters())
    parameters = kept.parameters
    assert (parameters.voxel_m, parameters.fuse.voxel_m) == (0.1, 0.1)
    assert parameters.find.cluster_radius == 3 and parameters.capture == {"every": "2"}
    assert parameters.known == ("table height", 0.72)
    assert parameters.blocks_per_metre == 4, "the build is made anew, as asked"
    assert kept.notes[0].startswith("kept from the earlier run: voxel_m=0.1, known=")


def test_stages_that_run_again_read_what_is_asked(tmp_path):
    told(tmp_path, then())
    assert (
        resume_parameters(tmp_path, "find", STAGES, Parameters()).parameters.find.cluster_radius
        == 2
    )
    assert resume_parameters(tmp_path, "scan", STAGES, Parameters()) == Resumed(Parameters())
    assert resume_parameters(tmp_path, None, STAGES, Parameters()) == Resumed(Parameters())
    assert (
        resume_parameters(tmp_path, "report", STAGES, Parameters()).parameters.blocks_per_metre == 2
    )


def test_what_is_given_again_is_no_note(tmp_path):
    told(tmp_path, then())
    again = with_settings(Parameters(known=("table height", 0.72)), THEN)
    assert resume_parameters(tmp_path, "build", STAGES, again).notes == ()


@pytest.mark.parametrize(
    ("start", "setting", "was", "now", "stage"),
    [
        ("build", "find.cluster_radius=4", "3.0", "4.0", "find"),
        ("label", "stereo.planes=9", "64", "9", "scan"),
        ("report", "blocks_per_metre=1", "2.0", "1.0", "build"),
    ],
)
def test_what_contradicts_kept_stages_is_refused(tmp_path, start, setting, was, now, stage):
    told(tmp_path, then())
    key = setting.partition("=")[0]
    with pytest.raises(UsageError) as caught:
        resume_parameters(tmp_path, start, STAGES, with_settings(Parameters(), [setting]))
    assert str(caught.value) == (
        f"starting at {start} keeps results made with {key}={was}, got {now}; "
        f"omit {key}, or start at {stage} (--from)"
    )


def test_files_that_kept_stages_read_are_told_as_they_were(tmp_path):
    told(tmp_path, then())
    now = {"capture": "c", "labels": None, "plan": None, "networks": [], "palette": "p"}
    now["predictions"] = "q"
    kept = resume_parameters(tmp_path, "label", STAGES, Parameters())
    assert resume_manifest(tmp_path, "label", now, kept) == {
        **now,
        "labels": "l",
        "predictions": "p",
    }
    kept = resume_parameters(tmp_path, "fuse", STAGES, Parameters())
    assert resume_manifest(tmp_path, "fuse", now, kept) == now, "fuse reads labels anew"
    with pytest.raises(InputError, match="made from another capture, or the capture has changed"):
        resume_manifest(tmp_path, "fuse", {**now, "capture": "d"}, kept)
    kept = resume_parameters(tmp_path, "build", STAGES, Parameters())
    with pytest.raises(UsageError, match="without these labels; start at fuse"):
        resume_manifest(tmp_path, "build", {**now, "labels": "m"}, kept)


def test_a_manifest_of_another_version_or_a_broken_one(tmp_path):
    assert resume_parameters(tmp_path, "build", STAGES, Parameters()) == Resumed(Parameters())
    (tmp_path / "manifest.json").write_text("{")
    assert resume_parameters(tmp_path, "build", STAGES, Parameters()) == Resumed(Parameters())
    told(tmp_path, {"no longer": 1, "find": {"gone": 2}, "capture": {}})
    assert resume_parameters(tmp_path, "build", STAGES, Parameters()).parameters == Parameters()
    told(tmp_path, {"find": {"cluster_radius": "wide"}})
    with pytest.raises(DamagedFileError, match="an invalid value for cluster_radius: 'wide'"):
        resume_parameters(tmp_path, "build", STAGES, Parameters())
