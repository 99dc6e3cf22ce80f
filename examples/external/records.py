"""What the estimators beside this file share: the records that `study simulate` writes, and the table of answers that
`study score` reads."""
import csv
import math
import os
import sys
import tomllib

import numpy as np

COLUMNS = "method,record,K_per_s,T_s,delta_r_deg,K_sd_per_s,T_sd_s,delta_r_sd_deg,failed".split(",")


def read(path):
    """A record in seconds and radians: time, heading, rudder, yaw rate (or None), and the declared noise of the heading
    (or None); NaN where a row lacks a reading."""
    with open(path, newline="") as file:
        head, *rows = csv.reader(file)
    columns = dict(zip(head, np.array([[float(cell or "nan") for cell in row] for row in rows]).T))
    sidecar = path.removesuffix(".csv") + ".trial.toml"
    noise = {}
    if os.path.exists(sidecar):
        with open(sidecar, "rb") as file:
            noise = tomllib.load(file).get("noise", {})
    rate = columns.get("yaw_rate_deg_s")
    return {
        "t_s": columns["t_s"],
        "heading_rad": np.radians(columns["heading_deg"]),
        "rudder_rad": np.radians(columns["rudder_deg"]),
        "yaw_rate_rad_s": None if rate is None else np.radians(rate),
        "heading_sd_rad": math.radians(noise["heading-deg"]) if "heading-deg" in noise else None,
    }


def even_steps(record):
    """Time, heading, rudder and yaw rate (or None) on even steps of the median length."""
    t = record["t_s"]
    keys = ["heading_rad", "rudder_rad"]
    if record["yaw_rate_rad_s"] is not None:
        keys.append("yaw_rate_rad_s")
    signals = [record[key] for key in keys]
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


def line(method, folder, name, estimate):
    """A line of the table of answers; an exception of `estimate(record)` is a failed trial."""
    answer = {"method": method, "record": name}
    try:
        found = estimate(read(os.path.join(folder, name)))
    except Exception as error:
        return answer | {"failed": str(error) or type(error).__name__}
    sd = found.get("sd", {})
    return answer | {
        "K_per_s": found["K_per_s"],
        "T_s": found["T_s"],
        "delta_r_deg": math.degrees(found["delta_r_rad"]),
        "K_sd_per_s": sd.get("K_per_s"),
        "T_sd_s": sd.get("T_s"),
        "delta_r_sd_deg": math.degrees(sd["delta_r_rad"]) if "delta_r_rad" in sd else None,
    }


def names(folder):
    """The records of a folder, as trials.csv lists them."""
    with open(os.path.join(folder, "trials.csv"), newline="") as file:
        return [trial["record"] for trial in csv.DictReader(file)]


def write(lines):
    """The table on standard output."""
    table = csv.DictWriter(sys.stdout, COLUMNS, lineterminator="\n")
    table.writeheader()
    table.writerows(lines)


def answer_all(method, estimate):
    """The table of answers of one method to the records of the folder that the command line names."""
    folder = sys.argv[1]
    write(line(method, folder, name, estimate) for name in names(folder))
