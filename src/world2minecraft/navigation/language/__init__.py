"""What walkers are told: instructions written from what happens on a way, read back and checked."""
