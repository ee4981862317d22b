"""A plan alone in ``w2m reconstruct``: what came of it, told."""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from world2minecraft.reconstruction.floorplans import PlanWorld


def say_plan(out: Path, built: "PlanWorld") -> None:
    """Print what came of a plan, and how to see it."""
    from world2minecraft.cli.outcome import say_how_to_play

    size = " x ".join(f"{side:.1f}" for side in built.scan.room_size_m)
    count = len(built.layouts)
    print(f"\n{count} room{'s' * (count != 1)} of a plan, {size} m, {built.objects} objects.")
    print("note: a plan has no colours; floor, walls and furniture have usual ones")
    for note in built.scan.notes:
        print(f"note: {note}")
    print(f"\n  look   {out / 'report.html'} in a browser, {out / 'preview.png'}")
    say_how_to_play(out / "build")
