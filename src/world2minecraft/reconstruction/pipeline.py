"""Algorithm 1 of the paper, line for line: a capture becomes a Minecraft world.

===========  =================================================  ==================================
paper line   what                                               here
===========  =================================================  ==================================
4 to 7       O_mono, the evidence of each view                  ``occupancy``
8            O_scene, all views fused                           ``fusion``, ``semantics``
9 to 11      density D, candidates C, clusters C'               ``instances``
(eq. argmax) templates by IoU over rotations                    ``retrieval``
12, 13       commands M, executed                               ``construction``
===========  =================================================  ==================================

Each stage reads the files that the stage before it wrote, so that any of them can be run again.
"""

from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

from world2minecraft import __version__
from world2minecraft.capture import realign, skip_damaged_frames
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Scan
from world2minecraft.formats.run_arrays import write_evidence
from world2minecraft.formats.scan_record import (
    read_poses,
    read_registration,
    with_recorded_alignment,
    write_poses,
    write_scan,
)
from world2minecraft.furniture.user_library import user_design_files, user_design_folder
from world2minecraft.reconstruction.file_stages import FILE_STAGES, run_stage
from world2minecraft.reconstruction.floorplans import add_plan_openings, add_plan_votes
from world2minecraft.reconstruction.fusion import fuse_views
from world2minecraft.reconstruction.occupancy import Predictor, notes_of, predictor
from world2minecraft.reconstruction.opening import prepare_and_open
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.registration import (
    apply_corrections,
    register,
    with_registration_note,
)
from world2minecraft.reconstruction.resume import resume_manifest, resume_parameters
from world2minecraft.reconstruction.run_folder import RunFolder, hash_capture

STAGES = ("scan", "register", "fuse", *FILE_STAGES)


def reconstruct(
    capture: Path,
    out: Path,
    parameters: Parameters | None = None,
    *,
    start: str | None = None,
    until: str | None = None,
    labels: Path | None = None,
    progress: Progress = no_progress,
) -> Scan:
    """Turn the capture in a folder into a Minecraft world in ``out / "build"``.

    Args:
        capture: a folder that ``scan`` can read.
        out: the folder of the results; DESIGN lists its files.
        parameters: what decides the result, beside the capture.
        start: the stage to begin at; None goes on where a run that was cut off stopped.
        until: the last stage to run; all of them where it is None.
        labels: a folder of 2D label images, one a view.
        progress: called at each step.

    Raises:
        CaptureError: the capture cannot be used. OutputError: ``out`` cannot be written.
        UsageError: a setting is other than the one that stages before ``start`` were made with.
    """
    run = RunFolder(out, STAGES, start)
    resumed = resume_parameters(out, start, STAGES, parameters or Parameters())
    chosen = resumed.parameters
    early = start is None or STAGES.index(start) <= STAGES.index("fuse")
    network = predictor(chosen.predictor, chosen.occupy) if early else None
    with run.timed("scan"):
        scan = prepare_and_open(capture, out, chosen, labels, progress)
    stated = manifest(capture, labels, chosen, out)
    run.begin(resume_manifest(out, start, stated, resumed))
    if run.needs("scan"):
        with run.stage("scan"):
            write_scan(run.path("scan.json"), scan)
    if run.needs("register"):
        with run.stage("register"):
            scan = _register(run, scan, chosen, progress)
    else:
        scan = read_registered(scan, out)
    if network is not None and run.needs("fuse"):
        with run.stage("fuse"):
            scan = _fuse(run, scan, chosen, network, progress)
    for stage in FILE_STAGES:
        if run.needs(stage):
            with run.stage(stage):
                run_stage(stage, run.folder, chosen, progress)
                if stage == "label" and chosen.plan:
                    add_plan_openings(run.folder, Path(chosen.plan))
        if stage == until:
            break
    return replace(scan, notes=(*scan.notes, *resumed.notes))


def _register(run: RunFolder, scan: Scan, chosen: Parameters, progress: Progress) -> Scan:
    """Refine poses and depth scales, write them, and return the scan with them applied."""
    found = register(scan, chosen.register.suited(scan.depth_kind), progress)
    scan = realign(apply_corrections(scan, found.corrections), found.surface)
    scan = with_registration_note(scan, found.corrections.facts)
    write_poses(run.path("poses.npz"), found.corrections)
    write_scan(run.path("scan.json"), scan, found.corrections.facts)
    return scan


def _fuse(
    run: RunFolder, scan: Scan, chosen: Parameters, network: Predictor, progress: Progress
) -> Scan:
    """Fuse the evidence of all views, write it, and return the scan with what is to be noted."""
    rules = chosen.fuse.suited(scan.depth_kind)
    evidence = fuse_views(network.predict(scan), scan, rules, progress)
    scan = skip_damaged_frames(scan)
    notes = notes_of(network)
    if chosen.plan:
        evidence, notes_of_plan = add_plan_votes(evidence, Path(chosen.plan))
        notes = (*notes, *notes_of_plan)
    scan = replace(scan, notes=(*scan.notes, *notes))
    write_evidence(run.path("evidence.npz"), evidence)
    write_scan(run.path("scan.json"), scan, read_registration(run.path("scan.json")))
    return scan


def read_registered(scan: Scan, out: Path) -> Scan:
    """Return a scan as an earlier run in ``out`` registered and placed it.

    Raises:
        InputError: no run got so far there. DamagedFileError: its files cannot be read.
    """
    placed = with_recorded_alignment(scan, out / "scan.json")
    return apply_corrections(placed, read_poses(out / "poses.npz"))


def network_files(chosen: Parameters) -> list[Path]:
    """Return the files beside the capture that networks are read from or told by."""
    named = (chosen.predictor.partition(":")[2], chosen.occupy.network, chosen.occupy.label_names)
    return [Path(name) for name in named if name]


def manifest(
    capture: Path, labels: Path | None, chosen: Parameters, out: Path | None = None
) -> dict:
    """Return what decides a result: the hashes of what is read, the parameters and the versions.

    What lies in ``out``, the folder of the results, is not read of a capture that holds it.
    """
    palette = Path(chosen.build.palette)
    return {
        "program": __version__,
        "capture": hash_capture(capture, without=out),
        "labels": None if labels is None else hash_capture(labels),
        "plan": hash_capture(Path(chosen.plan)) if chosen.plan else None,
        "networks": [hash_capture(path) for path in network_files(chosen)],
        "palette": hash_capture(palette) if palette.is_file() else None,
        "furniture": hash_capture(user_design_folder()) if user_design_files() else None,
        "parameters": chosen.as_json(),
        "versions": {name: version(name) for name in ("numpy", "scipy", "numba")},
    }
