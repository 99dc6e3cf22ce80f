"""Base of all results: document, file and table."""

from __future__ import annotations

import json
import os
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar, Iterable, Mapping, Optional, Sequence, Union

from . import _table
from ._kempf import KempfError
from ._record import PathLike


class Result:
    """A result. ``document`` is the JSON document of the program, from which all other attributes are read."""

    #: Warnings, which were also issued as :class:`kempf.KempfWarning`.
    warnings: tuple[str, ...]
    _text: str
    #: Name of the document in messages, where it is a model of a ship.
    _model: ClassVar[Optional[str]] = None

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


def sentence(warning: Mapping[str, Any]) -> str:
    """Text of a warning, after the record, file or method that it concerns."""
    source = warning["source"]
    text: str = warning["text"]
    return text if isinstance(source, str) else f"{next(iter(source.values()))}: {text}"


#: An identified ship: a result of :func:`kempf.fit` or :func:`kempf.trace`, or the path of its file.
Model = Union[Result, str, "os.PathLike[str]"]


def models(given: Union[Model, Iterable[Model]]) -> list[tuple[str, Optional[str]]]:
    """The names of one model or several, each with its text where it is no file."""
    return [_named(model) for model in ([given] if isinstance(given, (Result, str, os.PathLike)) else given)]


def _named(model: Model) -> tuple[str, Optional[str]]:
    if isinstance(model, Result) and model._model is not None:
        return model._model, model._text
    if isinstance(model, (str, os.PathLike)):
        return os.fspath(model), None
    raise KempfError(
        f"{type(model).__name__}: expected a result of kempf.fit or kempf.trace, or the path of their file"
    )
