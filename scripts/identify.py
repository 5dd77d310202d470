#!/usr/bin/python3
"""The program that `flexarm identify` runs: finds values of a scene's parameters with which it moves as was measured.

docs/identify.md
"""

import os
import subprocess
import sys

try:
    from flexarm.identification.program import main
except ImportError as error:
    sys.exit(f"flexarm identify: {error}: it needs python3-numpy, python3-scipy and python3-yaml")


def draw(data, picture):
    """Draws residuals. Returns whether this succeeded."""
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "plot_residuals.py")
    return subprocess.run([sys.executable, script, data, picture], check=False).returncode == 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], draw))
