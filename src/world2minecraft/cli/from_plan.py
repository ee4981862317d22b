"""A plan alone in ``w2m reconstruct``: Apple's RoomPlan becomes a world, without a photo."""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from world2minecraft.archive import AnyPath
    from world2minecraft.parameters import Parameters
    from world2minecraft.plans import PlanWorld
    from world2minecraft.progress import Progress


def plan_in(capture: Path) -> "AnyPath | None":
    """Return the RoomPlan JSON of a capture that is nothing else, None where there is none.

    A capture with frames and a plan is a capture; its plan is given by ``--plan``.
    """
    from world2minecraft.archive import is_zip
    from world2minecraft.errors import InputError
    from world2minecraft.plans import find_roomplan
    from world2minecraft.scan.sources import find_capture

    if capture.suffix.lower() == ".json":
        return find_roomplan(capture)
    if capture.is_file() and not is_zip(capture):  # A video is not looked through for this.
        return None
    try:
        find_capture(capture)
    except InputError:
        return find_roomplan(capture)
    return None


def make_from_plan(
    place: "AnyPath", out: Path, chosen: "Parameters", progress: "Progress", name: str = ""
) -> "PlanWorld":
    """Build a plan's world, with a brief report.

    Raises:
        InputError: the plan cannot be read. OutputError: ``out`` cannot be written.
    """
    from world2minecraft.plans import build_plan
    from world2minecraft.report import write_brief_report

    built = build_plan(place, out, chosen, progress, name)
    progress("report", 0, 1)
    write_brief_report(out, built.scan)
    progress("report", 1, 1)
    return built


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
