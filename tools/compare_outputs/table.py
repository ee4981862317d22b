"""The commands that are run on both sides, by steps.

A command is what stands after ``w2m``, in the words of the base; ``declared`` turns it into those
of the tree. What a step is given comes from the base, on both sides: so each step tells of itself
alone, and the tree opens what the base wrote.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from compare_outputs.acting import (
    Act,
    Edit,
    Frames,
    Given,
    Grow,
    Kill,
    Labels,
    Script,
    Shared,
    Text,
)
from compare_outputs.servers import ECHO, Console, Model


@dataclass(frozen=True)
class Step:
    """Some commands in one folder.

    commands: words, or acts. given: what is laid into the folder first, by its name there: a text
    ``STEP/PATH`` is what that step wrote. codes: exit codes other than 0, by the command's number.
    needs: modules that must be there. skipped_by: words of an error of the base's by which the
    machine lacks what the step needs. is_given: only the base runs it, for other steps to go on
    from what it left.
    """

    name: str
    commands: tuple[str | Act, ...]
    given: Mapping[str, str | Given] = field(default_factory=dict)
    is_fast: bool = False
    codes: Mapping[int, int] = field(default_factory=dict)
    needs: tuple[str, ...] = ()
    skipped_by: str = ""
    is_given: bool = False

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

_DATASET = "dataset build DATA --houses 4 --images 16 --size 160x120 --jobs 1"
_VERBS = (
    "demo", "scan", "reconstruct", "build", "forge", "forge stats", "join", "rooms generate",
    "rooms scan", "evaluate reconstruction", "evaluate scannet", "occupy", "train", "export",
    "evaluate occupancy", "dataset stats", "dataset quality", "furniture list", "furniture show",
    "furniture add", "furniture sheet", "palettes", "dataset map", "render", "dataset export",
    "dataset import", "dataset show", "convert", "clean", "install", "undo", "dataset build",
    "dataset rooms", "dataset verify", "dataset tour", "dataset sheet", "vln build", "vln reword",
    "vln stats", "vln export", "vln run", "vln annotate", "vln server", "vln evaluate", "vln table",
    "compare layouts", "compare build", "compare judge", "compare describe", "paper",
    "paper figure", "doctor",
)  # fmt: skip


def _all_of(step: str, names: str) -> dict[str, str | Given]:
    """Return what a step is given where it goes on in another one's folder."""
    return {name: f"{step}/{name}" for name in names.split()}


FAST = (
    Step("demo", ("demo --out OUT",)),
    Step(
        "kitchen",
        ("reconstruct kitchen --out OUT --formats litematic,nbt,glb,mcstructure",),
        {"kitchen": Frames(2)},
    ),
    Step(
        "kitchen-paper",
        ("reconstruct kitchen --out OUT --method paper",),
        {"kitchen": Frames(4)},
    ),
    Step(
        "kitchen-labels",
        ("reconstruct kitchen --out OUT --labels labels --style display",),
        {"kitchen": Frames(4), "labels": Labels(4)},
    ),
    Step(
        "roomplan",
        ("scan Room.json", "reconstruct Room.json --out OUT"),
        {"Room.json": Shared("real_captures/roomplan_library/Room.json")},
    ),
    Step(
        "join",
        ("join one two --out HOME --at two=9,0,1",),
        {"one": "demo/OUT", "two": "kitchen/OUT"},
    ),
    Step(
        "again",
        (
            "reconstruct OUT/capture --out OUT",
            "reconstruct OUT/capture --out OUT --from build --blocks-per-metre 2",
            "reconstruct OUT/capture --out OUT --from label --labeller geometric",
        ),
        {"OUT": "demo/OUT"},
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
    ),
    Step(
        "evaluate",
        ("evaluate reconstruction OUT OUT/capture --json scores.json",),
        {"OUT": "demo/OUT"},
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
    ),
    Step(
        "dataset",
        (_DATASET,),
    ),
    Step(
        "dataset-exports",
        (
            "dataset verify DATA",
            "dataset stats DATA --json stats.json --latex table.tex --plots PLOTS -j 1",
            "dataset export DATA --format nyu --out NYU",
            "dataset export DATA --format occscannet --out OCC",
            "dataset export DATA --format embodied --out EMB",
            "dataset export DATA --format npz --out NPZ",
            "dataset show DATA --picture look.png",
        ),
        {"DATA": "dataset/DATA"},
    ),
    Step(
        "navigation",
        ("vln build OUT --out SET --trajectories 4 --size 160x90 --workers 1",),
        {"OUT": "demo/OUT"},
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
    ),
    Step(
        "walk",
        ('vln run OUT "Go to the table" --out WALK', "vln table WALK"),
        {"OUT": "demo/OUT"},
    ),
    Step(
        "train",
        (
            "train monoscene --data DATA --out RUN --preset smoke --threads 1 --device cpu",
            "export RUN --out net.onnx",
        ),
        {"DATA": "dataset/DATA"},
        needs=("torch", "onnx"),
    ),
)

