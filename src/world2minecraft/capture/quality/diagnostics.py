"""Diagnostics of a capture: what could go wrong, each with advice."""

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
BLURRED_SHARE, MIN_SHARPNESS = (
    0.3,
    0.08,
)  # Of the median; and at all: three pixels of blur leave 0.06.
DARK_BRIGHTNESS, BARE_PICTURE_SHARE, MAX_BARE_PICTURES = 40.0, 0.85, 0.25
TOLERATED_SHARE = 0.1  # One picture in ten: fewer are left out without harm.
LOW_OVERLAP, ISOLATED_SHARE = 0.45, 0.2
MAX_HOLE_SHARE, MIN_TRUST, MAX_RANGE_M = 0.5, 0.4, 8.0
STILL_SHARE = 0.1  # Of the typical depth: cameras that near to one another see no parallax.
STILL_M = 0.3  # The same where there is no depth, in a room.
MAX_LOST_SHARE = 0.2
SCALE_ADVICE = 'measure one thing and say it: --known "table height" 0.72'


@dataclass(frozen=True)
class Diagnostic:
    """One finding, rated ``ok``, ``warn`` (worse rooms) or ``stop`` (no room at all)."""

    level: Literal["ok", "warn", "stop"]
    about: str
    text: str
    advice: str = ""


def diagnose_capture(survey: Survey, route: Route) -> tuple[Diagnostic, ...]:
    """Return the diagnostics of a survey, the worst first."""
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
        text = str(MissingExtraError("finding poses", "capture"))
        feature, _, install = text.partition(": ")
        yield Diagnostic("stop", "extra", f"{feature} that is not installed", install)


def is_installed(module: str) -> bool:
    """Return whether an optional library is there, without importing it."""
    return find_spec(module) is not None


