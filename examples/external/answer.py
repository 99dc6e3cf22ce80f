"""The answers of all estimators beside this file in one table: python3 answer.py TRIALS > TRIALS/answers.csv"""
import importlib
import os
import sys
from concurrent.futures import ProcessPoolExecutor

# One process a core; a library that starts threads of its own would only wait for itself.
for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[threads] = "1"

from records import line, names, write

METHODS = {
    "SysIdentPy, ARX": "sysidentpy_arx",
    "PySINDy": "pysindy_nomoto",
    "EKF and OLS, after VMM": "vmm_ols_ekf",
    "least_squares.py": "least_squares",
}


def answer(method, folder, name):
    return line(method, folder, name, importlib.import_module(METHODS[method]).estimate)


if __name__ == "__main__":
    folder = sys.argv[1]
    work = [(method, folder, name) for method in METHODS for name in names(folder)]
    with ProcessPoolExecutor() as pool:
        write(pool.map(answer, *zip(*work), chunksize=8))
