"""Algorithm 1 of the paper: convert a capture to a Minecraft world.

===========  =================================================  ==================================
paper line   step                                               package
===========  =================================================  ==================================
4 to 7       O_mono, the evidence of each view                  ``occupancy``
8            O_scene, all views fused                           ``fusion``, ``semantics``
9 to 11      density D, candidates C, clusters C'               ``instances``
(eq. argmax) templates by IoU over rotations                    ``retrieval``, ``repair``
12, 13       commands M, executed                               ``construction``
===========  =================================================  ==================================

Each stage reads the files written by the previous stage, so every stage can be repeated separately.
"""

from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

from world2minecraft import __version__
from world2minecraft.capture import realign, skip_damaged_frames
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Scan
from world2minecraft.formats.class_ids import CLASS_SETS
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
from world2minecraft.reconstruction.naming.name_votes import NAME_VOTES, write_name_votes
from world2minecraft.reconstruction.occupancy import (
    Predictor,
    name_votes_of,
    notes_of,
    predictor,
)
from world2minecraft.reconstruction.occupancy.saved_grid_evidence import SavedGridPredictor
from world2minecraft.reconstruction.opening import prepare_and_open
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.registration import (
    apply_corrections,
    register,
    with_registration_note,
)
from world2minecraft.reconstruction.repair_run import repair_run
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
    """Reconstruct a capture as a Minecraft world in ``out / "build"``.

    Args:
        capture: Capture folder that ``scan`` can read.
        out: Output folder.
        parameters: Parameters that determine the result, besides the capture.
        start: Stage to start at; by default, an interrupted run continues where it stopped.
        until: Last stage to run; the default is all stages.
        labels: Folder of 2D label images, one per view.
        progress: Callback for progress.

    Raises:
        CaptureError: If the capture cannot be used.
        OutputError: If ``out`` cannot be written.
        UsageError: If a parameter differs from that of a finished stage before ``start``.
    """
    # The find stage changes the grid of the label stage, which is therefore computed again.
    run = RunFolder(out, STAGES, "label" if start == "find" else start)
    resumed = resume_parameters(out, start, STAGES, parameters or Parameters())
    chosen = resumed.parameters
    first = 0 if start is None else STAGES.index(start)
    network = _predictor(chosen) if first <= STAGES.index("fuse") else None
    registered = first > STAGES.index("register")
    with run.timed("scan"):
        scan = prepare_and_open(capture, out, chosen, labels, progress, registered=registered)
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
                if stage == "furnish":
                    repair_run(run.folder, scan, chosen, progress)
        if stage == until:
            break
    return replace(scan, notes=(*scan.notes, *resumed.notes))


def _predictor(chosen: Parameters) -> Predictor:
    """Return the predictor of the evidence, combined with saved predictions if there are any."""
    network = predictor(chosen.predictor, chosen.occupy)
    if not chosen.predictions.path:
        return network
    return SavedGridPredictor(network, chosen.predictions)


def _register(run: RunFolder, scan: Scan, chosen: Parameters, progress: Progress) -> Scan:
    """Refine poses and depth scales, write them, and return the corrected scan."""
    found = register(scan, chosen.register.suited(scan.depth_kind), progress)
    scan = realign(apply_corrections(scan, found.corrections), found.surface)
    scan = with_registration_note(scan, found.corrections.facts)
    write_poses(run.path("poses.npz"), found.corrections)
    write_scan(run.path("scan.json"), scan, found.corrections.facts)
    return scan


def _fuse(
    run: RunFolder, scan: Scan, chosen: Parameters, network: Predictor, progress: Progress
) -> Scan:
    """Fuse the evidence of all views, write it, and return the scan with the resulting notes."""
    rules = chosen.fuse.suited(scan.depth_kind)
    evidence = fuse_views(network.predict(scan), scan, rules, progress)
    scan = skip_damaged_frames(scan)
    notes = notes_of(network)
    if chosen.plan:
        evidence, notes_of_plan = add_plan_votes(evidence, Path(chosen.plan))
        notes = (*notes, *notes_of_plan)
    scan = replace(scan, notes=(*scan.notes, *notes))
    write_evidence(run.path("evidence.npz"), evidence)
    run.path(NAME_VOTES).unlink(missing_ok=True)
    if (votes := name_votes_of(network)) is not None:
        write_name_votes(run.path(NAME_VOTES), votes)
    write_scan(run.path("scan.json"), scan, read_registration(run.path("scan.json")))
    return scan


def read_registered(scan: Scan, out: Path) -> Scan:
    """Return a scan as registered and aligned by an earlier run in ``out``.

    Raises:
        InputError: If no run in ``out`` completed these stages.
        DamagedFileError: If the files of the run cannot be read.
    """
    placed = with_recorded_alignment(scan, out / "scan.json")
    return apply_corrections(placed, read_poses(out / "poses.npz"))


def network_files(chosen: Parameters) -> list[Path]:
    """Return the files of networks and label tables that the parameters refer to."""
    classes = chosen.predictions.classes
    named = (
        chosen.predictor.partition(":")[2],
        chosen.occupy.network,
        chosen.occupy.label_names,
        "" if classes in CLASS_SETS else classes,
    )
    return [Path(name) for name in named if name]


def manifest(
    capture: Path, labels: Path | None, chosen: Parameters, out: Path | None = None
) -> dict:
    """Return all inputs that determine a result: file hashes, parameters and versions.

    Files in the output folder ``out`` are ignored if it is inside the capture.
    """
    palette = Path(chosen.build.palette)
    return {
        "program": __version__,
        "capture": hash_capture(capture, without=out),
        "labels": None if labels is None else hash_capture(labels),
        "plan": hash_capture(Path(chosen.plan)) if chosen.plan else None,
        "predictions": (
            hash_capture(Path(chosen.predictions.path)) if chosen.predictions.path else None
        ),
        "networks": [hash_capture(path) for path in network_files(chosen)],
        "palette": hash_capture(palette) if palette.is_file() else None,
        "furniture": hash_capture(user_design_folder()) if user_design_files() else None,
        "parameters": chosen.as_json(),
        "versions": {name: version(name) for name in ("numpy", "scipy", "numba")},
    }
