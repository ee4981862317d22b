"""Diagnostics of a capture: possible problems, each with advice."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Literal

import numpy as np

from world2minecraft.capture.quality.picture_quality import Picture
from world2minecraft.capture.quality.processing_route import Route
from world2minecraft.capture.quality.survey import Survey
from world2minecraft.core.errors import MissingExtraError

FEW_FRAMES, FEW_PHOTOS, MIN_PHOTOS = 10, 20, 3
BLURRED_SHARE = 0.3  # Share of the median sharpness.
MIN_SHARPNESS = 0.08  # Three pixels of blur leave 0.06.
DARK_BRIGHTNESS, BARE_PICTURE_SHARE, MAX_BARE_PICTURES = 40.0, 0.85, 0.25
TOLERATED_SHARE = 0.1  # One picture in ten: fewer are left out without harm.
LOW_OVERLAP, ISOLATED_SHARE = 0.45, 0.2
MAX_HOLE_SHARE, MIN_TRUST, MAX_RANGE_M = 0.5, 0.4, 8.0
STILL_SHARE = 0.1  # Share of the typical depth; a shorter baseline gives no parallax.
STILL_M = 0.3  # The same where there is no depth, in a room.
MAX_LOST_SHARE = 0.2
SCALE_ADVICE = 'measure one length and set it, for example --known "table height" 0.72'


@dataclass(frozen=True)
class Diagnostic:
    """A finding about a capture.

    Attributes:
        level: ``ok``, ``warn`` (lower quality) or ``stop`` (no reconstruction possible).
        about: Short key of the finding.
        text: Description of the finding.
        advice: What to do about it.
    """

    level: Literal["ok", "warn", "stop"]
    about: str
    text: str
    advice: str = ""


def diagnose_capture(survey: Survey, route: Route) -> tuple[Diagnostic, ...]:
    """Return the diagnostics of a survey, the most severe first."""
    checks: tuple[Callable[[Survey, Route], Iterator[Diagnostic]], ...] = (
        _check_extras,
        _check_count,
        _check_skipped,
        _check_room,
        _check_movement,
        _check_blur,
        _check_light,
        _check_texture,
        _check_overlap,
        _check_depth,
        _check_directions,
        _check_scale,
        _check_colour,
    )
    found = [diagnostic for check in checks for diagnostic in check(survey, route)]
    order = ("stop", "warn", "ok")
    return tuple(sorted(found, key=lambda diagnostic: order.index(diagnostic.level)))


def _check_extras(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    needs = route.kind in ("photos", "video", "unposed rgbd", "posed photos")
    if needs and not is_installed("pycolmap"):
        text = str(MissingExtraError("pose estimation", "capture"))
        feature, _, install = text.partition(": ")
        yield Diagnostic("stop", "extra", f"{feature} that is not installed", install)


def is_installed(module: str) -> bool:
    """Return whether an optional library is installed, without importing it."""
    return find_spec(module) is not None


def _check_count(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    count = len(survey.validated.frames)
    if route.kind == "solid":
        return
    if not survey.validated.posed and count < MIN_PHOTOS:
        text = f"only {count} {_plural('image', count)}; pose estimation requires 3 or more"
        advice = "take 40 to 100 images of the whole room that overlap"
        if survey.validated.capture.source == "photo":
            advice += "; or estimate depth with a network: --depth hf:ORG/NAME"
        yield Diagnostic("stop", "few", text, advice)
    elif (route.from_pictures or not survey.validated.posed) and count < FEW_PHOTOS:
        text = f"only {count} images; use 40 to 100 from all directions"
        more = "take more images, each sharing two thirds with the previous image"
        advice = "film longer, along all walls of the room" if route.kind == "video" else more
        yield Diagnostic("warn", "few", text, advice)
    elif count < FEW_FRAMES:
        text = f"only {count} {_plural('frame', count)}; use 30 or more from all directions"
        yield Diagnostic("warn", "few", text, "record longer, and point the camera at every wall")


def _check_skipped(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    skipped = survey.validated.skipped
    total = len(survey.validated.frames) + len(skipped)
    for reason, count in Counter(reason for _, reason in skipped).most_common(3):
        lost = "pose" in reason or "tracking" in reason
        advice = "move more slowly, with textured surfaces in view" if lost else ""
        level = "warn" if count > MAX_LOST_SHARE * total or not lost else "ok"
        yield Diagnostic(
            level, "left out", f"{count} of {total} frames are skipped: {reason}", advice
        )


def _check_room(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    plan = survey.plan
    if plan is None:
        return
    if plan.problem:
        yield Diagnostic("stop", "room", plan.problem, "")
    advice = {
        "no floor": "tilt the camera down while walking",
        "no wall": "point the camera at every wall",
        "no ceiling": "point the camera once at the top of each wall",
    }
    for note in plan.notes:
        words = " ".join(note.split()[:2])
        yield Diagnostic("warn", words, note, advice.get(words, ""))
    if survey.validated.has_depth and not plan.problem and not plan.notes:
        yield Diagnostic("ok", "room", "floor, ceiling and all four walls were detected")


def _check_movement(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    if survey.plan is None or route.kind == "solid" or len(survey.plan.cameras) < 3:
        return
    if survey.validated.capture.scale == "unknown":
        return
    places = survey.plan.cameras[:, :3, 3]
    spread = float(np.quantile(np.linalg.norm(places - np.median(places, axis=0), axis=1), 0.9))
    typical = survey.validated.typical_depth_m
    if spread > (STILL_SHARE * typical if typical else STILL_M):
        return
    text = (
        f"all camera positions are within {2 * spread:.2f} m; the camera was rotated but not moved"
    )
    if route.from_pictures:
        yield Diagnostic(
            "stop",
            "turning",
            text,
            "walk around while filming; depth estimation requires sideways motion",
        )
    else:
        yield Diagnostic(
            "warn", "turning", text, "walk around, or surfaces behind objects will be missing"
        )


def _check_blur(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    lit = [picture for picture in survey.pictures if picture.brightness >= DARK_BRIGHTNESS]
    if not lit or route.kind == "solid":
        return
    blurred = blurred_pictures(lit)
    if len(blurred) > TOLERATED_SHARE * len(lit):
        text = f"{len(blurred)} of {len(lit)} sampled images are blurred: {_named(blurred)}"
        advice = "hold the camera still for each photo; film slowly and in good light"
        yield Diagnostic("warn", "blur", text, advice)
    elif blurred:
        are = "is" if len(blurred) == 1 else "are"
        text = f"{len(blurred)} of {len(lit)} sampled images {are} blurred: {_named(blurred)}"
        yield Diagnostic("ok", "blur", text)
    else:
        yield Diagnostic("ok", "blur", f"all {len(lit)} sampled images are sharp")


def blurred_pictures(pictures: Sequence[Picture]) -> list[Picture]:
    """Return the images that are blurred in comparison with the others, or in absolute terms."""
    if not pictures:
        return []
    limit = max(BLURRED_SHARE * float(np.median([p.sharpness for p in pictures])), MIN_SHARPNESS)
    return [picture for picture in pictures if picture.sharpness < limit]


def _check_light(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    dark = [picture for picture in survey.pictures if picture.brightness < DARK_BRIGHTNESS]
    if not dark or route.kind == "solid":
        return
    count = len(survey.pictures)
    level = "warn" if len(dark) > TOLERATED_SHARE * count else "ok"
    are = "is" if len(dark) == 1 else "are"
    text = f"{len(dark)} of {count} sampled images {are} dark: {_named(dark)}"
    yield Diagnostic(
        level,
        "dark",
        text,
        "switch on the lights and open the curtains" * (level != "ok"),
    )


def _check_texture(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    bare = [picture for picture in survey.pictures if picture.bare > BARE_PICTURE_SHARE]
    if not route.from_pictures or len(bare) <= MAX_BARE_PICTURES * len(survey.pictures):
        return
    text = (
        f"{len(bare)} of {len(survey.pictures)} sampled images show mostly surfaces without texture"
    )
    yield Diagnostic("warn", "bare", text, "step back, with corners, edges and furniture in view")


def _check_overlap(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    known = survey.shares[np.isfinite(survey.shares)]
    if len(known) < 2:
        return
    median = float(np.median(known))
    jumps = int((known < ISOLATED_SHARE).sum())
    if median < LOW_OVERLAP or jumps > 0.25 * len(known):
        text = (
            f"neighbouring images overlap by about {median:.0%}; {jumps} of {len(known)} "
            "pairs hardly overlap"
        )
        if median < ISOLATED_SHARE:
            text = f"{jumps} of {len(known)} pairs of neighbouring images hardly overlap"
        advice = "each image should share two thirds with the previous image"
        if route.kind == "video":
            advice = "film slowly, at one step per second"
        yield Diagnostic("warn", "overlap", text, advice)
    else:
        yield Diagnostic("ok", "overlap", f"neighbouring images overlap by about {median:.0%}")


def _check_depth(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    plan = survey.plan
    if plan is None or not survey.validated.has_depth or route.kind == "solid":
        return
    if plan.holes > MAX_HOLE_SHARE:
        text = f"{plan.holes:.0%} of the depth pixels are missing"
        yield Diagnostic(
            "warn",
            "holes",
            text,
            "keep a distance of 0.5 to 4 m; glass and glossy black surfaces return no depth",
        )
    if plan.trust is not None and plan.trust < MIN_TRUST:
        text = f"the mean depth confidence of the device is only {plan.trust:.0%}"
        yield Diagnostic(
            "warn", "trust", text, "move closer and more slowly; avoid direct sunlight"
        )
    if plan.far_m > MAX_RANGE_M:
        text = f"the depth extends to {plan.far_m:.1f} m; indoor sensors are inaccurate beyond 5 m"
        yield Diagnostic("warn", "far", text, "check the depth unit: --set capture.depth_unit=mm")
    if plan.holes <= MAX_HOLE_SHARE and plan.far_m <= MAX_RANGE_M:
        text = f"depth from {plan.near_m:.1f} to {plan.far_m:.1f} m, {plan.holes:.0%} missing"
        yield Diagnostic("ok", "depth", text)
    if survey.validated.capture.one_matrix:
        text = "depth and colour share one stated matrix; the colour camera will be estimated"
        yield Diagnostic("ok", "one matrix", text)


def _check_directions(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    seen = survey.directions
    if seen is None or route.kind == "solid":
        return
    gaps = seen.gaps()
    if len(gaps) == 8:
        yield Diagnostic("warn", "gap", "no image looks horizontally", "hold the camera level")
    elif gaps:
        yield Diagnostic(
            "warn", "gap", f"no image looks {_listed(gaps)}", "point the camera at every wall"
        )
    else:
        yield Diagnostic("ok", "gap", "all horizontal directions are covered")
    if survey.validated.has_depth:
        return  # The alignment knows whether floor and ceiling were met.
    if seen.share_below() == 0:
        text = "no image looks steeply down; the floor may be missing"
        yield Diagnostic("warn", "no floor", text, "tilt the camera down while walking")
    if not (seen.seen[seen.pitches_deg > 20] > 0).any():
        text = "no image looks up; the ceiling may be missing"
        yield Diagnostic(
            "warn", "no ceiling", text, "point the camera once at the top of each wall"
        )


def _check_scale(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    if route.kind in ("photos", "video"):
        text = "the capture has no scale; the size is estimated from typical heights"
        yield Diagnostic("warn", "scale", text, SCALE_ADVICE)
    elif route.kind == "unposed rgbd":
        return  # Depth in metres gives it.
    elif survey.validated.capture.scale == "unknown":
        text = "the poses have no unit; the size is estimated from typical heights"
        yield Diagnostic("warn", "scale", text, SCALE_ADVICE)
    elif survey.validated.capture.scale == "estimated":
        text = (
            f"the scale is an estimate with an error of {survey.validated.capture.scale_sigma:.0%}"
        )
        yield Diagnostic("ok", "scale", text, SCALE_ADVICE)


def _check_colour(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    if not any(frame.colour_path for frame in survey.validated.frames):
        text = "no colour images; blocks will have the colours of their classes"
        yield Diagnostic("warn", "colour", text)


def _named(pictures: Sequence[Picture]) -> str:
    names = ", ".join(
        f"image {picture.name}" if picture.name.isdigit() else picture.name
        for picture in pictures[:3]
    )
    return names + (f" and {len(pictures) - 3} more" if len(pictures) > 3 else "")


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} or {names[-1]}"


def _plural(word: str, count: int) -> str:
    return word if count == 1 else f"{word}s"
