"""The benchmark: every method on the same records."""

from __future__ import annotations

import json
import os
import sys
from dataclasses import dataclass, field
from typing import Any, Callable, Iterable, Mapping, Optional, Sequence, Union

from . import _kempf, _table
from ._options import options, strings, warn, whole
from ._functions import Estimator, natives_of
from ._quantity import number
from ._record import PathLike
from ._result import Result
from ._study import shown


@dataclass(frozen=True)
class Standing:
    """Scores of a method on one task."""

    #: Task, such as ``"circle"``, which determines the score.
    task: str
    #: Name of the scenario of the records.
    field: str
    method: str
    #: Number of cases.
    cases: int
    #: Number of cases without an estimate, which rank below every estimate.
    failed: int
    #: Median of the score: heading error, deg, or the larger error of K and T, %. ``None`` for failed answers.
    median: Optional[float]
    #: 90 % quantile of the score.
    high: Optional[float]
    #: Mean rank among all methods.
    rank: float


@dataclass(frozen=True, repr=False, eq=False)
class BenchResult(Result):
    """The leaderboards of a benchmark; ``document["cases"]`` has every answer."""

    #: Scores task by task, the best method first.
    standings: tuple[Standing, ...]
    #: Skipped records, with reasons.
    warnings: tuple[str, ...]
    _text: str = field(repr=False)

    def _table(self) -> tuple[str, Sequence[str], Sequence[Sequence[str]], Sequence[str]]:
        header = ["task", "records", "method", "cases", "failed", "median", "90 %", "rank"]
        rows = [
            [row.task, row.field, row.method, str(row.cases), str(row.failed), number(row.median), number(row.high)]
            + [number(row.rank, 1.0)]
            for row in self.standings
        ]
        return "Benchmark", header, rows, self.warnings

    def to_frame(self, kind: str = "pandas") -> Any:
        """One row for every task and method, as a table of ``"pandas"`` or ``"polars"``."""
        return _table.frame_of([vars(row) for row in self.standings], kind)


def bench(
    *scenarios: PathLike,
    methods: Union[str, Iterable[str], None] = None,
    own: Optional[Mapping[str, Estimator]] = None,
    tasks: Union[str, Iterable[str], None] = None,
    sets: Union[str, Iterable[str], None] = None,
    seed: Optional[int] = None,
    progress: Union[bool, Callable[[int, int], object]] = False,
) -> BenchResult:
    """Runs a benchmark, as ``study bench`` does, and writes nothing.

    :param scenarios: scenarios of your own; those of the program where they are left out. The environment variable
        ``KEMPF_DATA`` names the folder of measured records; what is not there is left out, with a warning
    :param methods: methods that take part; all where it is left out
    :param own: functions that take part, as in :func:`kempf.fit`
    :param tasks: tasks that are set, such as ``"circle"``; all where it is left out
    :param sets: names of the scenarios that are run; all where it is left out
    :param seed: seed in place of those of the scenarios
    :param progress: as in :func:`kempf.run`

    Raises :class:`kempf.KempfError` for a scenario that cannot be read, and where there is nothing to ask.
    """
    arguments = options(method=strings(methods), task=strings(tasks), set=strings(sets))
    show = shown("trials") if progress is True else progress or None
    named = [os.fspath(scenario) for scenario in scenarios]
    text, warnings = _kempf.bench(named, arguments, natives_of(own), whole("seed", seed), show)
    if progress is True:
        sys.stderr.write("\n")
    warn(warnings)

    def standing(board: Mapping[str, Any], entry: Mapping[str, Any]) -> Standing:
        place = {name: board[name] for name in ("task", "field", "cases")}
        figures = {name: entry[name] for name in ("method", "failed", "rank")}
        return Standing(**place, **figures, median=entry["median"]["value"], high=entry["high"]["value"])

    boards = json.loads(text)["boards"]
    standings = tuple(standing(board, entry) for board in boards for entry in board["standings"])
    return BenchResult(standings=standings, warnings=tuple(warnings), _text=text)
