"""What a finished run tells its user: where the world is, how to open it, what came out."""

from pathlib import Path
from typing import Any


def print_compile_note() -> None:
    """Say, once after installation, why the first run takes longer."""
    from world2minecraft.core.jit import KERNEL_CACHE

    if not any(KERNEL_CACHE.iterdir()):
        print("First run: compiling the inner loops, about 30 s; later runs start at once.")


def print_outcome(out: Path, facts: dict[str, Any]) -> None:
    """Print the outcome and the next steps."""
    explained = facts["surface_explained"]["within_one_voxel"]
    size = " x ".join(f"{side:.1f}" for side in facts["room_size_m"])
    used, skipped = facts["scan"]["frames_used"], len(facts["scan"]["frames_skipped"])
    print(
        f"\nRoom {size} m from {used} frames ({skipped} skipped), {len(facts['objects'])} objects,"
    )
    print(f"{facts['blocks']:,} blocks; {explained:.0%} of the seen surface stands in a block.")
    for note in facts["scan"]["notes"]:
        print(f"note: {note}")
    print(f"\n  look   {out / 'report.html'} in a browser, {out / 'preview.png'}")
    print_play_steps(out / "build")


def print_play_steps(build: Path) -> None:
    """Print how to open the world in the game, and what the further forms left out."""
    print(f"  play   w2m install {build.parent}      puts the world into your game")
    print(f"  or     copy {build / 'world'} into the game's saves folder")
    pack = build / "datapack.zip"
    print(
        f"         {build / 'room.schem'} for WorldEdit" + f", {pack} for a server" * pack.is_file()
    )
    print_extra_formats(build)


def print_extra_formats(build: Path) -> None:
    """Print the further forms that were asked for, each with what it could not carry."""
    from world2minecraft.core.files import read_json

    if not (build / "forms.json").is_file():
        return
    for row in read_json(build / "forms.json").values():
        lost = ", ".join(f"{count:,} {what}" for what, count in row["lost"].items())
        print(f"         {build / row['file']}" + (f" (left out: {lost})" if lost else ""))
