"""What the game does to blocks: whom they join, what holds them, how light spreads."""
