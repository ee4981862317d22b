"""File formats: the program's own, glTF, Habitat, RoomPlan and the paper's JSON."""
