"""Value types, coordinates, classes, errors, files, archives, locks, progress and registries."""
