"""The verbs ``w2m paper ...``, which print the tables and draw the figures of the paper."""
