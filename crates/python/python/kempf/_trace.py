"""Tracing: the effects that a first-order model lacks."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Iterable, Mapping, Optional, Sequence, Union

from . import _kempf, _plot, _table
from ._kempf import KempfError
from ._options import options, strings, warn
from ._quantity import Quantity, number
from ._record import Record, natives
from ._result import Model, Result, models

Ids = Union[str, Iterable[str]]


@dataclass(frozen=True)
class Parameter(Quantity):
    """A parameter of an effect."""

    unit: str

    @classmethod
    def of(cls, entry: Mapping[str, Any]) -> Parameter:
        plain = Quantity.of(entry)
        return cls(plain.value, plain.sd, plain.ci95, entry["unit"])

    def __str__(self) -> str:
        return f"{super().__str__()} {self.unit}"


@dataclass(frozen=True)
class Effect:
    """A named effect."""

    #: Identifier, such as ``"nonlinear_damping"``.
    id: str
    #: Most probable form of its term, such as ``"r|r|"``.
    form: str
    #: Equation of the response with the effect.
    equation: str
    #: Record in which the effect acts; ``None`` for all records.
    only: Optional[str]
    #: Parameters by their symbols, averaged over the structures.
    parameters: Mapping[str, Parameter]
    #: Effects that these records cannot distinguish from this effect; one of the group is present.
    aliases: tuple[str, ...]
    #: Identifier and form of every term that these records cannot distinguish from this effect.
    alias_forms: tuple[tuple[str, str], ...]
    #: Probability that the effect, or another of its group, is present.
    probability: float
    #: −2 log of the evidence ratio with and without the effect; negative if the effect improves the model.
    delta_bic: float
    #: p value (χ²) of the coefficients in a fit with all other candidates.
    p_value: float
    #: Probability of the effect, by the factor that multiplies the prior odds of all effects.
    probability_by_prior_odds: Mapping[float, float]
    #: Evidence in one sentence.
    evidence: str


@dataclass(frozen=True)
class Candidate:
    """A candidate effect."""

    id: str
    #: ``"added"``, ``"alias"``, ``"rejected"`` or ``"not_observable"``.
    outcome: str
    probability: float
    delta_bic: Optional[float]
    p_value: Optional[float]


@dataclass(frozen=True)
class Structure:
    """A structure: effects that are present together."""

    #: Identifier and form of every effect.
    effects: tuple[tuple[str, str], ...]
    #: Probability of the structure.
    weight: float


@dataclass(frozen=True)
class Horizon:
    """Root mean square heading errors of replays that begin anew, deg."""

    #: Time from one restart of the replay to the next, s.
    horizon_s: float
    before_deg: float
    after_deg: float


@dataclass(frozen=True)
class Errors:
    """Heading errors of a record before and after, deg; only the initial state is fitted to a held-out one."""

    file: str
    #: ``True`` for a validation record.
    held_out: bool
    #: Root mean square heading error of the whole replay with the base, deg.
    before_deg: float
    #: Root mean square heading error of the whole replay with the average of the structures, deg.
    after_deg: float
    #: Errors by the time between restarts of the replay, up to the whole record; empty for a fitted record.
    horizons: tuple[Horizon, ...]


@dataclass(frozen=True, repr=False, eq=False)
class TraceResult(Result):
    """Effects that a first-order model lacks in these records, and the errors before and after."""

    _model = "trace.json"

    #: Result in one sentence.
    headline: str
    #: ``"clean"``, ``"disturbed"``, ``"traced"``, ``"located"`` or ``"unexplained"``.
    verdict: str
    #: K averaged over the structures, 1/s.
    K_per_s: Quantity
    #: T averaged over the structures, s.
    T_s: Quantity
    #: Rudder bias averaged over the structures, deg.
    delta_r_deg: Quantity
    #: Named effects, the most probable first.
    effects: tuple[Effect, ...]
    #: All candidate effects.
    candidates: tuple[Candidate, ...]
    #: Structures, the most probable first.
    structures: tuple[Structure, ...]
    #: Errors of every record, the fitted records first.
    errors: tuple[Errors, ...]
    #: Most informative next manoeuvre.
    next_trial: Optional[str]
    #: Warnings.
    warnings: tuple[str, ...]
    _text: str = field(repr=False)
    _native: _kempf.Trace = field(repr=False)

    def _table(self) -> tuple[str, Sequence[str], Sequence[Sequence[str]], Sequence[str]]:
        named = ", ".join(f"{term.id} ({term.form}), probability {term.probability:.3f}" for term in self.effects)
        title = f"Trace: {self.verdict}" + (f", {named}" if named else "")
        rows = [
            [
                Path(one.file).name,
                "held out" if one.held_out else "fitted",
                number(one.before_deg),
                number(one.after_deg),
            ]
            for one in self.errors
        ]
        notes = [f"{one.id}: {symbol} = {value}" for one in self.effects for symbol, value in one.parameters.items()]
        notes.insert(0, self.headline)
        notes.append(f"K = {self.K_per_s} 1/s, T = {self.T_s} s, δ_r = {self.delta_r_deg} deg")
        notes.extend(f"{one.id} cannot be distinguished from {', '.join(one.aliases)}" for one in self.effects if one.aliases)
        if self.next_trial:
            notes.append(f"next trial: {self.next_trial}")
        return title, ["record", "use", "rms ψ before [deg]", "after [deg]"], rows, notes

    def to_frame(self, kind: str = "pandas") -> Any:
        """The candidate effects, one row each, as a table of ``"pandas"`` or ``"polars"``."""
        return _table.frame_of([vars(one) for one in self.candidates], kind)

    def replay(self, record: int = 0) -> dict[str, dict[str, Any]]:
        """The recorded rudder sent through the model ``"before"`` and ``"after"``.

        Each has ``t_s``, ``heading_deg`` and ``residual_deg``, measured less replayed heading. Validation
        records follow the fitted ones.
        """
        curves = self._native.replays(record)
        if curves is None:
            raise KempfError(f"record = {record}: expected a number below {len(self.errors)}, from 0")
        names = ("t_s", "heading_deg", "residual_deg")
        return {name: dict(zip(names, curve)) for name, curve in zip(("before", "after"), curves)}

    def plot(self, *, record: int = 0) -> Any:
        """Rudder, measured heading, its replays before and after, and what is left, as a figure of Matplotlib."""
        replays = self.replay(record)
        native = self._native.record(record)
        assert native is not None, "a record that was replayed is there"
        return _plot.replays(Record._of(native), replays)


def trace(
    records: Any,
    *,
    validate: Any = (),
    with_: Ids = (),
    only: Ids = (),
    without_effect: Ids = (),
    without: Ids = (),
    effects: Mapping[str, str] = {},
    rule: str = "posterior",
    prior: Union[Model, Iterable[Model]] = (),
) -> TraceResult:
    """Closes the loop on records, as ``study trace`` does: fits a first-order ship, weighs the structures of
    effects that it may lack, names those that are probable, and says what they are worth.

    :param records: one record or several of the same ship, as in :func:`kempf.fit`
    :param validate: records that only judge the result
    :param with_: effects that are in the model whatever the evidence says, by their ids in ``study list effects``
    :param only: exactly these effects and no search
    :param without_effect: effects that are no candidates
    :param without: columns to leave aside: ``"wind"``, ``"speed"``, ``"propeller"``, ``"sway"``
    :param effects: effects of one's own by their names, each a moment as an angle of the rudder:
        ``{"bank": "c * tanh(k * psi)"}``
    :param rule: how structures are weighed: ``"posterior"``, by their likelihood under the priors of the coefficients,
        or ``"bic"``
    :param prior: what earlier trials of the same ship, her model or a sister left, as in :func:`kempf.fit`

    Raises :class:`kempf.KempfError` where a record cannot be read, where no first-order ship fits it, and for an effect
    that there is not. Ctrl-C returns at once, and the computation it leaves behind ends by itself.
    """
    arguments = options(
        with_=strings(with_),
        only=strings(only),
        without_effect=strings(without_effect),
        without=strings(without),
        effect=[f"{name} = {formula}" for name, formula in effects.items()],
        rule=rule,
    )
    native = _kempf.trace(natives(records), natives(validate), arguments, models(prior))
    warn(native.warnings)
    return _result(native)


def _result(native: _kempf.Trace) -> TraceResult:
    document = json.loads(native.text)
    model = document["model"]

    def terms(entries: Iterable[Mapping[str, Any]]) -> tuple[tuple[str, str], ...]:
        return tuple((one["id"], one["form"]) for one in entries)

    factors = document["prior"]["odds_factors"]

    def effect(entry: Mapping[str, Any]) -> Effect:
        names = ("id", "form", "equation", "only", "probability", "delta_bic", "p_value", "evidence")
        return Effect(
            parameters={symbol: Parameter.of(value) for symbol, value in entry["parameters"].items()},
            aliases=tuple(entry["aliases"]),
            alias_forms=terms(entry["alias_forms"]),
            probability_by_prior_odds=dict(zip(factors, entry.get("probability_by_prior_odds", ()))),
            **{name: entry[name] for name in names},
        )

    def structure(entry: Mapping[str, Any]) -> Structure:
        return Structure(terms(entry["effects"]), entry["weight"])

    def errors(use: str) -> list[Errors]:
        rmse = "heading_rmse_deg"
        return [
            Errors(
                one["file"],
                use == "validation",
                one["before"][rmse],
                one["after"][rmse],
                tuple(Horizon(**entry) for entry in one.get("horizons", ())),
            )
            for one in document["error"][use]
        ]

    names = ("id", "outcome", "probability", "delta_bic", "p_value")
    return TraceResult(
        headline=document["headline"],
        verdict=document["verdict"],
        K_per_s=Quantity.of(model["K_per_s"]),
        T_s=Quantity.of(model["T_s"]),
        delta_r_deg=Quantity.of(model["delta_r_deg"]),
        effects=tuple(effect(entry) for entry in document["effects"]),
        candidates=tuple(Candidate(**{name: entry[name] for name in names}) for entry in document["candidates"]),
        structures=tuple(structure(entry) for entry in document["structures"]),
        errors=(*errors("identification"), *errors("validation")),
        next_trial=document["next_trial"],
        warnings=tuple(native.warnings),
        _text=native.text,
        _native=native,
    )