# What a run of the base left is gone on with: killed, edited or built, and then as if nothing were.
_STOPPED = "train --config config.yaml --out RUN"
_CONFIG = """\
network: {network}
data: [{{path: DATA, weight: 1.0}}]
size: tiny
image: [96, 72]
steps: 20
batch: 2
warmup_steps: 2
validate_every: 10
validate_frames: 8
checkpoint_every: 4
threads: 1
"""
LEFT = (
    Step(
        "left-run",
        (Kill("reconstruct kitchen --out OUT", "OUT/evidence.npz"),),
        {"kitchen": Frames(4)},
        is_given=True,
    ),
    Step(
        "left-run-goes-on", ("reconstruct kitchen --out OUT",), _all_of("left-run", "kitchen OUT")
    ),
    Step(
        "left-dataset",
        (Kill(_DATASET, "DATA/shards/*/*.part"),),
        is_given=True,
    ),
    Step(
        "left-dataset-goes-on", (_DATASET, "dataset verify DATA"), _all_of("left-dataset", "DATA")
    ),
    Step(
        "left-training",
        (Kill(_STOPPED, "RUN/checkpoint.safetensors"),),
        {"DATA": "dataset/DATA", "config.yaml": Text(_CONFIG.format(network="embodied"))},
        needs=("torch",),
        is_given=True,
    ),
    Step(
        "left-training-goes-on",
        (_STOPPED,),
        _all_of("left-training", "DATA config.yaml RUN"),
        needs=("torch",),
    ),
    Step("left-edits", (Edit("OUT", EDITS[4:10]),), {"OUT": "demo/OUT"}, is_given=True),
    Step(
        "left-edits-go-on",
        (Edit("OUT", (*EDITS[:1], *EDITS[9:12], ("POST", "/api/save", "{}"))), "build OUT --out B"),
        _all_of("left-edits", "OUT OUT.forge"),
    ),
    Step(
        "left-in-world",
        ("build OUT --into world --at 4 70 -9 --new-chunks", "build OUT --into world --at 60 70 0"),
        {"OUT": "roomplan/OUT", "world": "dataset/DATA/worlds/house_0001/world"},
        is_given=True,
    ),
    Step(
        "left-in-world-undone",
        ("undo world --list", "undo world"),
        _all_of("left-in-world", "world"),
    ),
    Step(
        "left-network",
        (
            "evaluate occupancy RUN DATA --device cpu --json scores.json --latex rows.tex",
            "evaluate occupancy RUN/last.safetensors DATA --device cpu --protocol monoscene",
            "evaluate occupancy net.onnx DATA --json onnx.json --protocol monoscene",
            "export RUN --out int8.onnx --weights int8",
            "train monoscene --data DATA --out RUN --preset smoke --threads 1 --device cpu",
            "train --config RUN/run.yaml --out AGAIN --device cpu",
        ),
        _all_of("train", "RUN DATA net.onnx"),
        needs=("torch", "onnx"),
    ),
)

