"""What the estimators beside this file share: a record on even steps, and the loop that answers line by line."""
import json
import sys

import numpy as np


def even_steps(record):
    """Time, heading, rudder and yaw rate (or None) on even steps of the median length."""
    t = np.array(record["t_s"], dtype=float)
    keys = ["heading_rad", "rudder_rad"]
    if record.get("yaw_rate_rad_s") and any(rate is not None for rate in record["yaw_rate_rad_s"]):
        keys.append("yaw_rate_rad_s")
    signals = [np.array(record[key], dtype=float) for key in keys]  # null becomes NaN
    there = [np.isfinite(signal) & np.isfinite(t) for signal in signals]
    if min(len(t), *(rows.sum() for rows in there)) < 20:
        raise ValueError("fewer than twenty rows")
    if np.ptp(signals[1][there[1]]) < 1e-4:
        raise ValueError("the rudder does not move")
    step = np.median(np.diff(t))
    if not step > 0 or max(np.diff(t[rows]).max() for rows in there) > 5.5 * step:
        raise ValueError("a gap of more than five steps")
    start, end = max(t[rows][0] for rows in there), min(t[rows][-1] for rows in there)
    grid = start + step * np.arange(int((end - start) / step + 1e-6) + 1)
    even = [np.interp(grid, t[rows], signal[rows]) for rows, signal in zip(there, signals)]
    return grid, even[0], even[1], even[2] if len(even) > 2 else None


def answer_all(estimate):
    """One answer a line for every trial on standard input, by `estimate(record)`; an exception is a failed trial."""
    for line in sys.stdin:
        record = json.loads(line)
        try:
            answer = json.dumps({"trial": record["trial"], **estimate(record)}, allow_nan=False)
        except Exception as error:
            answer = json.dumps({"trial": record["trial"], "failed": str(error)})
        print(answer, flush=True)
