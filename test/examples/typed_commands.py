"""Commands of documents, typed as they stand."""

import os
import re
import subprocess
import sys

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))


def text_of(name):
    with open(os.path.join(ROOT, "docs", name), encoding="utf-8") as file:
        return file.read()


def commands_of(name):
    """Those of a document in docs/, block by block."""
    return re.findall(r"^```sh\n(.*?)^```", text_of(name), re.DOTALL | re.MULTILINE)


def type_commands(commands, program, folder, setup=None):
    """Runs them in a folder, `flexarm` being the program, python the test's own; status, and what is printed. `setup`:
    a script that is sourced first."""
    path = [os.path.dirname(program), os.path.dirname(sys.executable), os.environ["PATH"]]
    result = subprocess.run(
        ["bash", "-c", "\n".join([f"source {setup}" if setup else "", "set -e", *commands])],
        cwd=folder,
        env=dict(os.environ, PATH=os.pathsep.join(path)),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        universal_newlines=True,
        check=False,
    )
    print(result.stdout)
    return result.returncode, result.stdout