def _check_count(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    count = len(survey.validated.frames)
    if route.kind == "solid":
        return
    if not survey.validated.posed and count < MIN_PHOTOS:
        text = f"only {count} {_plural('picture', count)}; places are found from 3 or more"
        advice = "take 40 to 100 from all over the room, each overlapping"
        if survey.validated.capture.source == "photo":
            advice += "; or let a network guess: --depth hf:ORG/NAME"
        yield Diagnostic("stop", "few", text, advice)
    elif (route.from_pictures or not survey.validated.posed) and count < FEW_PHOTOS:
        text = f"only {count} pictures; 40 to 100 from all sides show a room"
        more = "take more, each sharing two thirds with the one before"
        advice = "film longer, around the room along its walls" if route.kind == "video" else more
        yield Diagnostic("warn", "few", text, advice)
    elif count < FEW_FRAMES:
        text = f"only {count} {_plural('frame', count)}; 30 or more from all sides show a room"
        yield Diagnostic("warn", "few", text, "record longer, and turn to every wall")


def _check_skipped(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    skipped = survey.validated.skipped
    total = len(survey.validated.frames) + len(skipped)
    for reason, count in Counter(reason for _, reason in skipped).most_common(3):
        lost = "pose" in reason or "tracking" in reason
        advice = "move slower, with texture in view" if lost else ""
        level = "warn" if count > MAX_LOST_SHARE * total or not lost else "ok"
        yield Diagnostic(
            level, "left out", f"{count} of {total} frames are left out: {reason}", advice
        )


def _check_room(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    plan = survey.plan
    if plan is None:
        return
    if plan.problem:
        yield Diagnostic("stop", "room", plan.problem, "")
    advice = {
        "no floor": "tilt the camera down while you walk",
        "no wall": "turn to every wall",
        "no ceiling": "one look up at each wall's top is enough",
    }
    for note in plan.notes:
        words = " ".join(note.split()[:2])
        yield Diagnostic("warn", words, note, advice.get(words, ""))
    if survey.validated.has_depth and not plan.problem and not plan.notes:
        yield Diagnostic("ok", "room", "floor, ceiling and all four walls were met")


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
    text = f"all cameras stand within {2 * spread:.2f} m; the camera turned but did not walk"
    if route.from_pictures:
        yield Diagnostic(
            "stop", "turning", text, "walk around while you film, for depth needs steps aside"
        )
    else:
        yield Diagnostic(
            "warn", "turning", text, "walk around, or what stands behind things stays unseen"
        )


def _check_blur(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    lit = [picture for picture in survey.pictures if picture.brightness >= DARK_BRIGHTNESS]
    if not lit or route.kind == "solid":
        return
    blurred = blurred_pictures(lit)
    if len(blurred) > TOLERATED_SHARE * len(lit):
        text = f"{len(blurred)} of {len(lit)} pictures looked at are blurred: {_named(blurred)}"
        advice = "hold still for each photo; film slowly and in good light"
        yield Diagnostic("warn", "blur", text, advice)
    elif blurred:
        are = "is" if len(blurred) == 1 else "are"
        text = f"{len(blurred)} of {len(lit)} pictures looked at {are} blurred: {_named(blurred)}"
        yield Diagnostic("ok", "blur", text)
    else:
        yield Diagnostic("ok", "blur", f"all {len(lit)} pictures looked at are sharp")


def blurred_pictures(pictures: Sequence[Picture]) -> list[Picture]:
    """Return those that are blurred compared with the others, or by any measure."""
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
    text = f"{len(dark)} of {count} pictures looked at {are} dark: {_named(dark)}"
    yield Diagnostic(
        level, "dark", text, "switch the lights on, open the curtains" * (level != "ok")
    )


def _check_texture(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    bare = [picture for picture in survey.pictures if picture.bare > BARE_PICTURE_SHARE]
    if not route.from_pictures or len(bare) <= MAX_BARE_PICTURES * len(survey.pictures):
        return
    text = f"{len(bare)} of {len(survey.pictures)} pictures show little but bare surface"
    yield Diagnostic("warn", "bare", text, "stand back, with corners, edges and furniture in view")


def _check_overlap(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    known = survey.shares[np.isfinite(survey.shares)]
    if len(known) < 2:
        return
    median = float(np.median(known))
    jumps = int((known < ISOLATED_SHARE).sum())
    if median < LOW_OVERLAP or jumps > 0.25 * len(known):
        text = f"neighbours share about {median:.0%}; {jumps} of {len(known)} share next to nothing"
        if median < ISOLATED_SHARE:
            text = f"{jumps} of {len(known)} neighbours share next to nothing"
        advice = "each picture should share two thirds with the last"
        if route.kind == "video":
            advice = "film slowly, a step a second"
        yield Diagnostic("warn", "overlap", text, advice)
    else:
        yield Diagnostic("ok", "overlap", f"neighbours share about {median:.0%}")


def _check_depth(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    plan = survey.plan
    if plan is None or not survey.validated.has_depth or route.kind == "solid":
        return
    if plan.holes > MAX_HOLE_SHARE:
        text = f"{plan.holes:.0%} of the depth is holes"
        yield Diagnostic(
            "warn", "holes", text, "stay 0.5 to 4 m away; glass and black gloss show none"
        )
    if plan.trust is not None and plan.trust < MIN_TRUST:
        text = f"the device trusts its depth by {plan.trust:.0%} only"
        yield Diagnostic("warn", "trust", text, "go nearer, move slower; sunlight blinds LiDAR")
    if plan.far_m > MAX_RANGE_M:
        text = f"depth reaches {plan.far_m:.1f} m; sensors for rooms err past 5 m"
        yield Diagnostic("warn", "far", text, "check the depth unit: --set capture.depth_unit=mm")
    if plan.holes <= MAX_HOLE_SHARE and plan.far_m <= MAX_RANGE_M:
        text = f"depth from {plan.near_m:.1f} to {plan.far_m:.1f} m, {plan.holes:.0%} of it holes"
        yield Diagnostic("ok", "depth", text)
    if survey.validated.capture.one_matrix:
        text = "depth and colour share one stated matrix; the colour camera is estimated"
        yield Diagnostic("ok", "one matrix", text)


def _check_directions(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    seen = survey.directions
    if seen is None or route.kind == "solid":
        return
    gaps = seen.gaps()
    if len(gaps) == 8:
        yield Diagnostic("warn", "gap", "no picture looks level", "hold the camera upright")
    elif gaps:
        yield Diagnostic("warn", "gap", f"no picture looks {_listed(gaps)}", "turn to every wall")
    else:
        yield Diagnostic("ok", "gap", "every heading is looked at")
    if survey.validated.has_depth:
        return  # The alignment knows whether floor and ceiling were met.
    if seen.share_below() == 0:
        text = "no picture looks steeply down; the floor may be missing"
        yield Diagnostic("warn", "no floor", text, "tilt the camera down while you walk")
    if not (seen.seen[seen.pitches_deg > 20] > 0).any():
        text = "no picture looks up; the ceiling may be missing"
        yield Diagnostic("warn", "no ceiling", text, "one look up at each wall's top is enough")


def _check_scale(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    if route.kind in ("photos", "video"):
        text = "nothing says how large the room is; it is judged from heights that are usual"
        yield Diagnostic("warn", "scale", text, SCALE_ADVICE)
    elif route.kind == "unposed rgbd":
        return  # Depth in metres gives it.
    elif survey.validated.capture.scale == "unknown":
        text = "its poses have no unit; the size is judged from heights that are usual"
        yield Diagnostic("warn", "scale", text, SCALE_ADVICE)
    elif survey.validated.capture.scale == "estimated":
        text = f"its scale is an estimate, {survey.validated.capture.scale_sigma:.0%} unsure"
        yield Diagnostic("ok", "scale", text, SCALE_ADVICE)


def _check_colour(survey: Survey, route: Route) -> Iterator[Diagnostic]:
    if not any(frame.colour_path for frame in survey.validated.frames):
        text = "no colour images: blocks will have the colours of their classes"
        yield Diagnostic("warn", "colour", text)


def _named(pictures: Sequence[Picture]) -> str:
    names = ", ".join(
        f"picture {picture.name}" if picture.name.isdigit() else picture.name
        for picture in pictures[:3]
    )
    return names + (f" and {len(pictures) - 3} more" if len(pictures) > 3 else "")


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} or {names[-1]}"


def _plural(word: str, count: int) -> str:
    return word if count == 1 else f"{word}s"
