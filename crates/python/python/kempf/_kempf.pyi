"""The compiled part of the package; users import `kempf`."""

from typing import Callable, Optional, Union, final

import numpy as np
import numpy.typing as npt

_Array = npt.NDArray[np.float64]
_Curve = tuple[_Array, _Array, _Array]
#: A label and a function of records: K (1/s), T (s), δ_r (rad) and their covariance, where there is one.
_Answer = tuple[float, float, float, Optional[list[list[float]]]]
_Functions = list[tuple[str, Callable[[list["Record"]], _Answer]]]
_Scene = dict[str, Optional[str]]

__all__ = [
    "__version__",
    "KempfError",
    "WorkError",
    "KempfWarning",
    "Record",
    "Fit",
    "Trace",
    "read",
    "record_of",
    "find",
    "fit",
    "bench",
    "trace",
    "predict",
    "toml_of",
    "simulate",
    "run",
]

__version__: str

class KempfError(ValueError): ...
class WorkError(RuntimeError): ...
class KempfWarning(UserWarning): ...

@final
class Record:
    @property
    def name(self) -> str: ...
    @property
    def file(self) -> str: ...
    @property
    def sha256(self) -> str: ...
    @property
    def length_m(self) -> Optional[float]: ...
    @property
    def speed_m_s(self) -> Optional[float]: ...
    @property
    def heading_from_yaw_rate(self) -> bool: ...
    @property
    def warnings(self) -> list[str]: ...
    def __len__(self) -> int: ...
    def columns(self) -> list[str]: ...
    def column(self, name: str) -> Optional[_Array]: ...
    def csv(self) -> str: ...

@final
class Fit:
    @property
    def text(self) -> str: ...
    @property
    def warnings(self) -> list[str]: ...
    def record(self, place: int) -> Optional[Record]: ...
    def replay(self, place: int, method: str) -> Optional[_Curve]: ...

@final
class Trace:
    @property
    def text(self) -> str: ...
    @property
    def warnings(self) -> list[str]: ...
    def record(self, place: int) -> Optional[Record]: ...
    def replays(self, place: int) -> Optional[list[_Curve]]: ...

def read(path: str, options: list[str]) -> list[Record]: ...
def record_of(name: str, columns: list[tuple[str, Union[_Array, list[str]]]], options: list[str]) -> Record: ...
def find(logs: list[str], options: list[str]) -> tuple[str, list[str]]: ...
def fit(
    records: list[Record],
    validate: list[Record],
    methods: list[str],
    functions: _Functions,
    seed: Optional[int],
    priors: list[tuple[str, Optional[str]]],
) -> Fit: ...
def bench(
    scenarios: list[str],
    options: list[str],
    functions: _Functions,
    seed: Optional[int],
    progress: Optional[Callable[[int, int], object]],
) -> tuple[str, list[str]]: ...
def trace(
    records: list[Record], validate: list[Record], options: list[str], priors: list[tuple[str, Optional[str]]]
) -> Trace: ...
def predict(
    models: list[tuple[str, Optional[str]]],
    replay: list[Record],
    options: list[str],
    priors: list[tuple[str, Optional[str]]],
) -> tuple[str, list[str]]: ...
def toml_of(json: str) -> str: ...
def simulate(
    scene: _Scene, cell: Optional[str], replicate: Optional[int], seed: Optional[int]
) -> list[tuple[Record, str]]: ...
def run(
    scene: _Scene,
    out: Optional[str],
    threads: Optional[int],
    seed: Optional[int],
    restart: bool,
    progress: Optional[Callable[[int, int], object]],
) -> tuple[str, list[str], list[str]]: ...
