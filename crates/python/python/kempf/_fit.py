"""Identification: K, T and δ_r of records by every method."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Iterable, Mapping, Optional, Sequence, Union

from . import _kempf, _plot, _table
from ._kempf import KempfError
from ._options import strings, warn, whole
from ._functions import Estimator, natives_of
from ._quantity import Quantity, number
from ._record import Record, natives
from ._result import Model, Result, models, sentence


@dataclass(frozen=True)
class Method:
    """The answer of one method."""

    #: Identifier, such as ``"output-error"``.
    method: str
    #: ``True`` if the method gave an estimate.
    ok: bool
    #: Reason of a failure; ``None`` for an estimate.
    reason: Optional[str]
    #: Gain K, 1/s.
    K_per_s: Optional[Quantity]
    #: Time constant T, s; negative for a course-unstable ship.
    T_s: Optional[Quantity]
    #: Rudder bias δ_r, deg.
    delta_r_deg: Optional[Quantity]
    #: K' = K L/V; ``None`` if length or speed of the ship is unknown.
    K_prime: Optional[Quantity]
    #: T' = T V/L; ``None`` if length or speed of the ship is unknown.
    T_prime: Optional[Quantity]
    #: ``True`` if the ship is course-unstable (T < 0).
    course_unstable: Optional[bool]
    #: Root mean square of measured less replayed heading on the fitted records, deg.
    heading_rmse_deg: Optional[float]
    #: Root mean square of measured less replayed heading on every validation record, deg. Only the initial state of
    #: the record is fitted.
    validation_rmse_deg: tuple[Optional[float], ...]
    #: Diagnostics of the method.
    diagnostics: Mapping[str, float]

    @classmethod
    def _of(cls, entry: Mapping[str, Any]) -> Method:
        parameters, prime = entry.get("parameters") or {}, entry.get("prime") or {}

        def quantity(entries: Mapping[str, Any], name: str) -> Optional[Quantity]:
            return Quantity.of(entries[name]) if name in entries else None

        return cls(
            method=entry["method"],
            ok=entry["status"] == "ok",
            reason=entry["reason"],
            K_per_s=quantity(parameters, "K_per_s"),
            T_s=quantity(parameters, "T_s"),
            delta_r_deg=quantity(parameters, "delta_r_deg"),
            K_prime=quantity(prime, "K"),
            T_prime=quantity(prime, "T"),
            course_unstable=entry["course_unstable"],
            heading_rmse_deg=entry["heading_rmse_deg"],
            validation_rmse_deg=tuple(on["heading_rmse_deg"] for on in entry["validation"]),
            diagnostics=entry["diagnostics"],
        )


@dataclass(frozen=True)
class ZigZag:
    """Characteristics of a zig-zag."""

    #: Time from the first execute until the heading has changed by the angle of the manoeuvre, s.
    initial_turning_time_s: Optional[float]
    #: Overshoot angles in their order, deg; ``None`` for a peak outside the record.
    overshoots_deg: tuple[Optional[float], ...]
    #: Standard deviations of the overshoot angles, deg.
    overshoots_sd_deg: tuple[Optional[float], ...]
    #: Period of the zig-zag, s.
    period_s: Optional[float]
    #: Criteria of IMO MSC.137(76), each as in the document; empty if length or speed is unknown.
    imo: tuple[Mapping[str, Any], ...]


@dataclass(frozen=True)
class RecordEntry:
    """A record that was fitted."""

    file: str
    sha256: str
    #: Number of rows with a rudder.
    samples: int
    duration_s: float
    #: Characteristics of the zig-zag; ``None`` if the record is no zig-zag.
    zigzag: Optional[ZigZag]

    @classmethod
    def _of(cls, entry: Mapping[str, Any]) -> RecordEntry:
        figures = entry["zigzag"]
        zigzag = None
        if figures is not None:
            zigzag = ZigZag(
                initial_turning_time_s=figures["initial_turning_time_s"],
                overshoots_deg=tuple(figures["overshoots_deg"]),
                overshoots_sd_deg=tuple(figures["overshoots_sd_deg"]),
                period_s=figures["period_s"],
                imo=tuple(figures["imo"]),
            )
        return cls(entry["file"], entry["sha256"], entry["samples"], entry["duration_s"], zigzag)


@dataclass(frozen=True, repr=False, eq=False)
class FitResult(Result):
    """Estimates of all methods from the same records; ``result["output-error"]`` is one of them."""

    _model = "fit.json"

    #: Results in the order of the methods.
    methods: tuple[Method, ...]
    #: Fitted records.
    records: tuple[RecordEntry, ...]
    #: Warnings on the records and on the results.
    warnings: tuple[str, ...]
    _text: str = field(repr=False)
    _native: _kempf.Fit = field(repr=False)

    @property
    def best(self) -> Optional[Method]:
        """The answer to take, as ``study fit`` says before its table; ``document["verdict"]`` says why. ``None`` where
        the verdict names none."""
        verdict = self.document.get("verdict")
        return None if verdict is None else self[verdict["method"]]

    def __getitem__(self, method: str) -> Method:
        for answer in self.methods:
            if answer.method == method:
                return answer
        raise KeyError(f"{method}: there are {', '.join(answer.method for answer in self.methods)}")

    def _table(self) -> tuple[str, Sequence[str], Sequence[Sequence[str]], Sequence[str]]:
        def row(answer: Method) -> list[str]:
            if not answer.ok:
                return [answer.method, f"failed: {answer.reason}", "", "", ""]
            estimates = [str(answer.K_per_s), str(answer.T_s), str(answer.delta_r_deg)]
            return [answer.method, *estimates, number(answer.heading_rmse_deg)]

        header = ["method", "K [1/s]", "T [s]", "δ_r [deg]", "rms ψ [deg]"]
        notes = []
        for record in self.records:
            if record.zigzag is not None:
                angles = ", ".join(number(angle, 0.1) for angle in record.zigzag.overshoots_deg)
                notes.append(
                    f"{Path(record.file).name}: overshoots {angles} deg, period {number(record.zigzag.period_s, 1.0)} s"
                )
        return (
            f"Fit of {_names(self.records)}, values and 95 % intervals",
            header,
            [row(answer) for answer in self.methods],
            notes,
        )

    def to_frame(self, kind: str = "pandas") -> Any:
        """One row a method, as a table of ``"pandas"`` or ``"polars"``."""

        def row(answer: Method) -> dict[str, Any]:
            cells: dict[str, Any] = {"method": answer.method, "ok": answer.ok, "reason": answer.reason}
            for name in ("K_per_s", "T_s", "delta_r_deg"):
                quantity = getattr(answer, name) or Quantity(None, None, None)
                low, high = quantity.ci95 or (None, None)
                cells.update({name: quantity.value, f"{name}_sd": quantity.sd})
                cells.update({f"{name}_low95": low, f"{name}_high95": high})
            return {**cells, "course_unstable": answer.course_unstable, "heading_rmse_deg": answer.heading_rmse_deg}

        return _table.frame_of([row(answer) for answer in self.methods], kind)

    def replay(self, method: str, record: int = 0) -> Optional[dict[str, Any]]:
        """The recorded rudder sent through the answer of a method: ``t_s``, ``heading_deg``, ``residual_deg``.

        The residual is measured less replayed heading. Validation records follow the fitted ones.
        ``None`` where the method has no answer.
        """
        curve = self._native.replay(record, self[method].method)
        return None if curve is None else dict(zip(("t_s", "heading_deg", "residual_deg"), curve))

    def plot(self, kind: str = "record", *, methods: Union[str, Iterable[str], None] = None, record: int = 0) -> Any:
        """A figure of Matplotlib.

        ``"record"``: rudder, measured and replayed heading and what is left between them, by output error unless
        ``methods`` names others. ``"estimates"``: K, T and δ_r of every method with their 95 % intervals.
        """
        if kind == "estimates":
            return _plot.estimates([answer for answer in self.methods if answer.ok])
        if kind != "record":
            raise KempfError(f'kind = {kind!r}: expected "record" or "estimates"')
        answered = [answer.method for answer in self.methods if answer.ok]
        named = strings(methods) or [name for name in ("output-error", *answered) if name in answered][:1]
        native = self._native.record(record)
        if native is None:
            raise KempfError(f"record = {record}: expected a number below that of all records, from 0")
        replays = {name: replay for name in named if (replay := self.replay(name, record)) is not None}
        return _plot.replays(Record._of(native), replays)


def _names(records: Sequence[RecordEntry]) -> str:
    first = Path(records[0].file).name
    return first if len(records) == 1 else f"{first} and {len(records) - 1} more"


def fit(
    records: Any,
    *,
    validate: Any = (),
    methods: Union[str, Iterable[str], None] = None,
    own: Optional[Mapping[str, Estimator]] = None,
    seed: Optional[int] = None,
    prior: Union[Model, Iterable[Model]] = (),
) -> FitResult:
    """Identifies K (1/s), T (s) and δ_r (deg) of T r' + r = K (δ + δ_r), as ``study fit`` does.

    :param records: one record or several of the same ship, which are identified together: of :func:`kempf.read`, of
        :func:`kempf.simulate`, tables with columns such as ``heading_deg``, or paths of files
    :param validate: records on which the answers are replayed; only their initial state is fitted
    :param methods: identifiers of the methods, or "all"; all but fourier-published and srivc where it is left out
    :param own: functions that take part as methods, by their labels: each is called with the records
        (:class:`kempf.Record`) and returns K (1/s), T (s), δ_r (deg) and, where it knows one, their covariance. One
        that raises has no answer, and its ``reason`` says why
    :param seed: seed of the methods that draw at random
    :param prior: what earlier trials of the same ship, her model or a sister left, results of this function or of
        :func:`kempf.trace` or paths of their files: where the fit of her hull begins. ``result.document["earlier_trials"]`` says
        whether the records contradict it

    Raises :class:`kempf.KempfError` where a record cannot be read, and where no method can identify the records; a
    method that fails alone says why in its ``reason``. Ctrl-C returns at once, and the computation it leaves behind
    ends by itself.

    >>> import kempf
    >>> trial = kempf.simulate(
    ...     '''
    ...     question = "What are K and T?"
    ...     seed = 1
    ...     ship.first-order = { K-per-s = 0.1, T-s = 16.3 }
    ...     manoeuvre.zig-zag = { rudder-deg = 10.0, heading-deg = 10.0 }
    ...     steering-gear.rate-deg-s = 2.5
    ...     recording = { sampling-s = 1.0, duration-s = 200.0 }
    ...     sensor.heading-noise-deg = 0.1
    ...     identifier = [{ method.output-error = {} }]
    ...     '''
    ... )
    >>> print(kempf.fit(trial, methods="output-error")["output-error"].K_per_s)
    0.10010 [0.09991, 0.10028]
    """
    native = _kempf.fit(
        natives(records), natives(validate), strings(methods), natives_of(own), whole("seed", seed), models(prior)
    )
    warn(native.warnings)
    return _result(native)


def _result(native: _kempf.Fit) -> FitResult:
    document = json.loads(native.text)
    return FitResult(
        methods=tuple(Method._of(entry) for entry in document["methods"]),
        records=tuple(RecordEntry._of(entry) for entry in document["trials"]),
        warnings=tuple(sentence(warning) for warning in document.get("warnings", ())),
        _text=native.text,
        _native=native,
    )
