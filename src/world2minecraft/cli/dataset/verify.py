"""``w2m dataset verify``: every byte of a data set against its index."""

from world2minecraft.cli.dataset import options as option

EXAMPLES = """\
w2m dataset verify DATA      reads all shards and compares all sums
"""
MAX_SHOWN = 20


def run(folder: option.Folder) -> None:
    """Read a whole data set and tell what is missing, damaged, or does not belong to it.

    Raises:
        InputError: it is no data set, or not finished. DamagedFileError: something is wrong.
    """
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.errors import DamagedFileError
    from world2minecraft.minecraftocc.store import verify_store

    with show_progress() as progress:
        verdict = verify_store(folder, progress)
    for fault in verdict.faults[:MAX_SHOWN]:
        print(f"fault: {fault}")
    if verdict.faults:
        more = len(verdict.faults)
        raise DamagedFileError(
            folder,
            f"has {more:,} fault{'s' * (more > 1)}; delete the shards that are named and run the "
            "same w2m dataset build again",
        )
    size = verdict.bytes / 1e6
    print(f"{folder}: {verdict.samples:,} samples in {verdict.shards:,} shards, {size:,.0f} MB: ok")
    print(f"  sum    {verdict.sha256}")
    print("  next   w2m dataset stats DATA".replace("DATA", str(folder)))
