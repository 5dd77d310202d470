"""Numbers that stand in the sources of tests, for the scripts beside this file that compute them again."""

import os
import re

TESTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")


def stated_numbers(path, behind, count):
    """Return the first `count` numbers behind a text of a file below test/, without those in strings and names."""
    with open(os.path.join(TESTS, path), encoding="utf-8") as file:
        text = file.read()
    assert text.count(behind) == 1, behind
    rest = re.sub(r'"[^"\n]*"', "", text[text.index(behind) + len(behind):])
    return [float(number) for number in re.findall(r"(?<![\w.])-?\d+\.?\d*(?:e-?\d+)?(?![\w.])", rest)[:count]]
