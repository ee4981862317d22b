"""File formats for sharing builds: Sponge, Litematica, structures and legacy schematics."""