_FRAME = "house_0002-r01t000-000000"
CAPTURES = (
    Step(
        "photos",
        ("scan photos", "reconstruct photos --out OUT"),
        {"photos": Frames(1, False, False)},
    ),
    Step(
        "photos-with-poses",
        ("reconstruct photos --out OUT --set capture.every=2",),
        {"photos": Frames(1, with_depth=False)},
    ),
    Step(
        "kitchen-mono",
        (
            "reconstruct kitchen --out OUT --predictor mono",
            "occupy kitchen --out occupied.npz --predictor mono",
        ),
        {"kitchen": Frames(8)},
    ),
    Step(
        "kitchen-by-set",
        (
            "scan kitchen --json",
            "scan kitchen --picture look.png",
            "reconstruct kitchen --out OUT --voxel 0.12 --blocks-per-metre 12.5 --style voxels"
            " --mc-version 1.21.4 --set find.cluster_radius=3 --set capture.every=4"
            " --set build.lights=lamps --set mend=no",
            "reconstruct kitchen --out OUT --from no_such_stage",
            "reconstruct kitchen --out OUT --set no.such=1",
        ),
        {"kitchen": Frames(1)},
        codes={3: 2, 4: 2},
    ),
    Step(
        "plan-beside-scan",
        ("reconstruct kitchen --out OUT --plan Room.json",),
        {
            "kitchen": Frames(4),
            "Room.json": Shared("real_captures/roomplan_library/Room.json"),
        },
        codes={0: 3},
    ),
    Step(
        "cloud",
        ("scan flat.ply", "reconstruct flat.ply --out OUT"),
        {"flat.ply": Shared("real_captures/scene0000_cloud/scene0000_00.ply")},
    ),
    Step(
        "other-captures",
        (
            "reconstruct lounge --out lounge-out",
            "reconstruct living --out living-out",
            "scan rgbd --json",
            "reconstruct unposed --out unposed-out",
            "scan sun --no-picture",
        ),
        {
            "lounge": Shared("real_captures/sun3d_lounge"),
            "living": Shared("real_captures/nyu_frames/living"),
            "rgbd": Shared("open3d_rgbd_samples/RGBD"),
            "unposed": Shared("aims_realsense_unposed"),
            "sun": Shared("real_captures/sunrgbd_kv2"),
        },
    ),
    Step(
        "refusals",
        (
            "reconstruct bedroom --out OUT",
            "reconstruct bathroom.ply --out OUT",
            "reconstruct Room.usdz --out OUT",
            "reconstruct nothing --out OUT",
            "scan empty.txt",
            "no-such-verb",
            "render nothing --no-such-option",
        ),
        {
            "bedroom": Shared("real_captures/vggt_bedroom"),
            "bathroom.ply": Shared("real_captures/scaniverse_bathroom/bathroom.ply"),
            "Room.usdz": Shared("real_captures/roomplan_library/Room.usdz"),
            "empty.txt": Text(""),
        },
        codes={0: 3, 1: 3, 2: 3, 3: 3, 4: 3, 5: 2, 6: 2},
    ),
    Step(
        "live",
        (Grow("reconstruct growing --out OUT --follow", "scan", "growing"),),
        {"scan": Frames(4)},
    ),
    Step(
        "rooms",
        (
            "rooms generate --seed 7 --kind bathroom --shape ell --clutter 0.5 --out room",
            "rooms generate --house --rooms 4 --storeys 2 --seed 3 --out house",
            "rooms generate --houses 1 --seed 1 --worlds WORLDS --style castle",
            "rooms scan room --out capture --frames 6 --labels --label-error 0.1"
            " --depth-scale-sigma 0.03 --coverage 0.6",
            "rooms scan --seed 7 --sensor photos --frames 4 --out photos",
            "rooms scan --seed 7 --sensor video --frames 16 --out video",
            "scan video --no-picture",
        ),
    ),
    Step(
        "trial",
        (
            "rooms scan --trial noise-500 --out trial",
            "reconstruct trial --out OUT --labels trial/labels",
            "evaluate reconstruction OUT trial --stages --json scores.json",
            "occupy trial --out occupied.npz",
        ),
    ),
    Step(
        "occupy-frame",
        (
            f"occupy NYU/{_FRAME}.png --grid NYU/{_FRAME}.bin --out depth.npz",
            f"occupy NYU/{_FRAME}.png --grid NYU/{_FRAME}.bin --out both.npz"
            f" --colour NYU/{_FRAME}_color.jpg",
            f"occupy NYU/{_FRAME}_color.jpg --grid NYU/{_FRAME}.bin --out photo.npz"
            " --predictor mono",
        ),
        {"NYU": "dataset-exports/NYU/NYUtest"},
    ),
)

