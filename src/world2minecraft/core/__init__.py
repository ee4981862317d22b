"""What everything else stands on: value types, coordinates, classes, errors, files, compilation."""
