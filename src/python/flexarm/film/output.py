"""Where the frames of a film go: to ffmpeg, or each into a file of its own."""

import contextlib
import os
import shutil
import subprocess
import tempfile

from .errors import FilmError, InputError

# Few players know other formats of pixels. Colours are those of high-definition television, and say so.
MP4 = ("-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p", "-c:v", "libx264", "-preset", "medium",
       "-crf", "18", "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-movflags",
       "+faststart", "-f", "mp4")
# The first frames are samples of the film, from which the palette is made; so ffmpeg need not keep all frames.
GIF = ("-filter_complex",
       "split[a][b];[a]trim=end_frame={samples},palettegen=stats_mode=full[p];"
       "[b]trim=start_frame={samples},setpts=PTS-STARTPTS[c];[c][p]paletteuse=dither=none:diff_mode=rectangle",
       "-f", "gif")


def find_ffmpeg():
    """Return the path of ffmpeg. Raise InputError if it is missing."""
    path = shutil.which("ffmpeg")
    if not path:
        raise InputError("films need Debian's package ffmpeg, which is missing")
    return path


def check_place(path):
    """Raise InputError if there can be no file of this name."""
    folder = os.path.dirname(path) or "."
    if not os.path.isdir(folder):
        raise InputError("cannot write '%s': there is no folder '%s'" % (path, folder))
    if os.path.isdir(path) or not os.access(folder, os.W_OK):
        raise InputError("cannot write '%s'" % path)


class NewFile:
    """A new file: it has another name until it is complete, and goes if it does not get so far."""

    def __init__(self, path):
        self._path = path
        folder, name = os.path.split(path)
        self.part = os.path.join(folder, ".%s.%d.part" % (name[:100], os.getpid()))

    def __enter__(self):
        return self.part

    def __exit__(self, kind, error, traceback):
        if kind is None:
            os.replace(self.part, self._path)
        elif os.path.exists(self.part):
            os.remove(self.part)


def write_picture(path, png):
    with NewFile(path) as part, open(part, "wb") as file:
        file.write(png)


def encode(path, kind, rate, frames, samples):
    """Write a film.

    kind: ".mp4" or ".gif".
    frames: pictures as bytes of PNG files; for a GIF, the first ones are only samples of its colours.
    samples: how many these are.
    """
    options = [word.format(samples=samples) for word in (GIF if kind == ".gif" else MP4)]
    command = [find_ffmpeg(), "-hide_banner", "-loglevel", "error", "-nostdin", "-y", "-f", "image2pipe", "-c:v",
               "png", "-framerate", repr(rate), "-i", "pipe:0", *options]
    with NewFile(path) as part, tempfile.TemporaryFile() as log:
        # In a session of its own: Ctrl-C in a terminal is for this program alone.
        ffmpeg = subprocess.Popen([*command, "file:" + part], stdin=subprocess.PIPE, stdout=log, stderr=log,
                                  start_new_session=True)
        try:
            for frame in frames:
                ffmpeg.stdin.write(frame)
        except BrokenPipeError:
            pass  # it has failed, and says why
        except BaseException:
            ffmpeg.kill()
            ffmpeg.wait()
            raise
        finally:
            with contextlib.suppress(BrokenPipeError):  # of a rest that nobody reads any more
                ffmpeg.stdin.close()
        if ffmpeg.wait():
            log.seek(0)
            raise FilmError("ffmpeg has failed: " + log.read().decode(errors="replace").strip())
