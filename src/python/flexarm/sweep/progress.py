"""A progress bar on the terminal, with an estimate of the remaining time."""

import sys
import time

WIDTH = 40  # characters
INTERVAL = 0.2  # between drawings [s]


def duration_text(seconds):
    """A duration in its two largest units: '2 h 05 min', '1 min 40 s', '12 s'."""
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return "%d h %02d min" % (hours, minutes)
    return "%d min %02d s" % (minutes, seconds) if minutes else "%d s" % seconds


class ProgressBar:
    """Shows how many of `whole` runs are done; `done` at the start. Draws nothing if standard error is no terminal."""

    def __init__(self, done, whole, is_wanted):
        self._first, self._whole = done, whole
        self._is_visible = is_wanted and sys.stderr.isatty()
        self._begin = time.monotonic()
        self._next = self._begin
        self._is_drawn = False

    def show(self, done, failures):
        now = time.monotonic()
        if not self._is_visible or now < self._next:
            return
        self._next = now + INTERVAL
        text = "%d of %d" % (done, self._whole)
        if failures:
            text += ", %d failed" % failures
        if done > self._first:
            left = (now - self._begin) / (done - self._first) * (self._whole - done)
            text += ", %s left" % duration_text(left)
        filled = done * WIDTH // self._whole
        bar = "[%s%s] %3d %%  " % ("#" * filled, " " * (WIDTH - filled), 100 * done // self._whole)
        print("\r" + bar + text, end="\033[K", file=sys.stderr, flush=True)
        self._is_drawn = True

    def clear(self):
        if self._is_drawn:
            print("\r", end="\033[K", file=sys.stderr, flush=True)
        self._is_drawn = False
