"""The commands that are run on both sides, by steps.

A command is what stands after ``w2m``, in the words of the base; ``declared`` turns it into those
of the tree. What a step is given comes from the base, on both sides: so each step tells of itself
alone, and the tree opens what the base wrote.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from compare_outputs.acting import Act, Edit, Frames, Given, Grow, Labels, Shared


@dataclass(frozen=True)
class Step:
    """Some commands in one folder.

    commands: words, or acts. given: what is laid into the folder first, by its name there: a text
    ``STEP/PATH`` is what that step wrote. codes: exit codes other than 0, by the command's number.
    needs: modules that must be there. folder is compared whole, but for ``aside``.
    """

    name: str
    commands: tuple[str | Act, ...]
    given: Mapping[str, str | Given] = field(default_factory=dict)
    is_fast: bool = False
    codes: Mapping[int, int] = field(default_factory=dict)
    needs: tuple[str, ...] = ()

    @property
    def before(self) -> tuple[str, ...]:
        """The names of the steps that this one takes something from."""
        return tuple(one.split("/")[0] for one in self.given.values() if isinstance(one, str))

    @property
    def needs_shared(self) -> bool:
        """Whether it needs the shared real inputs."""
        return any(isinstance(one, (Frames, Labels, Shared)) for one in self.given.values())


EDITS = (
    ("GET", "/api/scene", ""),
    ("POST", "/api/ask/holes", "{}"),
    ("POST", "/api/ask/floaters", '{"max_cells": 8}'),
    ("POST", "/api/ask/doubtful", "{}"),
    ("POST", "/api/do", '{"op": "remove_floaters", "max_cells": 8}'),
    ("POST", "/api/do", '{"op": "fill_holes", "plane": "floor"}'),
    ("POST", "/api/do", '{"op": "add_object", "class_id": 5, "at_m": [1.5, 1.5, 0.0]}'),
    ("POST", "/api/do", '{"op": "turn_objects", "ids": [1], "quarter_turns": 1}'),
    ("POST", "/api/do", '{"op": "delete_objects", "ids": [2]}'),
    ("POST", "/api/undo", "{}"),
    ("POST", "/api/undo", "{}"),
    ("POST", "/api/redo", "{}"),
    ("POST", "/api/do", '{"op": "no_such_thing"}'),
    ("POST", "/api/save", "{}"),
)

STEPS: tuple[Step, ...] = (
    Step("demo", ("demo --out OUT",), is_fast=True),
    Step(
        "kitchen",
        ("reconstruct kitchen --out OUT --formats litematic,nbt,glb,mcstructure",),
        {"kitchen": Frames(2)},
        is_fast=True,
    ),
    Step(
        "kitchen-paper",
        ("reconstruct kitchen --out OUT --method paper",),
        {"kitchen": Frames(4)},
        is_fast=True,
    ),
    Step(
        "kitchen-labels",
        ("reconstruct kitchen --out OUT --labels labels --style display",),
        {"kitchen": Frames(4), "labels": Labels(4)},
        is_fast=True,
    ),
    Step(
        "roomplan",
        ("scan Room.json", "reconstruct Room.json --out OUT"),
        {"Room.json": Shared("real_captures/roomplan_library/Room.json")},
        is_fast=True,
    ),
    Step(
        "join",
        ("join one two --out HOME --at two=9,0,1",),
        {"one": "demo/OUT", "two": "kitchen/OUT"},
        is_fast=True,
    ),
    Step(
        "live",
        (Grow("reconstruct growing --out OUT --follow", "scan", "growing"),),
        {"scan": "demo/OUT/capture"},
    ),
    Step(
        "again",
        (
            "reconstruct OUT/capture --out OUT",
            "reconstruct OUT/capture --out OUT --from build --blocks-per-metre 2",
            "reconstruct OUT/capture --out OUT --from label --labeller geometric",
        ),
        {"OUT": "demo/OUT"},
        is_fast=True,
    ),
    Step(
        "edit",
        (
            Edit("OUT", EDITS),
            "forge stats OUT --json",
            "build OUT --out second",
            "convert second edited.schem",
            "clean second --list",
            "clean second --undo-all",
        ),
        {"OUT": "demo/OUT"},
        is_fast=True,
    ),
    Step(
        "into-world",
        (
            "build OUT --into world --at 4 70 -9 --turns 1 --new-chunks",
            "undo world --list",
            "build house.schem --into world --at 40 70 40 --new-chunks",
            "undo world",
            "undo world --list",
            "undo world --blocks",
        ),
        {
            "OUT": "roomplan/OUT",
            "world": "demo/OUT/build/world",
            "house.schem": Shared("mcprefab_builds/house_basic.schem"),
        },
        is_fast=True,
    ),
    Step(
        "evaluate",
        ("evaluate reconstruction OUT OUT/capture --json scores.json",),
        {"OUT": "demo/OUT"},
        is_fast=True,
    ),
    Step(
        "compare",
        (
            "compare layouts layouts.json OUT --truth OUT/capture --json compared.json",
            "compare build layouts.json --out ROOMS --count 2",
            "compare layouts ROOMS/* --scenes --markdown",
            "compare describe OUT",
            "compare describe OUT --for layoutvlm --out room.json",
        ),
        {
            "OUT": "demo/OUT",
            "layouts.json": Shared("layoutgpt_outputs/gpt4.bedroom.k-similar.k_8.px_regular.json"),
        },
        is_fast=True,
    ),
    Step(
        "paper",
        (
            "paper",
            "paper all --json",
            "paper all --markdown",
            "paper all --latex",
            "paper figure OUT --out figure.png",
        ),
        {"OUT": "demo/OUT"},
        is_fast=True,
    ),
    Step(
        "render",
        (
            "render OUT --out ray.png --size 320x200",
            "render OUT --out exr --pose 4,64,-3,90,10 --outputs all --depth-format exr"
            " --size 160x100",
            "render OUT --out tour --tour --frames 4 --size 160x100 --outputs rgb,depth,id"
            " --jobs 2",
            "render OUT --out again --poses tour/poses.jsonl --format webp",
            "render OUT --out photo.png --photo --photo-samples 2 --size 96x64",
        ),
        {"OUT": "demo/OUT"},
        is_fast=True,
    ),
    Step(
        "convert",
        (
            "convert OUT room.schem",
            "convert OUT room.litematic",
            "convert OUT room.nbt",
            "convert OUT room.zip",
            "convert OUT room.mcfunction",
            "convert OUT room.mcstructure",
            "convert OUT room.glb",
            "convert OUT room.habitat",
            "convert house.litematic house-world",
        ),
        {
            "OUT": "demo/OUT",
            "house.litematic": Shared("litemapy_litematics/SimpleHouse.litematic"),
        },
        is_fast=True,
    ),
    Step(
        "dataset",
        ("dataset build DATA --houses 4 --images 16 --size 160x120 --jobs 1",),
        is_fast=True,
    ),
    Step(
        "dataset-exports",
        (
            "dataset verify DATA",
            "dataset stats DATA --json stats.json --latex table.tex --plots PLOTS -j 1",
            "dataset export DATA --format nyu --out NYU",
            "dataset export DATA --format occscannet --out OCC",
            "dataset export DATA --format embodied --out EMB",
            "dataset export DATA --format npz --out NPZ --limit 4",
            "dataset show DATA --picture look.png",
        ),
        {"DATA": "dataset/DATA"},
        is_fast=True,
    ),
    Step(
        "navigation",
        ("vln build OUT --out SET --trajectories 4 --size 160x90 --workers 1",),
        {"OUT": "demo/OUT"},
        is_fast=True,
    ),
    Step(
        "navigation-exports",
        (
            "vln stats SET --json stats.json --plot lengths.png",
            *(
                f"vln export SET --to {to} --out {to}"
                for to in ("llamafactory", "easyr1", "trl", "vlnce", "r2r")
            ),
            "vln evaluate SET --agent oracle --split all --out ORACLE",
            "vln evaluate SET --agent blind --split all --out BLIND",
            "vln table ORACLE BLIND --markdown",
        ),
        {"SET": "navigation/SET"},
        is_fast=True,
    ),
    Step(
        "walk",
        ('vln run OUT "Go to the table" --out WALK', "vln table WALK"),
        {"OUT": "demo/OUT"},
        is_fast=True,
    ),
    Step(
        "train",
        (
            "train monoscene --data DATA --out RUN --preset smoke --threads 1 --device cpu",
            "export RUN --out net.onnx",
        ),
        {"DATA": "dataset/DATA"},
        is_fast=True,
        needs=("torch", "onnx"),
    ),
)
