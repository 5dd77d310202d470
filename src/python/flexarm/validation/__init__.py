"""flexarm beside published measurements: what the scripts `compare.py` of `flexarm bench validation` use.

bench/validation/README.md
"""

from .case import Case, MissingRecord
from .rows import Identified, Row

__all__ = ["Case", "Identified", "MissingRecord", "Row"]
