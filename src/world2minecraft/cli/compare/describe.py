"""Describe a room for text-to-layout methods: ``w2m compare describe``."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli import model_options as option

EXAMPLES = """\
w2m compare describe OUT                                        from the objects of a run
w2m compare describe MY_SCAN --from-truth                       from the ground truth of a scan
w2m compare describe MY_SCAN --agent gemini --keep ASKED        written by a model from photos
w2m compare describe OUT --for layoutvlm -o room.json           in the format of LayoutVLM
"""

Scene = Annotated[
    Path,
    typer.Argument(
        help="Finished run or layout. With --agent or --from-truth, a capture.",
        show_default=False,
    ),
]
For = Annotated[
    str, typer.Option("--for", help="Output format: text, layoutgpt, idesign or layoutvlm.")
]
FromTruth = Annotated[
    bool,
    typer.Option("--from-truth", help="Describe the ground truth of a scan from w2m rooms scan."),
]
AgentName = Annotated[
    str,
    typer.Option("--agent", help="Model that describes the photos of a capture: a name as in "
                 "w2m vln run, or a server address."),
]  # fmt: skip
Out = Annotated[
    Path | None,
    typer.Option(
        "--out", "-o", metavar="FILE", help="Write to this file.", show_default="print it"
    ),
]
Keep = Annotated[
    Path, typer.Option("--keep", metavar="DIR", help="Folder to store the model's replies in.")
]
Photos = Annotated[
    int, typer.Option("--photos", help="Number of photos sent to the model.", min=1, max=32)
]


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
    """Describe a room in words, from its bounding boxes by rules or from its photos by a model.

    LayoutGPT, I-Design or LayoutVLM can create layouts from the description, and w2m compare
    layouts scores their layouts.

    Raises:
        InputError: If the scene cannot be read.
        ServerError: If the model does not reply.
        BudgetError: If a limit on requests or cost is reached.
    """
    from world2minecraft.api.comparison import describe_room
    from world2minecraft.core.files import write_text

    told = describe_room(
        scene,
        method=method,
        from_truth=from_truth,
        agent=agent,
        photos=photos,
        replies=keep,
        model=model_options.value(),
    )
    if out is None:
        print(told.text, end="")
        return
    write_text(out, told.text)
    more = "" if told.px_m is None else f" --px-m {told.px_m:.6f}"
    print(f"text   {out}\nnext: give it to the method, then")
    print(f"  w2m compare layouts ITS_LAYOUT {scene}{more}")
