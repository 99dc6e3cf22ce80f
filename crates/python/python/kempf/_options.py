"""Keywords as options of the program, which checks them."""

from __future__ import annotations

import os
import warnings
from typing import Any, Iterable, Optional, Sequence

from ._kempf import KempfError, KempfWarning


def words(**options: Any) -> list[str]:
    """Every option that is given, as ``--name=value``; several values are given one by one."""
    given = []
    for name, value in options.items():
        option = "--" + name.strip("_").replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            given.append(option)
            continue
        is_one = isinstance(value, (str, os.PathLike)) or not isinstance(value, Iterable)
        for one in [value] if is_one else value:
            given.append(f"{option}={os.fspath(one) if isinstance(one, os.PathLike) else one}")
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
    return [value] if isinstance(value, str) else [str(one) for one in value]


def warn(found: Sequence[str], stacklevel: int = 3) -> None:
    """Says what the program warns of, at the line that called the package."""
    for warning in found:
        warnings.warn(warning, KempfWarning, stacklevel=stacklevel)
