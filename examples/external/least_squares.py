"""Least squares of T r' + r = K (delta + delta_r) integrated twice, which leaves no derivative:
psi = -1/T int(psi) + K/T iint(delta) + K delta_r/T t^2/2 + c1 t + c0. White noise n of the heading leaves n + int(n)/T:
a second fit makes it white again with the T of the first, so that its standard deviations hold."""
import numpy as np

from records import answer_all


def integral(t, y):
    return np.pad(np.cumsum(np.diff(t) * (y[..., 1:] + y[..., :-1]) / 2, axis=-1), [(0, 0)] * (y.ndim - 1) + [(1, 0)])


def estimate(record):
    rows = np.array([record[key] for key in ("t_s", "heading_rad", "rudder_rad")])
    t, psi, delta = rows[:, np.isfinite(rows).all(axis=0)]
    if len(t) < 10 or np.ptp(delta) < 1e-4:
        raise ValueError("too few rows, or the rudder does not move")
    y = np.vstack([integral(t, psi), integral(t, integral(t, delta)), t**2 / 2, t, np.ones_like(t), psi])
    a = np.linalg.lstsq(y[:5].T, y[5], rcond=None)[0][0]  # -1/T
    y += a * np.exp(a * t) * integral(t, np.exp(-a * t) * y)
    (a, b, c, *_), squares, rank, _ = np.linalg.lstsq(y[:5].T, y[5], rcond=None)
    if rank < 5:
        raise ValueError("the record does not determine K and T")
    slope = np.array([[b / a**2, -1 / a, 0], [1 / a**2, 0, 0], [0, -c / b**2, 1 / b]])  # of K, T and delta_r
    covariance = slope @ np.linalg.inv(y[:5] @ y[:5].T)[:3, :3] @ slope.T * squares / (len(t) - 5)
    sd = dict(zip(("K_per_s", "T_s", "delta_r_rad"), np.sqrt(np.diag(covariance))))
    return {"K_per_s": -b / a, "T_s": -1 / a, "delta_r_rad": c / b, "sd": sd}


if __name__ == "__main__":
    answer_all("least_squares.py", estimate)
