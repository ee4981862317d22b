"""What could go wrong with a capture, each with what to do about it."""

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

FEW_FRAMES, FEW_PHOTOS, LEAST_PHOTOS = 10, 20, 3
BLURRED, SOFT = 0.3, 0.08  # Of the median; and at all: three pixels of blur leave 0.06.
DARK, BARE, BARE_SHARE = 40.0, 0.85, 0.25
SOME = 0.1  # One picture in ten: fewer are left out without harm.
LOW_SHARE, ALONE_SHARE = 0.45, 0.2
HOLES, LOW_TRUST, FAR_M = 0.5, 0.4, 8.0
STILL_SHARE = 0.1  # Of the typical depth: cameras that near to one another see no parallax.
STILL_M = 0.3  # The same where there is no depth, in a room.
LOST_SHARE = 0.2
SCALE_ADVICE = 'measure one thing and say it: --known "table height" 0.72'


@dataclass(frozen=True)
class Doubt:
    """One thing that was judged: ``ok``, ``warn`` (worse rooms) or ``stop`` (no room at all)."""

    level: Literal["ok", "warn", "stop"]
    about: str
    text: str
    advice: str = ""


def doubts_of(survey: Survey, route: Route) -> tuple[Doubt, ...]:
    """Judge what was found; what stops comes first, then what harms, then what is well."""
    judges: tuple[Callable[[Survey, Route], Iterator[Doubt]], ...] = (
        _extras,
        _count,
        _left_out,
        _room,
        _movement,
        _blur,
        _light,
        _texture,
        _overlap,
        _depth,
        _looks,
        _scale,
        _colour,
    )
    found = [doubt for judge in judges for doubt in judge(survey, route)]
    order = ("stop", "warn", "ok")
    return tuple(sorted(found, key=lambda doubt: order.index(doubt.level)))


def _extras(survey: Survey, route: Route) -> Iterator[Doubt]:
    needs = route.kind in ("photos", "video", "unposed rgbd", "posed photos")
    if needs and not is_installed("pycolmap"):
        text = str(MissingExtraError("finding poses", "capture"))
        feature, _, install = text.partition(": ")
        yield Doubt("stop", "extra", f"{feature} that is not installed", install)


def is_installed(module: str) -> bool:
    """Return whether an optional library is there, without importing it."""
    return find_spec(module) is not None


def _count(survey: Survey, route: Route) -> Iterator[Doubt]:
    count = len(survey.judged.frames)
    if route.kind == "solid":
        return
    if not survey.judged.posed and count < LEAST_PHOTOS:
        text = f"only {count} {_plural('picture', count)}; places are found from 3 or more"
        advice = "take 40 to 100 from all over the room, each overlapping"
        if survey.judged.capture.source == "photo":
            advice += "; or let a network guess: --depth hf:ORG/NAME"
        yield Doubt("stop", "few", text, advice)
    elif (route.from_pictures or not survey.judged.posed) and count < FEW_PHOTOS:
        text = f"only {count} pictures; 40 to 100 from all sides show a room"
        more = "take more, each sharing two thirds with the one before"
        advice = "film longer, around the room along its walls" if route.kind == "video" else more
        yield Doubt("warn", "few", text, advice)
    elif count < FEW_FRAMES:
        text = f"only {count} {_plural('frame', count)}; 30 or more from all sides show a room"
        yield Doubt("warn", "few", text, "record longer, and turn to every wall")


def _left_out(survey: Survey, route: Route) -> Iterator[Doubt]:
    skipped = survey.judged.skipped
    total = len(survey.judged.frames) + len(skipped)
    for reason, count in Counter(reason for _, reason in skipped).most_common(3):
        lost = "pose" in reason or "tracking" in reason
        advice = "move slower, with texture in view" if lost else ""
        level = "warn" if count > LOST_SHARE * total or not lost else "ok"
        yield Doubt(level, "left out", f"{count} of {total} frames are left out: {reason}", advice)


