"""Navigation instructions: generating, parsing, checking and rewriting them."""
