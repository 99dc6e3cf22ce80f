"""Kempf: zig-zag trials of ships, simulated, identified, traced and predicted.

T r' + r = K (δ + δ_r): yaw rate r, rudder δ, rudder bias δ_r. The numbers are those of the program ``study``.

=====================  ==============================================================================
``kempf.read``         a record from a file; ``kempf.Record``: from arrays or a table
``kempf.find``         the manoeuvres inside a long log
``kempf.simulate``     trials of a scenario, with their truth
``kempf.fit``          K, T and δ_r by every method, with intervals
``kempf.trace``        the effects that a first-order model lacks, and the errors before and after
``kempf.predict``      manoeuvres of an identified ship, with intervals
``kempf.bench``        every method, and your own, on the records of the benchmark
``kempf.run``          a whole study: many trials, every method, tables and figures in a folder
=====================  ==============================================================================

Angles are in degrees and lengths in metres; every name ends in its unit.
"""

from ._bench import BenchResult, Standing, bench
from ._find import FindResult, Found, find
from ._fit import FitResult, Method, RecordEntry, ZigZag, fit
from ._kempf import KempfError, KempfWarning, WorkError, __version__
from ._predict import Criterion, Figure, Manoeuvre, PredictResult, Replay, predict
from ._quantity import Quantity
from ._record import Record, read
from ._simulate import Indices, Motion, Simulated, Truth, simulate
from ._study import StudyResult, run
from ._trace import Candidate, Effect, Errors, Horizon, Parameter, Structure, TraceResult, trace

__all__ = [
    "BenchResult",
    "Candidate",
    "Criterion",
    "Effect",
    "Errors",
    "Figure",
    "FindResult",
    "FitResult",
    "Found",
    "Horizon",
    "Indices",
    "KempfError",
    "KempfWarning",
    "Manoeuvre",
    "Method",
    "Motion",
    "Parameter",
    "PredictResult",
    "Quantity",
    "Record",
    "RecordEntry",
    "Replay",
    "Simulated",
    "Standing",
    "Structure",
    "StudyResult",
    "TraceResult",
    "Truth",
    "WorkError",
    "ZigZag",
    "__version__",
    "bench",
    "find",
    "fit",
    "predict",
    "read",
    "run",
    "simulate",
    "trace",
]
