"""Films of runs: `flexarm film PAGE|SCENE` (docs/film.md).

arguments.py reads the command line, and program.py makes the film: it opens the page of a run in a browser without a
window (browser.py), takes one picture for each frame, and sends it to ffmpeg or into a file (output.py).
"""
