"""What all results have: the document of the program, a file of it, and a table."""

from __future__ import annotations

import json
from functools import cached_property
from pathlib import Path
from typing import Any, Sequence

from . import _table
from ._record import PathLike


class Result:
    """A result. ``document`` is what the program writes for other programs; everything else is read from it."""

    #: What a person should know; the same was said as :class:`kempf.KempfWarning`.
    warnings: tuple[str, ...]
    _text: str

    @cached_property
    def document(self) -> dict[str, Any]:
        """The whole result, as in the JSON file of the program."""
        document: dict[str, Any] = json.loads(self._text)
        return document

    def save(self, path: PathLike) -> Path:
        """Writes the JSON file that the program writes, byte for byte."""
        path = Path(path)
        path.write_bytes(self._text.encode())
        return path

    def _table(self) -> tuple[str, Sequence[str], Sequence[Sequence[str]], Sequence[str]]:
        raise NotImplementedError

    def __repr__(self) -> str:
        return _table.text(*self._table())

    def _repr_html_(self) -> str:
        return _table.page(*self._table())
