"""A number with its uncertainty."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Mapping, Optional


@dataclass(frozen=True)
class Quantity:
    """A number, its standard deviation and its 95 % interval, all in one unit.

    ``None`` stands for what a method does not give; the ends of an interval may be infinite or missing alike.

    >>> print(Quantity(0.09994, 0.00008, (0.09979, 0.10009)))
    0.09994 [0.09979, 0.10009]
    """

    value: Optional[float]
    sd: Optional[float]
    ci95: Optional[tuple[Optional[float], Optional[float]]]

    @classmethod
    def of(cls, entry: Mapping[str, Any]) -> Quantity:
        """The quantity of a JSON document."""
        ends = entry.get("ci95")
        return cls(entry.get("value"), entry.get("sd"), None if ends is None else (ends[0], ends[1]))

    def __str__(self) -> str:
        if self.ci95 is None:
            return number(self.value, self.sd)
        width = math.nan
        if None not in self.ci95:
            width = (self.ci95[1] or 0.0) - (self.ci95[0] or 0.0)
        spread = width / 4.0
        ends = ", ".join(number(end, spread) for end in self.ci95)
        return f"{number(self.value, spread)} [{ends}]"


def number(value: Optional[float], sd: Optional[float] = None) -> str:
    """A number to the digits that its error leaves it: two of an error up to 35, one of a larger one, as the Particle
    Data Group rounds. Without an error four digits; a dash for none."""
    if value is None or not math.isfinite(value):
        return "–"
    if not sd or not math.isfinite(sd):
        return f"{value:.4g}"
    place = math.floor(math.log10(abs(sd)))
    digits = 1 if abs(sd) < 3.55 * 10.0**place else 0
    decimals = min(12, max(0, digits - place))
    return f"{value:.{decimals}f}"
