"""Keyword arguments as options of the program, which checks them."""

from __future__ import annotations

import os
import warnings
from typing import Any, Iterable, Optional, Sequence

from ._kempf import KempfError, KempfWarning


def options(**keywords: Any) -> list[str]:
    """The options that have a value, as ``--name=value``; an iterable gives one option per value."""
    given = []
    for name, value in keywords.items():
        option = "--" + name.strip("_").replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            given.append(option)
            continue
        is_scalar = isinstance(value, (str, os.PathLike)) or not isinstance(value, Iterable)
        for item in [value] if is_scalar else value:
            given.append(f"{option}={os.fspath(item) if isinstance(item, os.PathLike) else item}")
    return given


def whole(name: str, value: Any) -> Optional[int]:
    """A whole number from 0 that the program can take, or none."""
    if value is None:
        return None
    try:
        number = value.__index__()
    except AttributeError:
        number = -1
    if not 0 <= number < 2**64:
        raise KempfError(f"{name} = {value!r}: expected a whole number from 0 to {2**64 - 1}")
    return int(number)


def strings(value: Any) -> list[str]:
    """A name, or several, as a list."""
    if value is None:
        return []
    return [value] if isinstance(value, str) else [str(item) for item in value]


def warn(messages: Sequence[str], stacklevel: int = 3) -> None:
    """Issues the warnings of the program at the line that called the package."""
    for message in messages:
        warnings.warn(message, KempfWarning, stacklevel=stacklevel)
