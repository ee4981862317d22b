"""Fine names of objects: votes for them, and the model that combines votes, shape and place."""
