"""Tables as text, as HTML and as data frames."""

from __future__ import annotations

import html
import importlib
from typing import Any, Mapping, Sequence

from ._kempf import KempfError

Rows = Sequence[Sequence[str]]


def text(title: str, header: Sequence[str], rows: Rows, notes: Sequence[str] = ()) -> str:
    """A title, aligned columns and notes, one block."""
    lines = [title]
    if rows:
        widths = [max(map(len, column)) for column in zip(header, *rows)]
        for row in (header, *rows):
            lines.append("  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())
    return "\n".join([*lines, *(f"  {note}" for note in notes)])


def page(title: str, header: Sequence[str], rows: Rows, notes: Sequence[str] = ()) -> str:
    """The same for a notebook; nothing in it is taken for markup."""

    def line(cells: Sequence[str], tag: str) -> str:
        return (
            "<tr>" + "".join(f'<{tag} style="text-align: left">{html.escape(cell)}</{tag}>' for cell in cells) + "</tr>"
        )

    table = ""
    if rows:
        body = "".join(line(row, "td") for row in rows)
        table = f"<table><thead>{line(header, 'th')}</thead><tbody>{body}</tbody></table>"
    footer = "".join(f"<div>{html.escape(note)}</div>" for note in notes)
    return f"<div><strong>{html.escape(title)}</strong>{table}{footer}</div>"


def library(kind: str) -> Any:
    """The library of a kind of data frames."""
    if kind not in ("pandas", "polars"):
        raise KempfError(f'kind = {kind!r}: expected "pandas" or "polars"')
    try:
        return importlib.import_module(kind)
    except ImportError as error:
        raise KempfError(f"{kind} is not installed; install it with: pip install {kind}") from error


def frame(columns: Mapping[str, Any], kind: str) -> Any:
    """Columns as a data frame of pandas or polars."""
    return library(kind).DataFrame(dict(columns))


def frame_of(rows: Sequence[Mapping[str, Any]], kind: str) -> Any:
    """Rows as a data frame; what a row does not have is missing there."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    return frame({name: [row.get(name) for row in rows] for name in names}, kind)
