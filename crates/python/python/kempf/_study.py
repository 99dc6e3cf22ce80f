"""Studies: a whole scenario, as the program runs it."""

from __future__ import annotations

import json
import os
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Callable, Mapping, Optional, Sequence, Union

from . import _kempf, _table
from ._options import warn, whole
from ._quantity import number
from ._record import PathLike
from ._result import Result
from ._simulate import Scenario, scene

#: Columns of the summary that are shown behind the labels of a cell; ``to_frame`` has all.
SHOWN = (
    "method",
    "trials",
    "failed",
    *(f"{index} {what} [%]" for index in "KT" for what in ("mean error", "sd", "coverage")),
)

#: Maximum number of lines shown.
LINES = 40


@dataclass(frozen=True, repr=False, eq=False)
class StudyResult(Result):
    """A finished study and the folder that holds it: rows, summary, figures, ``report.html``."""

    folder: Path
    #: Scenario, program and machine of the study.
    manifest: Mapping[str, Any]
    #: One entry for every cell and method.
    summary: tuple[Mapping[str, Any], ...]
    #: Notes, such as on a resumed run.
    notes: tuple[str, ...]
    #: Warnings.
    warnings: tuple[str, ...]
    _text: str = field(repr=False)

    @property
    def rows_path(self) -> Path:
        """The folder of the rows: one for every trial and method, a file of Parquet a block of trials."""
        return self.folder / "rows"

    def rows(self, kind: str = "pandas") -> Any:
        """The rows as a table of ``"pandas"`` or ``"polars"``."""
        files = self.rows_path / "*.parquet" if kind == "polars" else self.rows_path
        return _table.library(kind).read_parquet(os.fspath(files))

    def to_frame(self, kind: str = "pandas") -> Any:
        """The summary, one row for every cell and method, as a table of ``"pandas"`` or ``"polars"``."""
        return _table.frame_of(self.summary, kind)

    def _table(self) -> tuple[str, Sequence[str], Sequence[Sequence[str]], Sequence[str]]:
        names = list(self.summary[0])
        labels = names[: names.index("method")]
        header = [*labels, *(name for name in SHOWN if name in names)]

        def cell(value: Any) -> str:
            return str(value) if isinstance(value, (str, int)) else number(value)

        rows = [[cell(entry[name]) for name in header] for entry in self.summary[:LINES]]
        notes = [f"{len(self.summary) - LINES} more lines: to_frame() has them"] if len(self.summary) > LINES else []
        notes.append(f"results: {self.folder}")
        return f"Study {self.manifest['name']}", header, rows, notes


def run(
    scenario: Scenario,
    out: Optional[PathLike] = None,
    *,
    threads: Optional[int] = None,
    seed: Optional[int] = None,
    progress: Union[bool, Callable[[int, int], object]] = False,
    restart: bool = False,
) -> StudyResult:
    """Runs a scenario, as ``study SCENARIO.toml`` does: what is missing in the folder is run, and everything is
    published there. The rows are the same whatever the number of threads and however often a run was interrupted.

    :param scenario: the path of a scenario, its TOML text, or a dictionary of the same keys
    :param out: folder for the results; ``results/NAME`` where it is left out
    :param threads: threads for the trials; all cores where it is left out
    :param seed: seed in place of the scenario's
    :param progress: ``True`` shows on standard error how many trials are done; a function is called with that number
        and the most there can be
    :param restart: whether rows of an earlier run in the folder are thrown away

    Raises :class:`kempf.KempfError` for a scenario that cannot be read and a folder that holds another study,
    :class:`kempf.WorkError` where it cannot be written. Ctrl-C stops between two trials and raises
    ``KeyboardInterrupt``; the rows are kept, and the same call goes on from there.
    """
    show = shown("trials") if progress is True else progress or None
    text, notes, warnings = _kempf.run(
        scene(scenario),
        None if out is None else os.fspath(out),
        threads,
        whole("seed", seed),
        bool(restart),
        show,
    )
    if progress is True:
        sys.stderr.write("\n")
    warn(warnings)
    document = json.loads(text)
    return StudyResult(
        folder=Path(document["folder"]),
        manifest=document["manifest"],
        summary=tuple(document["summary"]),
        notes=tuple(notes),
        warnings=tuple(warnings),
        _text=text,
    )


def shown(what: str) -> Callable[[int, int], object]:
    """Progress display on standard error."""

    def show(done: int, most: int) -> None:
        sys.stderr.write(f"\r{done} of {most} {what}")
        sys.stderr.flush()

    return show
