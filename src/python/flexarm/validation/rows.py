"""What a comparison consists of: rows of numbers, and the numbers that were identified."""

import math
from dataclasses import dataclass

MEASURED, CALCULATED, CLOSED_FORM = KINDS = "measured", "calculated", "closed form"
WITHIN, OUTSIDE, FITTED = "within", "outside", "fitted"  # verdicts


@dataclass(frozen=True)
class Row:
    """A published number beside flexarm's.

    quantity: what it is, with the load or the speed
    published, flexarm: both in `unit`
    own: expanded uncertainty (about 95 %) of the published number and of what the scene is made of, in `unit`; > 0
    kind: how the published number was found: "measured", "calculated" or "closed form"
    note: where the uncertainty is from, and other remarks
    is_fitted: the number was used to identify a parameter of the scene, and so is no prediction
    propagated: expanded uncertainty of flexarm's number that comes from identified ones, in `unit`; >= 0
    group: rows of the same group are counted together on the page that lists all cases, such as "frequencies"
    Raises ValueError if one of them is impossible.
    """

    quantity: str
    published: float
    flexarm: float
    own: float
    unit: str
    kind: str = MEASURED
    note: str = ""
    is_fitted: bool = False
    group: str = ""
    propagated: float = 0.0

    def __post_init__(self):
        if self.kind not in KINDS:
            raise ValueError("%s: kind: expected one of %s, got '%s'" % (self.quantity, ", ".join(KINDS), self.kind))
        if not math.isfinite(self.published):
            raise ValueError("%s: published: expected a finite number, got %s" % (self.quantity, self.published))
        if not (math.isfinite(self.own) and self.own > 0):
            raise ValueError("%s: own: expected a number > 0, got %s" % (self.quantity, self.own))
        if not (math.isfinite(self.propagated) and self.propagated >= 0):
            raise ValueError("%s: propagated: expected a number >= 0, got %s" % (self.quantity, self.propagated))

    @property
    def uncertainty(self):
        """Of the comparison: both parts, which are independent."""
        return math.hypot(self.own, self.propagated)

    @property
    def error(self):
        return self.flexarm - self.published

    @property
    def ratio(self):
        """Size of the error in uncertainties. It is NaN if flexarm has no number."""
        return abs(self.error) / self.uncertainty

    @property
    def verdict(self):
        """A fitted number says nothing; everything that is not within is outside, NaN too."""
        if self.is_fitted:
            return FITTED
        return WITHIN if self.ratio <= 1 else OUTSIDE


@dataclass(frozen=True)
class Identified:
    """A number that the source does not give, and that was found from a part of its measurements.

    standard_error: in `unit`; NaN if it was not estimated
    source: the part of the measurements from which it was found
    birge: by which the fitted numbers scatter more than their uncertainties (Birge ratio), 1 if not more
    """

    name: str
    value: float
    unit: str
    source: str
    standard_error: float = math.nan
    birge: float = 1.0


def count(rows):
    """Number of predictions within their uncertainty, and of all predictions."""
    verdicts = [row.verdict for row in rows if not row.is_fitted]
    return verdicts.count(WITHIN), len(verdicts)
