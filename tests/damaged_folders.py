"""Folders that are damaged on purpose, and what they hold."""


def files_of(folder):
    """Return the bytes of each file of a folder by its name there."""
    paths = [path for path in folder.rglob("*") if path.is_file()]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


def flip(path, place=-2):
    """Flip a bit of a file."""
    data = bytearray(path.read_bytes())
    data[place] ^= 1
    path.write_bytes(data)
