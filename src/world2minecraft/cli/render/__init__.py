"""The verb ``w2m render``, which renders images of builds."""
