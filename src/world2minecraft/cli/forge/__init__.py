"""The verbs ``w2m forge ...`` of the SceneForge web editor."""
