"""flexarm beside published measurements: what the scripts `compare.py` of `flexarm bench validation` use.

bench/validation/README.md
"""

from .case import Case, MissingRecord
from .rows import Identified, Row
from .uncertainty import Estimate

__all__ = ["Case", "Estimate", "Identified", "MissingRecord", "Row"]
