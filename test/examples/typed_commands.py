"""Run the commands of documents, typed as they stand there."""

import os
import re
import subprocess
import sys

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))


def text_of(name):
    with open(os.path.join(ROOT, "docs", name), encoding="utf-8") as file:
        return file.read()


def commands_of(name):
    """Return the commands of a document in docs/, one text for each block."""
    return re.findall(r"^```sh\n(.*?)^```", text_of(name), re.DOTALL | re.MULTILINE)


# Variables that `source setup.bash` sets. A workspace around the tests may have set them already.
OF_WORKSPACES = "CMAKE_PREFIX_PATH", "LD_LIBRARY_PATH", "PKG_CONFIG_PATH", "PYTHONPATH", "ROS_PACKAGE_PATH"


def type_commands(commands, setup, folder):
    """Run commands in a folder, in a shell that has sourced `setup` and nothing else. Return the exit status and the
    output."""
    environment = {name: value for name, value in os.environ.items() if name not in OF_WORKSPACES}
    environment["CMAKE_POLICY_VERSION_MINIMUM"] = "3.5"  # catkin's own top-level file, with CMake 4 (docs/install.md)
    environment["PATH"] = os.path.dirname(sys.executable) + ":/usr/bin:/bin:/usr/sbin:/sbin"
    result = subprocess.run(
        ["bash", "-c", "\n".join([f"source '{setup}'", "set -e", *commands])],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        universal_newlines=True,
        check=False,
    )
    print(result.stdout)
    return result.returncode, result.stdout