BUILDS = (
    Step(
        "builds",
        (
            "build OUT --out fine --style voxels --blocks-per-metre 12.5",
            "build OUT --out display --style display --mc-version 1.21.4"
            " --formats litematic,nbt,glb,mcstructure",
            "build OUT --out small --palette refurbished_furniture --blocks-per-metre 1",
            "build OUT --out seven --blocks-per-metre 7 --set build.ceiling=glass"
            " --set build.lights=lamps --set build.plaque=Home",
            "build OUT/room.npz --out of-grid",
            "build OUT/occ.json --out of-occ",
            "install fine --saves saves --name Fine",
            "install fine --saves saves --name Fine",
            "install --list",
        ),
        {"OUT": "demo/OUT"},
    ),
    Step(
        "cleaning",
        (
            "clean OUT --list",
            "clean OUT --undo 1",
            "clean OUT --redo 1",
            "clean OUT --undo-all",
            "clean OUT --dry-run",
            "clean OUT",
        ),
        {"OUT": "demo/OUT"},
    ),
    Step(
        "server",
        (
            Console("build OUT --rcon localhost:{port} --at 0 70 0 --turns 1"),
            Console("build house.schem --rcon localhost:{port} --at 0 70 0 --air box"),
        ),
        {"OUT": "roomplan/OUT", "house.schem": Shared("mcprefab_builds/house_cabin.schem")},
    ),
    Step(
        "builds-of-others",
        (
            "convert a.schem a-world",
            "convert a-world a.nbt --box 0,-64,0,9,120,9",
            "convert a.schem a3.schem --schem-version 3",
            "convert a.schem a.mcstructure --mc-version 1.21.4",
            "convert b.nbt b.litematic",
            "convert c.litematic c.glb --blocks-per-metre 1 --labels vanilla",
            "convert d.litematic d.schem",
            "build a.schem --into a-world --at 50 70 0 --new-chunks",
        ),
        {
            "a.schem": Shared("mcprefab_builds/house_izba.schem"),
            "b.nbt": Shared("mvs_structures_nbt/barn.nbt"),
            "c.litematic": Shared("litemapy_litematics/SimpleHouse.litematic"),
            "d.litematic": Shared("litemapy_litematics/ArmorStand.litematic"),
        },
    ),
    Step(
        "furniture",
        (
            "furniture list --markdown",
            "furniture show sofa --picture sofa.png",
            "furniture sheet --class objs --out sheet.png",
            "furniture add house.schem --class furn --blocks-per-metre 4 --front south",
            "furniture list house",
            "build OUT --out built",
            "palettes",
            "palettes tmeo",
            "dataset map",
            "dataset map --map paper --json paper.json",
            "dataset map oak_planks tmeo_ultra:yigui_1x_2",
        ),
        {"house.schem": Shared("mcprefab_builds/house_basic.schem"), "OUT": "roomplan/OUT"},
    ),
    Step(
        "editor",
        (
            Edit(
                "OUT",
                (
                    ("GET", "/api/commands", ""),
                    ("GET", "/api/volume", ""),
                    ("GET", "/api/volume?what=colour", ""),
                    ("GET", "/api/build", ""),
                    ("GET", "/api/collision", ""),
                    ("POST", "/api/ask/alternatives", '{"id": 1}'),
                    ("POST", "/api/ask/warnings", "{}"),
                    ("POST", "/api/preview", '{"op": "smooth"}'),
                    ("POST", "/api/do", '{"op": "smooth"}'),
                    ("POST", "/api/do", '{"op": "duplicate_object", "id": 1}'),
                    ("POST", "/api/do", '{"op": "rematch", "ids": [1, 2, 3]}'),
                    ("POST", "/api/do", '{"op": "split_object", "id": 1, "parts": 2}'),
                    ("POST", "/api/do", '{"op": "relabel_class", "from_id": 8, "to_id": 10}'),
                    (
                        "POST",
                        "/api/do",
                        '{"op": "recluster", "density_kernel": 3,'
                        ' "density_threshold": 0.3, "cluster_radius": 4}',
                    ),
                    ("GET", "/api/exports", ""),
                    *(("EXPORT", form, "{}") for form in ("world", "schem", "glb", "png")),
                    *(("EXPORT", form, "{}") for form in ("npz", "occ", "centers", "stats")),
                    ("POST", "/api/save", "{}"),
                ),
            ),
            "forge stats OUT --latex",
        ),
        {"OUT": "demo/OUT"},
    ),
)

