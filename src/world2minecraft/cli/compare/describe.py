"""``w2m compare describe``: a room in the words that text-to-layout methods start from."""

import json
from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli import model_options as option

EXAMPLES = """\
w2m compare describe OUT                                        from what a run found
w2m compare describe MY_SCAN --from-truth                       from a scan's truth
w2m compare describe MY_SCAN --agent gemini --keep ASKED        a model writes, from photos
w2m compare describe OUT --for layoutvlm --out room.json        as LayoutVLM reads it
"""

Scene = Annotated[
    Path,
    typer.Argument(
        help="A finished run or a layout; a capture with --agent or --from-truth.",
        show_default=False,
    ),
]
For = Annotated[
    str, typer.Option("--for", help="text, layoutgpt, idesign or layoutvlm: the form to write.")
]
FromTruth = Annotated[
    bool, typer.Option("--from-truth", help="Describe the truth of a scan of w2m rooms scan.")
]
AgentName = Annotated[
    str,
    typer.Option("--agent", help="Let a model write it from the photos of a capture: a name as "
                 "in w2m vln run, or the address of a server."),
]  # fmt: skip
Out = Annotated[
    Path | None, typer.Option("--out", metavar="FILE", help="Write it here.", show_default="print")
]
Keep = Annotated[Path, typer.Option("--keep", metavar="DIR", help="Where replies are kept.")]
Photos = Annotated[int, typer.Option("--photos", help="How many photos are shown.", min=1, max=32)]


@option.with_model_options()
def run(
    scene: Scene,
    method: For = "text",
    from_truth: FromTruth = False,
    agent: AgentName = "",
    out: Out = None,
    keep: Keep = Path("described"),
    photos: Photos = 6,
    *,
    model_options: option.ModelOptions,
) -> None:
    """Describe a room in words, by rule from its boxes or by a model from its photos.

    The words go to LayoutGPT, I-Design or LayoutVLM; their layouts come back to w2m compare
    layouts.

    Raises:
        InputError: the scene cannot be read. ServerError, BudgetError: the model cannot be asked.
    """
    from world2minecraft.core.errors import UnknownNameError, UsageError
    from world2minecraft.core.files import write_text
    from world2minecraft.paper.layouts.importers import read_layouts_of
    from world2minecraft.paper.layouts.reference_scene import true_scene
    from world2minecraft.paper.layouts.room_description import (
        METHODS,
        describe_scene,
        for_method,
        layoutgpt_px_m,
    )

    if method not in METHODS:
        raise UnknownNameError("form", method, METHODS)
    if agent and method != "text":
        raise UsageError("photos tell no sizes: --agent goes with --for text")
    more = ""
    if agent:
        chat = model_options.open(agent, keep)
        text = describe_photos(scene, photos, chat)
        told = text
    else:
        known = true_scene(scene) if from_truth else read_layouts_of(scene)[0]
        told = for_method(method, known, describe_scene(known))
        if method == "layoutgpt":
            more = f" --px-m {layoutgpt_px_m(known):.6f}"
        text = told if isinstance(told, str) else json.dumps(told, indent=1) + "\n"
    if out is None:
        print(text, end="")
        return
    write_text(out, text)
    print(f"words  {out}\nnext: give it to the method, then")
    print(f"  w2m compare layouts ITS_LAYOUT {scene}{more}")


def describe_photos(capture: Path, count: int, chat: object) -> str:
    """Return what a model says of photos spread over a capture."""
    from world2minecraft.paper.layouts.room_description import capture_photos, describe_photos

    return describe_photos(chat, capture_photos(capture, count))  # type: ignore[arg-type]
