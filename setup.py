"""The Python package without ROS, for pip: the core and the extension module by CMake, without catkin.

CMAKE_ARGS in the environment are options for CMake, as -DFLEXARM_NATIVE=ON.
"""

import os
import shlex
import subprocess
import sys
import xml.etree.ElementTree

from setuptools import Extension, find_packages, setup
from setuptools.command.build_ext import build_ext

ROOT = os.path.dirname(os.path.abspath(__file__))


class CMake(build_ext):
    """Builds what CMakeLists.txt has with FLEXARM_ROS=OFF, and installs it beside the package's files."""

    def run(self):
        folder = os.path.abspath(self.build_temp)
        options = ["-DFLEXARM_ROS=OFF", "-DFLEXARM_FILES_TOGETHER=ON", "-DPYTHON_EXECUTABLE=" + sys.executable]
        options += shlex.split(os.environ.get("CMAKE_ARGS", ""))
        subprocess.check_call(["cmake", "-S", ROOT, "-B", folder, *options])
        subprocess.check_call(["cmake", "--build", folder, "--parallel", str(len(os.sched_getaffinity(0)))])
        subprocess.check_call(["cmake", "--install", folder, "--prefix", os.path.abspath(self.build_lib)])


package = xml.etree.ElementTree.parse(os.path.join(ROOT, "package.xml")).getroot()
setup(
    name="flexarm",
    version=package.findtext("version"),
    description=" ".join(package.findtext("description").split()),
    license=package.findtext("license"),
    python_requires=">=3.8",
    install_requires=["numpy"],
    extras_require={
        "sweep": ["scipy", "h5py", "pyyaml"],
        "identification": ["scipy", "pyyaml"],
        "plots": ["matplotlib", "scipy", "h5py"],
    },
    package_dir={"": "src/python"},
    packages=find_packages("src/python"),
    package_data={"flexarm": ["*.pyi", "py.typed"]},
    ext_modules=[Extension("flexarm._flexarm", [])],
    cmdclass={"build_ext": CMake},
    zip_safe=False,
)
