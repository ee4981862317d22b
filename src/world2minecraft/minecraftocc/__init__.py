"""MinecraftOcc: labelled images of worlds, and the files that trainers read."""
