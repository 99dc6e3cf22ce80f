"""Python functions as identification methods."""

from __future__ import annotations

import math
from typing import Any, Callable, Iterable, Mapping, Optional

from . import _kempf
from ._record import Record

#: A function of one or several records of the same ship. It returns K (1/s), T (s) and δ_r (deg), optionally followed by
#: their 3×3 covariance in these units.
Estimator = Callable[..., Iterable[Any]]

_Answer = tuple[float, float, float, Optional[list[list[float]]]]


def natives_of(own: Optional[Mapping[str, Estimator]]) -> list[tuple[str, Callable[[list[_kempf.Record]], _Answer]]]:
    """Labels and functions for the compiled part."""
    return [(str(label), _native(function)) for label, function in (own or {}).items()]


def _native(function: Estimator) -> Callable[[list[_kempf.Record]], _Answer]:
    def ask(records: list[_kempf.Record]) -> _Answer:
        answer = list(function(*map(Record._of, records)))
        if len(answer) not in (3, 4):
            raise ValueError(f"{len(answer)} values; expected K, T and delta_r, and a covariance or none")
        K, T, delta_r = map(float, answer[:3])
        unit = (1.0, 1.0, math.radians(1.0))
        covariance = None
        if len(answer) == 4 and answer[3] is not None:
            rows = [[float(value) for value in row] for row in answer[3]]
            if [len(row) for row in rows] != [3, 3, 3]:
                raise ValueError("the covariance is no 3x3 matrix")
            covariance = [[rows[i][j] * unit[i] * unit[j] for j in range(3)] for i in range(3)]
        return K, T, math.radians(delta_r), covariance

    return ask
