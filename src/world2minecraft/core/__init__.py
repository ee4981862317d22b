"""Foundation: value types, coordinates, classes, errors, files, registries, compilation."""
