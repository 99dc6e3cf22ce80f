"""Simulation: trials of a scenario, with their truth."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from typing import Any, Literal, Mapping, Optional, Union, overload

from . import _kempf, _table
from ._options import whole
from ._record import PathLike, Record

#: The path of a scenario, its TOML text, or the same as a dictionary.
Scenario = Union[PathLike, Mapping[str, Any]]


@dataclass(frozen=True)
class Indices:
    """K, T and δ_r of a first-order response."""

    K_per_s: float
    T_s: float
    delta_r_deg: float


@dataclass(frozen=True, repr=False, eq=False)
class Motion:
    """The motion without the errors of any instrument, as NumPy arrays."""

    t_s: Any
    heading_deg: Any
    yaw_rate_deg_s: Any
    rudder_deg: Any
    #: Speed, m/s; ``None`` if the equations of the ship have no speed.
    speed_m_s: Any

    def __repr__(self) -> str:
        return f"Motion of {len(self.t_s)} instants, {self.t_s[-1] - self.t_s[0]:g} s"


@dataclass(frozen=True, repr=False, eq=False)
class Truth:
    """Truth of a simulated trial."""

    #: First-order response nearest to the ship; for a first-order ship, its indices.
    nearest: Optional[Indices]
    #: First-order base of a ship with effects.
    own: Optional[Indices]
    #: Identifiers of the effects in this trial that a first-order ship lacks.
    effects: tuple[str, ...]
    #: Values drawn for this trial, by key and in the unit of the key.
    drawn: Mapping[str, float]
    #: Times of the rudder orders, s.
    executes_s: tuple[float, ...]
    #: True motion.
    motion: Motion
    _text: str = field(repr=False)

    @property
    def document(self) -> dict[str, Any]:
        """The whole truth, as in ``NAME.truth.json`` of the program."""
        document: dict[str, Any] = json.loads(self._text)
        return document

    def _lines(self) -> list[str]:
        both = (("nearest first-order response", self.nearest), ("the ship's own base", self.own))
        lines = [
            f"{name}: K = {indices.K_per_s:.6g} 1/s, T = {indices.T_s:.6g} s, δ_r = {indices.delta_r_deg:.4g} deg"
            for name, indices in both
            if indices is not None
        ]
        return [*lines, f"effects: {', '.join(self.effects) or 'none'}"]

    def __repr__(self) -> str:
        return _table.text("Truth", [], [], self._lines())

    @classmethod
    def _of(cls, text: str) -> Truth:
        import numpy as np

        document = json.loads(text)
        nearest, own = (entry and Indices(**entry) for entry in (document["nearest"], document["own"]))
        motion = {name: None if values is None else np.array(values) for name, values in document["motion"].items()}
        return cls(
            nearest=nearest,
            own=own,
            effects=tuple(document["missing"]),
            drawn=document["drawn"],
            executes_s=tuple(document["executes_s"]),
            motion=Motion(**motion),
            _text=text,
        )


@dataclass(frozen=True, repr=False, eq=False)
class Simulated:
    """A simulated trial: the record that instruments made of it, and the truth."""

    #: Record of the instruments, the input of the methods.
    record: Record
    #: Truth, which is no input of the methods.
    truth: Truth

    def __repr__(self) -> str:
        return f"{self.record!r}\n{self.truth!r}"

    def _repr_html_(self) -> str:
        return _table.page(self.record.name, [], [], self.truth._lines()) + self.record._repr_html_()


def scene(scenario: Scenario) -> dict[str, Optional[str]]:
    """A scenario for the compiled part."""
    if isinstance(scenario, Mapping):
        plain = json.dumps(scenario, default=lambda value: value.tolist() if hasattr(value, "tolist") else str(value))
        return {"path": "scenario.toml", "text": _kempf.toml_of(plain)}
    if isinstance(scenario, str) and "\n" in scenario:
        return {"path": "scenario.toml", "text": scenario}
    return {"path": os.fspath(scenario), "text": None}


@overload
def simulate(
    scenario: Scenario, *, cell: Optional[str] = None, replicate: Literal["all"], seed: Optional[int] = None
) -> list[Simulated]: ...


@overload
def simulate(
    scenario: Scenario, *, cell: Optional[str] = None, replicate: int = 0, seed: Optional[int] = None
) -> Any: ...


def simulate(
    scenario: Scenario,
    *,
    cell: Optional[str] = None,
    replicate: Union[int, Literal["all"]] = 0,
    seed: Optional[int] = None,
) -> Any:
    """Simulates trials of a scenario, as ``study simulate`` does: the record is the file that it writes, read again.

    :param scenario: the path of a scenario, its TOML text, or a dictionary of the same keys
    :param cell: labels of the one cell to simulate, joined by commas; every cell where it is left out
    :param replicate: number of the trial in its cell, from 0, or ``"all"``
    :param seed: seed in place of the scenario's

    Returns one :class:`Simulated` where there is one, otherwise a list of them in the order of cells and replicates;
    with ``"all"`` always a list. Raises :class:`kempf.KempfError` for a scenario that cannot be read and for a cell or
    trial that it does not have. What the reader had to decide is in ``record.warnings``.
    """
    number = None if replicate == "all" else whole("replicate", replicate)
    made = _kempf.simulate(scene(scenario), cell, number, whole("seed", seed))
    trials = [Simulated(Record._of(record), Truth._of(text)) for record, text in made]
    return trials if replicate == "all" or len(trials) != 1 else trials[0]
