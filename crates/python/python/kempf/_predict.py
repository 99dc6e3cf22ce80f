"""Prediction: manoeuvres of an identified ship, with intervals."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Iterable, Mapping, Optional, Sequence, Union

from . import _kempf, _plot, _table
from ._options import options, strings, warn
from ._quantity import number
from ._record import natives
from ._result import Model, Result, models

#: Endings of the names of figures, with their units.
UNITS = {"_deg_s": "deg/s", "_deg": "deg", "_m_s": "m/s", "_lengths": "L", "_s": "s", "_m": "m", "_kn": "kn"}


def spoken(name: str) -> tuple[str, str]:
    """Label and unit of a figure."""
    for ending, unit in UNITS.items():
        if name.endswith(ending):
            return name[: -len(ending)].replace("_", " "), unit
    return name.replace("_", " "), ""


#: Ordinals in the names of figures.
ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth")


def _place(name: str) -> tuple[str, int]:
    """Sort key of a figure: overshoots together, in order."""
    first, _, figure = name.partition("_")
    return (figure, ORDINALS.index(first)) if first in ORDINALS else (name, 0)


@dataclass(frozen=True)
class Figure:
    """A figure of merit of a manoeuvre, such as ``first_overshoot_deg``, in the unit of its name."""

    median: float
    #: 50 % interval, which contains half of the drawn ships.
    ci50: tuple[float, float]
    #: 90 % interval, which contains nine in ten of the drawn ships.
    ci90: tuple[float, float]
    #: ``True`` if the manoeuvre leaves the range of the fitted records.
    extrapolated: Optional[bool] = None
    #: Measured value of a replayed record; ``None`` for a manoeuvre that was not made.
    measured: Optional[float] = None
    #: Share of each source of uncertainty in the spread.
    shares: Mapping[str, float] = field(default_factory=dict)

    @classmethod
    def _of(cls, entry: Mapping[str, Any]) -> Figure:
        return cls(
            median=entry["median"],
            ci50=tuple(entry["ci50"]),
            ci90=tuple(entry["ci90"]),
            extrapolated=entry.get("extrapolated"),
            measured=entry.get("measured"),
            shares=entry.get("shares", {}),
        )


@dataclass(frozen=True)
class Manoeuvre:
    """A manoeuvre that was predicted."""

    kind: str
    figures: Mapping[str, Figure]
    #: Number of drawn ships that did not complete the manoeuvre.
    lost: int


@dataclass(frozen=True)
class Replay:
    """A record compared with its prediction; only the initial state is fitted to it."""

    file: str
    #: Share of the measured headings inside the 90 % band.
    band_coverage_90: float
    heading_rmse_deg: float
    #: ``True`` if rudder or yaw rate of the record leaves the range of the fitted records.
    extrapolated: bool
    figures: Mapping[str, Figure]


@dataclass(frozen=True)
class Criterion:
    """A criterion of IMO MSC.137(76)."""

    criterion: str
    manoeuvre: str
    limit: float
    unit: str
    median: float
    probability_of_passing: float
    #: ``True`` if the manoeuvre leaves the range of the fitted records.
    extrapolated: bool


@dataclass(frozen=True, repr=False, eq=False)
class PredictResult(Result):
    """Predicted manoeuvres with intervals."""

    manoeuvres: tuple[Manoeuvre, ...]
    replays: tuple[Replay, ...]
    #: IMO criteria; empty if length or speed of the ship is unknown.
    imo: tuple[Criterion, ...]
    #: Warnings.
    warnings: tuple[str, ...]
    _text: str = field(repr=False)

    def __getitem__(self, kind: str) -> Manoeuvre:
        for manoeuvre in self.manoeuvres:
            if manoeuvre.kind == kind:
                return manoeuvre
        raise KeyError(f"{kind}: there are {', '.join(manoeuvre.kind for manoeuvre in self.manoeuvres) or 'none'}")

    def _rows(self) -> list[tuple[str, str, Figure]]:
        parts: list[tuple[str, Mapping[str, Figure]]] = [(made.kind, made.figures) for made in self.manoeuvres]
        parts.extend((Path(replay.file).name, replay.figures) for replay in self.replays)
        return [(what, name, figures[name]) for what, figures in parts for name in sorted(figures, key=_place)]

    def _table(self) -> tuple[str, Sequence[str], Sequence[Sequence[str]], Sequence[str]]:
        def row(what: str, name: str, figure: Figure) -> list[str]:
            label, unit = spoken(name)
            spread = (figure.ci90[1] - figure.ci90[0]) / 3.3
            ends = [f"[{number(low, spread)}, {number(high, spread)}]" for low, high in (figure.ci50, figure.ci90)]
            remarks = [] if figure.measured is None else [f"measured {number(figure.measured, spread)}"]
            remarks += ["extrapolated"] if figure.extrapolated else []
            return [what, label, unit, number(figure.median, spread), *ends, ", ".join(remarks)]

        header = ["manoeuvre", "figure", "unit", "median", "50 %", "90 %", "remark"]
        notes = [
            f"IMO {one.criterion}: {number(one.median)} {one.unit}, limit {number(one.limit)}, "
            f"passes with {100 * one.probability_of_passing:.1f} %"
            for one in self.imo
        ]
        return f"Prediction, {self.document['draws']} ships drawn", header, [row(*one) for one in self._rows()], notes

    def to_frame(self, kind: str = "pandas") -> Any:
        """One row a figure, as a table of ``"pandas"`` or ``"polars"``."""

        def row(what: str, name: str, figure: Figure) -> dict[str, Any]:
            ends = dict(zip(("low50", "high50", "low90", "high90"), (*figure.ci50, *figure.ci90)))
            notes = {"measured": figure.measured, "extrapolated": figure.extrapolated}
            return {"manoeuvre": what, "figure": name, "median": figure.median, **ends, **notes}

        return _table.frame_of([row(*one) for one in self._rows()], kind)

    def plot(self) -> Any:
        """Medians with their 50 and 90 % intervals, and measured values, as a Matplotlib figure."""
        return _plot.intervals([(what, *spoken(name), figure) for what, name, figure in self._rows()])


def predict(
    model: Union[Model, Iterable[Model]],
    manoeuvres: Union[str, Iterable[str], None] = None,
    *,
    replay: Any = (),
    prior: Union[Model, Iterable[Model]] = (),
    method: Optional[str] = None,
    calm: bool = False,
    load: Union[str, Path, None] = None,
    draws: int = 1000,
    length_m: Optional[float] = None,
    speed_m_s: Optional[float] = None,
    speed_kn: Optional[float] = None,
) -> PredictResult:
    """Predicts manoeuvres of an identified ship, with intervals, as ``study predict`` does.

    :param model: a result of :func:`kempf.fit` or :func:`kempf.trace`, the path of a ``fit.json`` or ``trace.json``, or
        several of them, which are a mixture
    :param manoeuvres: such as ``"zig-zag:10/10"``, ``"turning-circle:35"``, ``"initial-turning:10"``,
        ``"pull-out:20"``, ``"spiral:15"``, ``"williamson"``; a negative rudder begins to port. Those of the IMO
        criteria where it is left out, unless a record is replayed
    :param replay: records that are held against their prediction
    :param prior: what earlier trials left that are not in ``model``, as in :func:`kempf.fit`: its hulls are weighed
        together with them, widened
    :param method: the method whose answer is used; that of the verdict of the fit where it is left out
    :param calm: whether the weather of the records is left out
    :param load: path of a file that describes another loading, as a sidecar does: hulls are taken to it by the formulas of
        the particulars
    :param draws: ships that are drawn
    :param length_m: length that is predicted for, m; the ship is scaled to it by Froude. That of the replayed records, or
        else of the model, where it is left out
    :param speed_m_s: its approach speed, m/s
    :param speed_kn: the same in knots

    Raises :class:`kempf.KempfError` for a model that cannot be read, and where hardly any drawn ship comes to the end
    of a manoeuvre. Ctrl-C returns at once, and the computation it leaves behind ends by itself.
    """
    arguments = options(
        manoeuvre=strings(manoeuvres),
        method=method,
        calm=calm,
        load=load,
        draws=draws,
        length_m=length_m,
        speed_m_s=speed_m_s,
        speed_kn=speed_kn,
    )
    text, warnings = _kempf.predict(models(model), natives(replay), arguments, models(prior))
    warn(warnings)
    document = json.loads(text)

    def figures(entry: Mapping[str, Any], **common: Any) -> dict[str, Figure]:
        return {name: Figure._of({**figure, **common}) for name, figure in entry["figures"].items()}

    def replayed(entry: Mapping[str, Any]) -> Replay:
        extrapolated = entry["extrapolated"]
        made = figures(entry, extrapolated=extrapolated)
        return Replay(entry["file"], entry["band_coverage_90"], entry["heading_rmse_deg"], extrapolated, made)

    criteria = ("criterion", "manoeuvre", "limit", "unit", "median", "probability_of_passing", "extrapolated")
    return PredictResult(
        manoeuvres=tuple(Manoeuvre(one["kind"], figures(one), one["lost"]) for one in document["manoeuvres"]),
        replays=tuple(map(replayed, document["replays"])),
        imo=tuple(Criterion(**{name: one[name] for name in criteria}) for one in document["imo"]),
        warnings=tuple(warnings),
        _text=text,
    )