def _room(survey: Survey, route: Route) -> Iterator[Doubt]:
    plan = survey.plan
    if plan is None:
        return
    if plan.problem:
        yield Doubt("stop", "room", plan.problem, "")
    advice = {
        "no floor": "tilt the camera down while you walk",
        "no wall": "turn to every wall",
        "no ceiling": "one look up at each wall's top is enough",
    }
    for note in plan.notes:
        words = " ".join(note.split()[:2])
        yield Doubt("warn", words, note, advice.get(words, ""))
    if survey.judged.has_depth and not plan.problem and not plan.notes:
        yield Doubt("ok", "room", "floor, ceiling and all four walls were met")


def _movement(survey: Survey, route: Route) -> Iterator[Doubt]:
    if survey.plan is None or route.kind == "solid" or len(survey.plan.cameras) < 3:
        return
    if survey.judged.capture.scale == "unknown":
        return
    places = survey.plan.cameras[:, :3, 3]
    spread = float(np.quantile(np.linalg.norm(places - np.median(places, axis=0), axis=1), 0.9))
    typical = survey.judged.typical_depth_m
    if spread > (STILL_SHARE * typical if typical else STILL_M):
        return
    text = f"all cameras stand within {2 * spread:.2f} m; the camera turned but did not walk"
    if route.from_pictures:
        yield Doubt(
            "stop", "turning", text, "walk around while you film, for depth needs steps aside"
        )
    else:
        yield Doubt(
            "warn", "turning", text, "walk around, or what stands behind things stays unseen"
        )


def _blur(survey: Survey, route: Route) -> Iterator[Doubt]:
    lit = [picture for picture in survey.pictures if picture.brightness >= DARK]
    if not lit or route.kind == "solid":
        return
    blurred = blurred_pictures(lit)
    if len(blurred) > SOME * len(lit):
        text = f"{len(blurred)} of {len(lit)} pictures looked at are blurred: {_named(blurred)}"
        advice = "hold still for each photo; film slowly and in good light"
        yield Doubt("warn", "blur", text, advice)
    elif blurred:
        are = "is" if len(blurred) == 1 else "are"
        text = f"{len(blurred)} of {len(lit)} pictures looked at {are} blurred: {_named(blurred)}"
        yield Doubt("ok", "blur", text)
    else:
        yield Doubt("ok", "blur", f"all {len(lit)} pictures looked at are sharp")


def blurred_pictures(pictures: Sequence[Picture]) -> list[Picture]:
    """Return those that are blurred beside the others, or by any measure."""
    if not pictures:
        return []
    limit = max(BLURRED * float(np.median([p.sharpness for p in pictures])), SOFT)
    return [picture for picture in pictures if picture.sharpness < limit]


def _light(survey: Survey, route: Route) -> Iterator[Doubt]:
    dark = [picture for picture in survey.pictures if picture.brightness < DARK]
    if not dark or route.kind == "solid":
        return
    count = len(survey.pictures)
    level = "warn" if len(dark) > SOME * count else "ok"
    are = "is" if len(dark) == 1 else "are"
    text = f"{len(dark)} of {count} pictures looked at {are} dark: {_named(dark)}"
    yield Doubt(level, "dark", text, "switch the lights on, open the curtains" * (level != "ok"))


def _texture(survey: Survey, route: Route) -> Iterator[Doubt]:
    bare = [picture for picture in survey.pictures if picture.bare > BARE]
    if not route.from_pictures or len(bare) <= BARE_SHARE * len(survey.pictures):
        return
    text = f"{len(bare)} of {len(survey.pictures)} pictures show little but bare surface"
    yield Doubt("warn", "bare", text, "stand back, with corners, edges and furniture in view")


