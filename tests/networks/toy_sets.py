"""Small sets of a room whose every pixel is known: what training is tried on."""

from dataclasses import replace

from tests.minecraftocc.exchange.synthetic import sample

from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.importers.imported_samples import ImportedSet
from world2minecraft.minecraftocc.store import write_store
from world2minecraft.networks.config import DataSource, RunConfig

CAMERA = Camera(80, 60, 65.0, 65.0, 40.0, 30.0)
WIDE = Camera(192, 120, 130.0, 130.0, 94.0, 61.0)


def toy_samples(count=8, scenes=4, test_scenes=1, camera=CAMERA):
    """Frames of some scenes, the last ones of the test split."""
    for n in range(count):
        scene = n % scenes
        made = sample(
            f"room_{scene}-t0-{n:05d}",
            eye_m=(1.2 + 0.3 * (n % 5), 0.5, 1.4),
            target_m=(2.0 + 0.2 * (n % 3), 4.0, 0.9),
            camera=camera,
            split="test" if scene >= scenes - test_scenes else "train",
            scene_id=f"room_{scene}",
            frame=n,
        )
        yield replace(made, facts={})


def toy_set(path, count=8, scenes=4, test_scenes=1, camera=CAMERA):
    """The same, held in memory as an importer would give them."""
    held = {one.key: one for one in toy_samples(count, scenes, test_scenes, camera)}
    splits = {key: one.split for key, one in held.items()}
    return ImportedSet(path, "toy", splits, held.__getitem__)


def write_toy_store(folder, **words):
    write_store(folder, sorted(toy_samples(**words), key=lambda one: (one.split, one.key)))
    return folder


def toy_config(*folders, **changes):
    settings = {
        "size": "tiny", "image": (40, 30), "steps": 6, "batch": 2, "warmup_steps": 2,
        "val_share": 0.34, "validate_every": 3, "checkpoint_every": 3, "threads": 1,
        "precision": "32",
    }  # fmt: skip
    sources = tuple(DataSource(str(folder)) for folder in folders)
    network = changes.pop("network", "toy")
    return RunConfig(network, sources, **(settings | changes))
