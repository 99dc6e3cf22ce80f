"""The equation T r' + r = K (delta + delta_r) among the terms 1, r and delta, by PySINDy.

r' = c_1 + c_r r + c_d delta gives T = -1 / c_r, K = -c_d / c_r, delta_r = c_1 / c_d.

What was chosen:
- The terms are those of a polynomial of degree one; nothing is to be left out, so that the threshold and the ridge of
  STLSQ, which would shrink the coefficients, are nought.
- Smoothed finite differences, the smoother a Savitzky-Golay filter of degree one. The rudder goes through the same
  filter, for the equation then holds between what is smoothed; it is as long as half the time between two reversals of
  the rudder. Its ends, where it has to make up rows, are set to NaN, and the library drops them: kept, they move the
  bias of the rudder by 0.1 degrees.
- Where the yaw rate is missing, it is the change of the heading from row to row, and the rudder its mean over the same
  step.
- The smoother needs even steps: missing rows and uneven steps are bridged by straight lines, long gaps are refused.
It gives no standard deviations.
"""
import numpy as np
import pysindy
from scipy.signal import savgol_filter

from records import answer_all, even_steps


def rows_of_smoother(t, delta):
    """How many rows half the time between two reversals of the rudder is, an odd number."""
    side = np.sign(delta[np.abs(delta) > np.abs(delta).max() / 2])
    return max(len(t) // (2 * (np.count_nonzero(np.diff(side)) + 1)) | 1, 3)


def estimate(record):
    t, psi, delta, r = even_steps(record)
    filter_of_rate = {"window_length": rows_of_smoother(t, delta), "polyorder": 1, "mode": "constant", "cval": np.nan}
    if r is None:
        r, delta, t = np.diff(psi) / np.diff(t), (delta[1:] + delta[:-1]) / 2, (t[1:] + t[:-1]) / 2
    model = pysindy.SINDy(
        feature_library=pysindy.PolynomialLibrary(degree=1),
        optimizer=pysindy.STLSQ(threshold=0.0, alpha=0.0),
        differentiation_method=pysindy.SmoothedFiniteDifference(smoother_kws=filter_of_rate),
    )
    u = savgol_filter(delta, filter_of_rate["window_length"], 1)[:, None]  # its ends are dropped with those of r
    model.fit(r[:, None], t=t, u=u, feature_names=["r", "delta"])
    c_1, c_r, c_d = model.coefficients()[0]
    if c_r == 0 or c_d == 0:
        raise ValueError("the record does not determine K and T")
    return {"K_per_s": -c_d / c_r, "T_s": -1 / c_r, "delta_r_rad": c_1 / c_d}


if __name__ == "__main__":
    answer_all("PySINDy", estimate)
