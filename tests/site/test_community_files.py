"""Issue forms, the pull request template and the workflow: they parse, and what they run exists."""

import os
import re
import shlex
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
GITHUB = ROOT / ".github"
YAML_FILES = sorted(GITHUB.rglob("*.yml"))
FORMS = [
    path for path in YAML_FILES if path.parent.name == "ISSUE_TEMPLATE" and path.stem != "config"
]
WORKFLOWS = sorted((GITHUB / "workflows").glob("*.yml"))
MAKEFILE = (ROOT / "Makefile").read_text()
KINDS = {"markdown", "input", "textarea", "dropdown", "checkboxes"}
SYSTEM_COMMANDS = {"apt-get"}  # Of the image that a job runs in.


@pytest.mark.parametrize("path", YAML_FILES, ids=lambda path: path.name)
def test_yaml_files_parse(path):
    assert isinstance(yaml.safe_load(path.read_text()), dict)


@pytest.mark.parametrize("path", FORMS, ids=lambda path: path.name)
def test_an_issue_form_has_named_fields(path):
    form = yaml.safe_load(path.read_text())
    assert form["name"] and form["description"] and form["body"]
    fields = [field for field in form["body"] if field["type"] != "markdown"]
    assert {field["type"] for field in form["body"]} <= KINDS
    ids = [field["id"] for field in fields]
    assert len(set(ids)) == len(ids)
    assert all(field["attributes"]["label"] for field in fields)
    assert any(field.get("validations", {}).get("required") for field in fields)
    for field in fields:
        if field["type"] in ("dropdown", "checkboxes"):
            assert len(field["attributes"]["options"]) > 1


def test_there_are_forms_and_a_workflow():
    assert [path.stem for path in FORMS] == ["bug_report", "feature_request", "wrong_room"]
    assert [path.name for path in WORKFLOWS] == ["ci.yml"]


def jobs():
    for path in WORKFLOWS:
        yield from yaml.safe_load(path.read_text())["jobs"].items()


def commands():
    for _, job in jobs():
        for step in job["steps"]:
            for line in step.get("run", "").splitlines():
                yield from (shlex.split(part) for part in line.split("&&"))


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.name)
def test_a_workflow_reads_only_and_runs_once(path):
    workflow = yaml.safe_load(path.read_text())
    assert workflow["permissions"] == {"contents": "read"}
    assert workflow["concurrency"]["cancel-in-progress"] is True
    used = [step["uses"] for _, job in jobs() for step in job["steps"] if "uses" in step]
    assert used and all(re.fullmatch(r"actions/[\w-]+@v\d+", name) for name in used)
    assert all(job["timeout-minutes"] for _, job in jobs())


def test_the_workflow_covers_three_systems():
    named = dict(jobs())
    systems = [named["linux"]["runs-on"], *named["desktop"]["strategy"]["matrix"]["os"]]
    assert [system.partition("-")[0] for system in systems] == ["ubuntu", "macos", "windows"]


def test_the_commands_of_the_workflow_exist():
    found = list(commands())
    assert [".ci/run"] in found
    for program, *words in found:
        if program == "make":
            targets = [word for word in words if "=" not in word]
            assert all(re.search(rf"^{target}:", MAKEFILE, re.MULTILINE) for target in targets)
        elif program not in SYSTEM_COMMANDS:
            assert os.access(ROOT / program, os.X_OK), program


@pytest.mark.parametrize(
    "name", ["SECURITY.md", "CODE_OF_CONDUCT.md", ".github/PULL_REQUEST_TEMPLATE.md"]
)
def test_links_of_community_pages_lead_somewhere(name):
    links = re.findall(r"\]\(([^)#]+)", (ROOT / name).read_text())
    local = [link for link in links if "://" not in link]
    assert not [link for link in local if not (ROOT / name).parent.joinpath(link).is_file()]


def test_the_changelog_keeps_its_form():
    text = (ROOT / "CHANGELOG.md").read_text()
    versions = re.findall(r"^## (.+)$", text, re.MULTILINE)
    assert versions[0] == "[Unreleased]"
    assert all(re.fullmatch(r"\[\d+\.\d+\.\d+\] - \d{4}-\d\d-\d\d", name) for name in versions[1:])
    order = ["Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"]
    for body in re.split(r"^## .+$", text, flags=re.MULTILINE)[1:]:
        named = re.findall(r"^### (.+)$", body, re.MULTILINE)
        assert named == [name for name in order if name in named]
        lines = [line for line in body.splitlines() if line and not line.startswith("### ")]
        assert all(line.startswith("- ") for line in lines)
