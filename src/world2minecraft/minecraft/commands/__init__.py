"""Write and read commands of data packs, command lists and RCON."""
