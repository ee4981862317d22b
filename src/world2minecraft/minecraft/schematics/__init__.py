"""The files that builders share: Sponge, Litematica, structures, and those of before 1.13."""
