"""``w2m compare describe``: describe a room for text-to-layout methods."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli import model_options as option

EXAMPLES = """\
w2m compare describe OUT                                        from what a run found
w2m compare describe MY_SCAN --from-truth                       from a scan's truth
w2m compare describe MY_SCAN --agent gemini --keep ASKED        a model writes, from photos
w2m compare describe OUT --for layoutvlm -o room.json           in the format of LayoutVLM
"""

Scene = Annotated[
    Path,
    typer.Argument(
        help="A finished run or a layout; a capture with --agent or --from-truth.",
        show_default=False,
    ),
]
For = Annotated[str, typer.Option("--for", help="The form: text, layoutgpt, idesign or layoutvlm.")]
FromTruth = Annotated[
    bool, typer.Option("--from-truth", help="Describe the truth of a scan of w2m rooms scan.")
]
AgentName = Annotated[
    str,
    typer.Option("--agent", help="Let a model describe the photos of a capture: a name as in "
                 "w2m vln run, or the address of a server."),
]  # fmt: skip
Out = Annotated[
    Path | None,
    typer.Option(
        "--out", "-o", metavar="FILE", help="Write to this file.", show_default="the screen"
    ),
]
Keep = Annotated[Path, typer.Option("--keep", metavar="DIR", help="The folder for the replies.")]
Photos = Annotated[
    int, typer.Option("--photos", help="How many photos the model sees.", min=1, max=32)
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
    """Describe a room in words, by rule from its boxes or by a model from its photos.

    The description goes to LayoutGPT, I-Design or LayoutVLM; w2m compare layouts scores their
    layouts.

    Raises:
        InputError: the scene cannot be read. ServerError, BudgetError: the model does not reply.
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
