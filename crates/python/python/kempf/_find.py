"""Finding: the manoeuvres inside long logs."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Iterable, Optional, Sequence, Union

from . import _kempf, _table
from ._options import options, warn
from ._quantity import number
from ._record import PathLike
from ._result import Result


@dataclass(frozen=True)
class Found:
    """A manoeuvre in a log."""

    #: File of the log.
    file: str
    #: Number of the manoeuvre in the log, from 1: the argument ``trial`` of :func:`kempf.read`.
    trial: int
    #: Kind of the manoeuvre, such as ``"zig-zag 10/10"``.
    kind: str
    from_s: float
    until_s: float
    #: Clock times of beginning and end; ``None`` if the log has no clock.
    clock: Optional[tuple[str, str]]
    #: Number of executes.
    executes: int
    rudder_deg: Optional[float]
    #: Heading angle of the executes, deg.
    heading_deg: Optional[float]
    #: Remarks on the manoeuvre.
    remarks: tuple[str, ...]


@dataclass(frozen=True, repr=False, eq=False)
class FindResult(Result):
    """The manoeuvres found in logs."""

    #: Manoeuvres in the order of the logs and of time.
    manoeuvres: tuple[Found, ...]
    #: Warnings on the logs.
    warnings: tuple[str, ...]
    _text: str = field(repr=False)

    def __len__(self) -> int:
        return len(self.manoeuvres)

    def _table(self) -> tuple[str, Sequence[str], Sequence[Sequence[str]], Sequence[str]]:
        rows = [
            [Path(row.file).name, str(row.trial), row.kind, number(row.from_s, 1.0), number(row.until_s, 1.0)]
            for row in self.manoeuvres
        ]
        notes = [f"{Path(row.file).name} {row.trial}: {remark}" for row in self.manoeuvres for remark in row.remarks]
        return f"{len(rows)} manoeuvres", ["log", "trial", "manoeuvre", "from [s]", "until [s]"], rows, notes

    def to_frame(self, kind: str = "pandas") -> Any:
        """One row a manoeuvre, as a table of ``"pandas"`` or ``"polars"``."""
        return _table.frame_of([vars(row) for row in self.manoeuvres], kind)


def find(
    logs: Union[PathLike, Iterable[PathLike]],
    *,
    columns: Optional[PathLike] = None,
    with_columns: Union[PathLike, Iterable[PathLike]] = (),
) -> FindResult:
    """Lists the manoeuvres inside long logs, as ``study find`` does: zig-zags, turning circles, pull-outs, spirals,
    straight pieces.

    :param logs: files of logs; a folder stands for all its records
    :param columns: a sidecar that describes the columns, or a folder of sidecars
    :param with_columns: further files of the one log, such as one with the rudder, joined by time

    Raises :class:`kempf.KempfError` where a log cannot be read.
    """
    several = [logs] if isinstance(logs, (str, os.PathLike)) else list(logs)
    arguments = options(columns=columns, with_columns=with_columns)
    text, warnings = _kempf.find([os.fspath(log) for log in several], arguments)
    warn(warnings)

    def manoeuvre(file: str, entry: dict[str, Any]) -> Found:
        clock = entry["clock"]
        fields = {**entry, "clock": None if clock is None else tuple(clock), "remarks": tuple(entry["remarks"])}
        return Found(file=file, **fields)

    entries = json.loads(text)["logs"]
    manoeuvres = tuple(manoeuvre(log["file"], entry) for log in entries for entry in log["manoeuvres"])
    return FindResult(manoeuvres=manoeuvres, warnings=tuple(warnings), _text=text)
