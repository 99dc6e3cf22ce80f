"""Records: one trial as a time series."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterable, Mapping, Optional, Union, overload

from . import _kempf, _plot, _table
from ._kempf import KempfError
from ._options import options, warn

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    _Array = npt.NDArray[np.float64]

#: Seconds on the clock of a record, or a time of day such as "14:03:05".
Moment = Union[float, str]
PathLike = Union[str, "os.PathLike[str]"]


class _Described:
    """A column with its documentation."""

    def __init__(self, doc: str) -> None:
        self.__doc__ = doc

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name


class _Needed(_Described):
    """A column that every record has."""

    @overload
    def __get__(self, record: None, owner: type) -> _Needed: ...

    @overload
    def __get__(self, record: Record, owner: type) -> _Array: ...

    def __get__(self, record: Optional[Record], owner: type) -> Union[_Needed, _Array]:
        return self if record is None else record[self.name]


class _Column(_Described):
    """A column that a record may have."""

    @overload
    def __get__(self, record: None, owner: type) -> _Column: ...

    @overload
    def __get__(self, record: Record, owner: type) -> Optional[_Array]: ...

    def __get__(self, record: Optional[Record], owner: type) -> Union[_Column, Optional[_Array]]:
        if record is None:
            return self
        return record[self.name] if self.name in record.columns else None


class Record:
    """One trial as a time series, simulated or measured.

    A record is made by :func:`kempf.read`, :meth:`from_arrays`, :meth:`from_frame` or :func:`kempf.simulate` and does
    not change. Its columns are NumPy arrays that cannot be written to, one value a row, NaN where nothing was read;
    a column that the record does not have is ``None``. ``record["name"]`` gives any column, also one of your own.

    >>> import numpy as np
    >>> t = np.arange(0.0, 120.0)
    >>> rudder = np.where(t % 60 < 30, 10.0, -10.0)
    >>> record = Record.from_arrays(t_s=t, rudder_deg=rudder, heading_deg=8 * np.sin((t - 25) / 9.55), name="weave")
    >>> record
    Record weave: 120 rows, 119 s
      t_s, heading_deg, rudder_deg
    >>> float(record.rudder_deg[0])
    10.0
    """

    t_s = _Needed("Time, s, strictly increasing; not necessarily from 0.")
    heading_deg = _Needed("Heading, deg, clockwise, without jumps at 360°.")
    rudder_deg = _Needed("Rudder angle, deg; positive turns to starboard.")
    rudder_order_deg = _Column("Ordered rudder angle, deg.")
    yaw_rate_deg_s = _Column("Yaw rate, deg/s.")
    speed_m_s = _Column("Speed, m/s.")
    surge_m_s = _Column("Surge velocity, m/s, forward.")
    sway_m_s = _Column("Sway velocity, m/s, to starboard.")
    north_m = _Column("Position north, m.")
    east_m = _Column("Position east, m.")
    roll_deg = _Column("Roll angle, deg.")
    propeller_rps = _Column("Propeller revolutions, 1/s.")
    wind_relative_speed_m_s = _Column("Speed of the relative wind, m/s.")
    wind_relative_from_deg = _Column("Where the relative wind comes from, deg, clockwise from the bow.")
    wind_true_speed_m_s = _Column("Speed of the true wind, m/s.")
    wind_true_from_deg = _Column("Where the true wind comes from, deg.")

    _native: _kempf.Record
    _arrays: dict[str, _Array]

    def __init__(self) -> None:
        raise TypeError("a record is made by kempf.read, Record.from_arrays, Record.from_frame or kempf.simulate")

    @classmethod
    def _of(cls, native: _kempf.Record) -> Record:
        record = cls.__new__(cls)
        record._native = native
        record._arrays = {}
        return record

    @classmethod
    def from_arrays(
        cls,
        *,
        t_s: Any,
        rudder_deg: Any,
        heading_deg: Any = None,
        yaw_rate_deg_s: Any = None,
        name: str = "record",
        trial: Optional[int] = None,
        from_s: Optional[Moment] = None,
        until_s: Optional[Moment] = None,
        length_m: Optional[float] = None,
        ship_speed_m_s: Optional[float] = None,
        ship_speed_kn: Optional[float] = None,
        ship: Optional[Mapping[str, float]] = None,
        **columns: Any,
    ) -> Record:
        """A record from arrays, lists or anything with one number a row.

        Time (s), rudder (deg) and heading (deg) or yaw rate (deg/s) are needed; any other column has the name it would
        have in a file, such as ``speed_m_s`` or ``wind_true_from_deg``. NaN stands for what was not read, and headings
        may jump at 360°. It is read as a file ``NAME.csv`` with these columns would be: the same checks, the same
        numbers, and of a long log the zig-zag. ``trial``, ``from_s``, ``until_s``, ``length_m``, ``ship`` are those of
        :func:`kempf.read`, ``ship_speed_m_s`` and ``ship_speed_kn`` the approach speed.

        Raises :class:`kempf.KempfError` where the columns make no record.
        """
        given = {"t_s": t_s, "heading_deg": heading_deg, "rudder_deg": rudder_deg, "yaw_rate_deg_s": yaw_rate_deg_s}
        given.update(columns)
        arguments = options(
            trial=trial,
            from_=from_s,
            until=until_s,
            length_m=length_m,
            speed_m_s=ship_speed_m_s,
            speed_kn=ship_speed_kn,
            **(ship or {}),
        )
        return cls._of_columns({key: values for key, values in given.items() if values is not None}, name, arguments, 4)

    @classmethod
    def from_frame(
        cls,
        frame: Any,
        *,
        name: str = "record",
        trial: Optional[int] = None,
        from_s: Optional[Moment] = None,
        until_s: Optional[Moment] = None,
        length_m: Optional[float] = None,
        ship_speed_m_s: Optional[float] = None,
        ship_speed_kn: Optional[float] = None,
        ship: Optional[Mapping[str, float]] = None,
    ) -> Record:
        """A record from a table of pandas or polars, or anything with ``columns`` and ``table[name]``.

        Columns are called as in files: ``t_s``, ``heading_deg``, ``rudder_deg``, ... The dates of a ``DatetimeIndex`` of
        pandas are the time where no column is one, as the clock of its zone shows them. The rest is as in
        :meth:`from_arrays`.

        Raises :class:`kempf.KempfError` where the columns make no record.
        """
        arguments = options(
            trial=trial,
            from_=from_s,
            until=until_s,
            length_m=length_m,
            speed_m_s=ship_speed_m_s,
            speed_kn=ship_speed_kn,
            **(ship or {}),
        )
        return cls._of_columns(_columns(frame), name, arguments, 4)

    @classmethod
    def _of_columns(cls, columns: Mapping[str, Any], name: str, arguments: list[str], stacklevel: int) -> Record:
        native = _kempf.record_of(name, [(key, _cells(key, values)) for key, values in columns.items()], arguments)
        warn(native.warnings, stacklevel)
        return cls._of(native)

    @property
    def name(self) -> str:
        """Name of the record: that of its file without the ending."""
        return self._native.name

    @property
    def file(self) -> str:
        """File as it was named."""
        return self._native.file

    @property
    def sha256(self) -> str:
        """SHA-256 of the bytes of its file, or of the part of it that is used."""
        return self._native.sha256

    @property
    def length_m(self) -> Optional[float]:
        """Length of the ship, m, where it is known."""
        return self._native.length_m

    @property
    def approach_speed_m_s(self) -> Optional[float]:
        """Approach speed of the ship, m/s, where it is known."""
        return self._native.speed_m_s

    @property
    def heading_from_yaw_rate(self) -> bool:
        """Whether the heading is the integral of the yaw rate, because none was recorded."""
        return self._native.heading_from_yaw_rate

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the reader had to decide or found remarkable."""
        return tuple(self._native.warnings)

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns."""
        return tuple(self._native.columns())

    def __getitem__(self, name: str) -> _Array:
        if name not in self._arrays:
            values = self._native.column(name)
            if values is None:
                raise KeyError(f"{name}: the record {self.name} has the columns {', '.join(self.columns)}")
            values.flags.writeable = False
            self._arrays[name] = values
        return self._arrays[name]

    def __len__(self) -> int:
        return len(self._native)

    def __repr__(self) -> str:
        seconds = self.t_s[-1] - self.t_s[0]
        return f"Record {self.name}: {len(self)} rows, {seconds:g} s\n  {', '.join(self.columns)}"

    def _repr_html_(self) -> str:
        def cells(name: str) -> list[str]:
            import numpy as np

            values = self[name][np.isfinite(self[name])]
            return [name, str(len(values)), *(f"{end:.4g}" for end in (values.min(), values.max()))]

        title = f"{self.name}: {len(self)} rows, {self.t_s[-1] - self.t_s[0]:g} s"
        return _table.page(title, ["column", "values", "least", "most"], [cells(name) for name in self.columns])

    def to_frame(self, kind: str = "pandas") -> Any:
        """The columns as a table of ``"pandas"`` or ``"polars"``."""
        return _table.frame({name: self[name] for name in self.columns}, kind)

    def save(self, path: PathLike) -> Path:
        """Writes the record as CSV, as ``study simulate`` does; reading it gives the same record."""
        path = Path(path)
        path.write_bytes(self._native.csv().encode())
        return path

    def plot(self) -> Any:
        """Heading and rudder over time, as a figure of Matplotlib."""
        return _plot.record(self)


#: Names of columns that are the time of a table.
TIMES = ("t", "t_s", "t_ms", "t_min", "time", "timestamp", "datetime", "utc", "date")


def _columns(frame: Any) -> dict[str, Any]:
    """The columns of a table, the dates of its index before them."""
    columns = {str(key): frame[key] for key in frame.columns}
    index: Any = getattr(frame, "index", None)
    if hasattr(index, "tz_localize") and not any(name.lower() in TIMES for name in columns):
        return {"time": index.tz_localize(None), **columns}
    return columns


def _cells(name: str, values: Any) -> Any:
    """A column as numbers, or as words where it holds none, such as stamps of time."""
    import numpy as np

    array = values.to_numpy() if hasattr(values, "to_numpy") else np.asarray(values)
    if array.ndim != 1:
        raise KempfError(f"{name} has {array.ndim} dimensions; expected one number a row")
    if array.dtype.kind in "fiub":
        return np.ascontiguousarray(array, dtype=np.float64)
    try:
        return np.ascontiguousarray(array, dtype=np.float64) if array.dtype.kind == "O" else [str(v) for v in array]
    except (TypeError, ValueError):
        return ["" if value is None else str(value) for value in array]


def read(
    path: PathLike,
    *,
    columns: Optional[PathLike] = None,
    with_columns: Union[PathLike, Iterable[PathLike]] = (),
    trial: Optional[int] = None,
    from_s: Optional[Moment] = None,
    until_s: Optional[Moment] = None,
    length_m: Optional[float] = None,
    speed_m_s: Optional[float] = None,
    speed_kn: Optional[float] = None,
    ship: Optional[Mapping[str, float]] = None,
) -> Record:
    """Reads a record: CSV and other tables, NMEA sentences, Parquet, MATLAB, packed or not.

    A sidecar ``NAME.trial.toml`` beside the file is found by itself. Of a long log the zig-zag is used, where there is
    one.

    :param columns: a sidecar that describes the columns, or a folder of sidecars
    :param with_columns: further files of the same trial, such as one with the rudder, joined by time
    :param trial: number of the manoeuvre in the log, from 1, as ``study find`` lists them
    :param from_s: begin of the part that is used: seconds on the clock of the record, or a time such as ``"14:03:05"``
    :param until_s: its end
    :param length_m: length of the ship between perpendiculars, m
    :param speed_m_s: approach speed, m/s; that of the record where it is left out
    :param speed_kn: the same in knots
    :param ship: what is known of the hull, called as the options of ``study fit``: ``{"beam_m": 58, "draught_m": 20.8}``

    Raises :class:`kempf.KempfError` where the file holds no record; what the reader had to decide is a
    :class:`kempf.KempfWarning`.
    """
    arguments = options(
        columns=columns,
        with_columns=with_columns,
        trial=trial,
        from_=from_s,
        until=until_s,
        length_m=length_m,
        speed_m_s=speed_m_s,
        speed_kn=speed_kn,
        **(ship or {}),
    )
    read_records = _kempf.read(os.fspath(path), arguments)
    if len(read_records) != 1:
        raise KempfError(
            f"{path}: this is a folder of {len(read_records)} records; name one of them, or give kempf.fit the folder"
        )
    warn(read_records[0].warnings)
    return Record._of(read_records[0])


def _is_path(value: Any) -> bool:
    return isinstance(value, (str, os.PathLike))


def natives(records: Any) -> list[_kempf.Record]:
    """The records that a function was given: one or several records, simulated trials, tables or files."""
    several = isinstance(records, Iterable) and not (_is_path(records) or isinstance(records, Record))
    if not several or hasattr(records, "columns"):
        records = [records]
    native: list[_kempf.Record] = []
    for item in records:
        item = getattr(item, "record", item) if not hasattr(item, "columns") else item
        if isinstance(item, Record):
            native.append(item._native)
        elif hasattr(item, "columns"):
            native.append(Record._of_columns(_columns(item), "record", [], 5)._native)
        elif _is_path(item):
            read = _kempf.read(os.fspath(item), [])
            warn([warning for record in read for warning in record.warnings], 4)
            native.extend(read)
        else:
            raise KempfError(
                f"{type(item).__name__}: expected a record, a simulated trial, a table or the path of a file"
            )
    return native