def _overlap(survey: Survey, route: Route) -> Iterator[Doubt]:
    known = survey.shares[np.isfinite(survey.shares)]
    if len(known) < 2:
        return
    middle = float(np.median(known))
    jumps = int((known < ALONE_SHARE).sum())
    if middle < LOW_SHARE or jumps > 0.25 * len(known):
        text = f"neighbours share about {middle:.0%}; {jumps} of {len(known)} share next to nothing"
        if middle < ALONE_SHARE:
            text = f"{jumps} of {len(known)} neighbours share next to nothing"
        advice = "each picture should share two thirds with the last"
        if route.kind == "video":
            advice = "film slowly, a step a second"
        yield Doubt("warn", "overlap", text, advice)
    else:
        yield Doubt("ok", "overlap", f"neighbours share about {middle:.0%}")


def _depth(survey: Survey, route: Route) -> Iterator[Doubt]:
    plan = survey.plan
    if plan is None or not survey.judged.has_depth or route.kind == "solid":
        return
    if plan.holes > HOLES:
        text = f"{plan.holes:.0%} of the depth is holes"
        yield Doubt("warn", "holes", text, "stay 0.5 to 4 m away; glass and black gloss show none")
    if plan.trust is not None and plan.trust < LOW_TRUST:
        text = f"the device trusts its depth by {plan.trust:.0%} only"
        yield Doubt("warn", "trust", text, "go nearer, move slower; sunlight blinds LiDAR")
    if plan.far_m > FAR_M:
        text = f"depth reaches {plan.far_m:.1f} m; sensors for rooms err past 5 m"
        yield Doubt("warn", "far", text, "check the depth unit: --set capture.depth_unit=mm")
    if plan.holes <= HOLES and plan.far_m <= FAR_M:
        text = f"depth from {plan.near_m:.1f} to {plan.far_m:.1f} m, {plan.holes:.0%} of it holes"
        yield Doubt("ok", "depth", text)
    if survey.judged.capture.one_matrix:
        text = "depth and colour share one stated matrix; the colour camera is estimated"
        yield Doubt("ok", "one matrix", text)


def _looks(survey: Survey, route: Route) -> Iterator[Doubt]:
    seen = survey.directions
    if seen is None or route.kind == "solid":
        return
    gaps = seen.gaps()
    if len(gaps) == 8:
        yield Doubt("warn", "gap", "no picture looks level", "hold the camera upright")
    elif gaps:
        yield Doubt("warn", "gap", f"no picture looks {_listed(gaps)}", "turn to every wall")
    else:
        yield Doubt("ok", "gap", "every heading is looked at")
    if survey.judged.has_depth:
        return  # The alignment knows whether floor and ceiling were met.
    if seen.share_below() == 0:
        text = "no picture looks steeply down; the floor may be missing"
        yield Doubt("warn", "no floor", text, "tilt the camera down while you walk")
    if not (seen.seen[seen.pitches_deg > 20] > 0).any():
        text = "no picture looks up; the ceiling may be missing"
        yield Doubt("warn", "no ceiling", text, "one look up at each wall's top is enough")


def _scale(survey: Survey, route: Route) -> Iterator[Doubt]:
    if route.kind in ("photos", "video"):
        text = "nothing says how large the room is; it is judged from heights that are usual"
        yield Doubt("warn", "scale", text, SCALE_ADVICE)
    elif route.kind == "unposed rgbd":
        return  # Depth in metres gives it.
    elif survey.judged.capture.scale == "unknown":
        text = "its poses have no unit; the size is judged from heights that are usual"
        yield Doubt("warn", "scale", text, SCALE_ADVICE)
    elif survey.judged.capture.scale == "estimated":
        text = f"its scale is an estimate, {survey.judged.capture.scale_sigma:.0%} unsure"
        yield Doubt("ok", "scale", text, SCALE_ADVICE)


def _colour(survey: Survey, route: Route) -> Iterator[Doubt]:
    if not any(frame.colour_path for frame in survey.judged.frames):
        text = "no colour images: blocks will have the colours of their classes"
        yield Doubt("warn", "colour", text)


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
