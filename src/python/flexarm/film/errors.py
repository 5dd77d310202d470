"""What can go wrong."""


class InputError(Exception):
    """The command line or a file cannot be used, or a program is missing."""


class FilmError(Exception):
    """The browser or ffmpeg has failed."""