_POSES = "x,y,z,yaw,pitch\n4,65.6,-3,90,10\n6,65.6,-5,180,0\n"
_BATCH = """\
import hashlib
from pathlib import Path
import numpy as np
from world2minecraft.coordinates import look_at
from world2minecraft.exchange.source import read_source
from world2minecraft.render import LookLight, prepare_scene, render_volume
from world2minecraft.render.batch import RenderPool, render_batch
from world2minecraft.types import Camera

def main():
    volume = read_source(Path("OUT")).volume
    scene = prepare_scene(volume)
    camera = Camera(96, 64, 60.0, 60.0, 48.0, 32.0)
    target = np.array([2.0, 3.0, 0.8])
    poses = np.stack([look_at(np.array([1 + n / 4, 1, 1.5]), target) for n in range(4)])
    outputs = ("colour", "depth", "range", "block", "face", "semantic", "instance")
    light = LookLight(exposure=1.2)
    batch = render_batch(scene, camera, poses, outputs=outputs, light=light)
    arrays = {name: one for name, one in vars(batch).items() if isinstance(one, np.ndarray)}
    np.savez("batch.npz", **arrays)
    one = render_volume(scene, camera, poses[0], samples=2)
    np.savez("one.npz", colour=one.colour, depth=one.depth_m)
    with RenderPool(scene, workers=2) as pool:
        for number, picture in pool.render(camera, poses):
            print(number, hashlib.sha256(picture.depth_m.tobytes()).hexdigest())

if __name__ == "__main__":
    main()
"""
PICTURES = (
    Step(
        "pictures",
        (
            "render OUT --turntable --frames 3 --out turn.gif --size 96x64",
            "render OUT --orbit --frames 3 --out orbit --format webp --size 160x100 --closed",
            "render OUT --tour --frames 5 --out tour.mp4 --size 96x64",
            "render OUT --poses poses.csv --out npy --outputs all --depth-format npy --size 96x64"
            " --light game --hour 21 --sun-shadow --samples 3",
            "render OUT --out neutral.jpg --light neutral --hfov 90 --textures 32 --size 160x100",
            "render house.schem --out house.png --size 160x100 --box 0,0,0,9,6,9",
            "render OUT --out photo.exr --photo --photo-samples 1 --size 64x48 --hour 19",
        ),
        {
            "OUT": "demo/OUT",
            "poses.csv": Text(_POSES),
            "house.schem": Shared("mcprefab_builds/house_loft.schem"),
        },
    ),
    Step("batches", (Script(_BATCH),), {"OUT": "demo/OUT"}),
    Step(
        "card",
        ("render OUT --device gpu --out gpu --tour --frames 3 --outputs all --size 160x100",),
        {"OUT": "demo/OUT"},
        skipped_by="no graphics card was found",
    ),
)

DATA = (
    Step(
        "dataset-again",
        (
            "dataset build BLOCKS --worlds worlds --images 4 --size 96x72 --jobs 2"
            " --image-format png --voxel 0.16 --region free --paper-compat",
            "dataset build LABELS --schem house.schem --blocks-per-metre 1 --images 2"
            " --labels-only --voxel block --jobs 1",
            "dataset import NPZ --out IMPORTED",
            "dataset stats IMPORTED --json stats.json",
            "dataset tour world --count 6 --size 96x72 --out tour.jsonl",
            "dataset build TOURED --world world --tour tour.jsonl --jobs 1",
            "dataset sheet DATA --labels --most 4 --width 80 --out sheet.png",
            "dataset sheet tour.jsonl --world world --most 4 --width 80 --out tour.png",
            "dataset quality DATA --sample 4 --resize none --variant own --json quality.json",
        ),
        {
            "DATA": "dataset/DATA",
            "NPZ": "dataset-exports/NPZ",
            "worlds": "dataset/DATA/worlds",
            "world": "dataset/DATA/worlds/house_0001",
            "house.schem": Shared("mcprefab_builds/house_cabin.schem"),
        },
    ),
    Step(
        "dataset-imports",
        (
            "dataset import NYU --out FROM_NYU --limit 2",
            "dataset import OCC --out FROM_OCC --limit 2",
            "dataset import EMB --out FROM_EMB --limit 2 --format embodied",
            "evaluate occupancy NPZ/test DATA --json scores.json",
        ),
        {
            "NYU": "dataset-exports/NYU",
            "OCC": "dataset-exports/OCC",
            "EMB": "dataset-exports/EMB",
            "NPZ": "dataset-exports/NPZ",
            "DATA": "dataset/DATA",
        },
    ),
    Step("dataset-rooms", ("dataset rooms PHOTO --rooms 2 --images 4 --size 96x72",)),
    *(
        Step(
            f"train-{network}",
            ("train --config config.yaml --out RUN --device cpu", "export RUN --out net.onnx"),
            {"DATA": "dataset/DATA", "config.yaml": Text(_CONFIG.format(network=network))},
            needs=("torch", "onnx"),
        )
        for network in ("iso", "ndc_scene", "symphonies", "embodied")
    ),
)

