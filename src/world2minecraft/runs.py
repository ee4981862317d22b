"""A whole run: whatever was captured becomes a world with a report.

In: a capture, or a plan alone. Out: the run's folder. ``w2m reconstruct`` and SceneForge's start
page do the same through here.
"""

from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

from world2minecraft.core.archives import AnyPath
from world2minecraft.core.precompile import compile_first
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.evaluation.report import write_brief_report, write_report
from world2minecraft.evaluation.scoring.truth_files import read_colour, read_instances, read_truth
from world2minecraft.reconstruction.floorplans import PlanWorld, build_plan
from world2minecraft.reconstruction.opening import prepare_and_open
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.pipeline import STAGES, read_registered, reconstruct
from world2minecraft.reconstruction.resume import resume_parameters


def run_capture(
    capture: Path,
    out: Path,
    chosen: Parameters,
    start: str | None = None,
    labels: Path | None = None,
    progress: Progress = no_progress,
) -> dict[str, Any]:
    """Run the pipeline, write its report and return the contents of ``report.json``.

    Raises:
        CaptureError: the capture cannot be used. OutputError: ``out`` cannot be written.
        DamagedFileError: the capture's ground truth or a file of the run is damaged.
    """
    # Products are small: threads of BLAS wait for each other longer than they work.
    with threadpool_limits(1, "blas"):
        return _run(capture, out, chosen, start, labels, compile_first(progress))


def _run(
    capture: Path,
    out: Path,
    chosen: Parameters,
    start: str | None,
    labels: Path | None,
    progress: Progress,
) -> dict[str, Any]:
    truth = capture if (capture / "truth.npz").is_file() else None
    if truth is not None:
        # What is damaged is said before the work, not after it.
        known = read_truth(truth)
        read_instances(known)
        read_colour(known)
    if start == "report":
        as_before = resume_parameters(out, start, STAGES, chosen).parameters
        opened = prepare_and_open(capture, out, as_before, labels, progress, registered=True)
        scan = read_registered(opened, out)
    else:
        scan = reconstruct(capture, out, chosen, start=start, labels=labels, progress=progress)
    return write_report(out, scan, truth=truth, progress=progress)


def run_plan(
    place: AnyPath, out: Path, chosen: Parameters, progress: Progress = no_progress, name: str = ""
) -> PlanWorld:
    """Build a plan's world, with a brief report.

    Raises:
        InputError: the plan cannot be read. OutputError: ``out`` cannot be written.
    """
    progress = compile_first(progress)
    built = build_plan(place, out, chosen, progress, name)
    progress("report", 0, 1)
    write_brief_report(out, built.scan)
    progress("report", 1, 1)
    return built
