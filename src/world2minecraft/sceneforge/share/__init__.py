"""A room as one file to send: a page that opens from disk, or a film of the room coming together.

``room_data`` gathers what the page shows, ``page`` writes it as one file of HTML, ``photos``
chooses the photos of a run that go with it, and ``film`` draws the film. The page itself is
``web/src/share``.
"""
