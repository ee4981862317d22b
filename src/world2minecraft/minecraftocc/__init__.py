"""MinecraftOcc: from worlds to labelled images, and the files that trainers read."""
