"""Test the Python package, next to the messages that share its name."""

import os
import pydoc
import subprocess
import sys
import xml.etree.ElementTree

import pytest

import flexarm
from conftest import ROOT


def test_messages_are_in_the_same_package():
    import flexarm.msg
    import flexarm.srv

    assert flexarm.msg.JointForceCommand().names == []
    assert flexarm.srv.Step.__name__ == "Step"
    assert flexarm.Simulation.__name__ == "Simulation"


def test_messages_do_not_load_the_simulator():
    check = "import sys, flexarm.msg; flexarm.msg.BeamState; sys.exit('flexarm._flexarm' in sys.modules)"
    subprocess.run([sys.executable, "-c", check], check=True)


def test_all_names_are_there():
    for name in flexarm.__all__:
        assert getattr(flexarm, name).__doc__, name
        assert name in dir(flexarm)
    with pytest.raises(AttributeError, match="module 'flexarm' has no attribute 'simulation'"):
        flexarm.simulation


def test_the_version_is_that_of_the_package():
    package = xml.etree.ElementTree.parse(os.path.join(ROOT, "package.xml"))
    assert flexarm.__version__ == package.findtext("version")


def test_everything_is_explained():
    for type_ in (flexarm.Simulation, flexarm.LinearModel, flexarm.Scene, flexarm.State, flexarm.StepResult,
                  flexarm.Environment, flexarm.Run):
        for name, member in vars(type_).items():
            if not name.startswith("_") and (callable(member) or isinstance(member, property)):
                text = pydoc.getdoc(member)
                assert text, (type_.__name__, name)
    text = pydoc.render_doc(flexarm.Simulation, renderer=pydoc.plaintext)
    for unit in ("[s]", "[rad or m]", "[J]", "[kg]", "shape (joints,)", "shape (links, 7)"):
        assert unit in text
