"""Networks of others, asked for by name: how they are had, and how pictures are made for them."""
