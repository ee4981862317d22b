"""Print the result of a finished run and the next steps."""

from pathlib import Path
from typing import Any


def print_outcome(out: Path, facts: dict[str, Any]) -> None:
    """Print the size of the result, its notes and where to view it.

    Args:
        out: Folder of the run.
        facts: Contents of the run's ``report.json``.
    """
    explained = facts["surface_explained"]["within_one_voxel"]
    size = " x ".join(f"{side:.1f}" for side in facts["room_size_m"])
    used, skipped = facts["scan"]["frames_used"], len(facts["scan"]["frames_skipped"])
    print(
        f"\nRoom {size} m from {used} frames ({skipped} skipped), {len(facts['objects'])} objects,"
    )
    print(f"{facts['blocks']:,} blocks; {explained:.0%} of the observed surface is within a block.")
    photos = facts["photo_agreement"]
    if photos["headline"] is not None:
        spread = photos["standard_error"]
        error = "" if spread is None else f" (standard error {spread:.0%})"
        print(
            f"{photos['headline']:.0%} of what the photos show has its place, look and name{error}."
        )
    for note in facts["scan"]["notes"]:
        print(f"note: {note}")
    print(f"\n  look   open {out / 'report.html'} in a browser, or {out / 'preview.png'}")
    print_play_steps(out / "build")


def print_play_steps(build: Path) -> None:
    """Print how to open the world in the game, and the additional formats of the build."""
    print(f"  play   w2m install {build.parent}      copies the world into the game")
    print(f"         or copy {build / 'world'} into the game's saves folder")
    pack = build / "datapack.zip"
    print(
        f"         {build / 'room.schem'} for WorldEdit" + f", {pack} for a server" * pack.is_file()
    )
    print_extra_formats(build)


def print_extra_formats(build: Path) -> None:
    """Print the files in additional formats, with the contents that each format omits."""
    from world2minecraft.core.files import read_json

    if not (build / "forms.json").is_file():
        return
    for row in read_json(build / "forms.json").values():
        lost = ", ".join(f"{count:,} {what}" for what, count in row["lost"].items())
        print(f"         {build / row['file']}" + (f" (not included: {lost})" if lost else ""))
