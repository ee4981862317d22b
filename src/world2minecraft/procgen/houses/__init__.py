"""Generation of houses: floor plans, stairs and furnished rooms."""