_STEP = '{"thought": "On.", "progress": "none", "actions": ["FORWARD", "LEFT"], "done": false}'
_STOP = '{"thought": "There.", "progress": "all", "actions": ["STOP"], "done": true}'
_GRADES = '{"realism": 7, "completeness": 5, "atmosphere": 6}'
_ENVIRONMENT = """\
import hashlib
import gymnasium
for moves in ("vlnce", "block"):
    env = gymnasium.make(
        "world2minecraft.vln.environment:World2Minecraft-VLN-v0", scene="OUT", move_set=moves,
        observations=("rgb", "depth", "semantic", "instance", "pose", "instruction"),
    )
    for seed in range(2):
        seen, info = env.reset(seed=seed)
        print(seen["instruction"], info["distance_m"])
        for action in (1, 2, 1, 1, 3, 1, 0):
            seen, reward, ended, cut, info = env.step(action)
            sums = [hashlib.sha256(seen[one].tobytes()).hexdigest()[:12]
                    for one in ("rgb", "depth", "semantic", "instance")]
            print(action, reward, ended, cut, seen["pose"].tolist(), info["collided"], *sums)
            if ended or cut:
                print(info["score"])
                break
"""
NAVIGATION = (
    Step(
        "navigation-of-houses",
        (
            "vln build house OUT --out SET --trajectories 3 --size 96x64 --workers 2 --moves rxr"
            " --paper-split --views 1",
            "vln export SET --to llamafactory --out SFT --task next_view --composition base",
            "vln run SET --agent oracle --no-video --out ORACLE",
            "vln build house OUT --stream ORACLE --out STREAMED --size 96x64 --workers 1",
            "vln run SET --agent random --count 2 --no-video --out RANDOM",
            "vln run SET --agent shortest --count 1 --no-video --out SHORTEST --moves rxr",
            "vln table RANDOM SHORTEST",
        ),
        {
            "OUT": "demo/OUT",
            "house": "dataset/DATA/worlds/house_0001",
        },
    ),
    Step("environment", (Script(_ENVIRONMENT),), {"OUT": "demo/OUT"}),
    Step(
        "models",
        (
            Model(
                "vln evaluate SET --agent {url} --split all --out ASKED",
                ("B", "Answer: C", "none at all", "A.", '{"answer": "D"}'),
            ),
            "vln evaluate SET --agent http://127.0.0.1:1/v1 --model scripted --split all"
            " --out AGAIN --replay ASKED/replies.jsonl",
            Model(
                'vln run OUT "Go to the table" --agent {url} --out WALK --map text --no-video',
                (_STEP, "no words", _STEP, _STOP),
            ),
            Model("vln reword SET --rewrite {url} --jobs 1", (ECHO, "Go right and stop.")),
            "vln stats SET --no-baselines",
            "vln reword SET --annotations words.csv",
            Model("compare judge OUT --agent {url} --out JUDGED --repeats 2", (_GRADES, "no")),
            Model("compare describe OUT/capture --agent {url} --out said.txt", ("A living room.",)),
            "vln table ASKED WALK --markdown",
        ),
        {
            "SET": "navigation/SET",
            "OUT": "demo/OUT",
            "words.csv": Text("trajectory_id,instruction\nOUT_t00_001,Walk to the table.\n"),
        },
    ),
)

TOLD = (
    Step("help", tuple(f"{verb} --help".strip() for verb in ("", *_VERBS))),
    Step("doctor", ("doctor", "--version")),
)

SLOW = (*LEFT, *CAPTURES, *BUILDS, *PICTURES, *DATA, *NAVIGATION, *TOLD)
STEPS: tuple[Step, ...] = (*(replace(step, is_fast=True) for step in FAST), *SLOW)
