"""A first-order ARX model of the yaw rate, by SysIdentPy.

r[k] = a r[k-1] + b0 delta[k] + b1 delta[k-1] + c is what T r' + r = K (delta + delta_r) comes to from one row to the
next where the rudder moves in straight lines. Then T = -dt / ln a, K = (b0 + b1) / (1 - a), delta_r = c / (b0 + b1).

What was chosen:
- Total least squares, for r[k-1] is as noisy as r[k]: plain least squares makes T too small. The extended least squares
  of the library (`unbiased=True`) came out less exact on simulated trials of one row a second, and its regressors of
  the residual bring a second column of ones, which halves the constant term.
- The library has no tap at u[k]; the rudder is given one row ahead, so that its taps 1 and 2 are delta[k], delta[k-1].
- Structure selection (FROLS) is left nothing to select: all four terms are kept.
- Where the yaw rate is missing, it is the change of the heading from row to row, and the rudder its mean over the same
  step. Both then go through the same moving average, as long as half the time between two reversals of the rudder:
  the equation holds for averages too, and they have much less noise.
- The library needs even steps: missing rows and uneven steps are bridged by straight lines, long gaps are refused.
It gives no standard deviations.
"""
import numpy as np
from sysidentpy.basis_function import Polynomial
from sysidentpy.model_structure_selection import FROLS
from sysidentpy.parameter_estimation import TotalLeastSquares

from records import answer_all, even_steps


def rows_of_average(t, delta):
    """How many rows half the time between two reversals of the rudder is."""
    side = np.sign(delta[np.abs(delta) > np.abs(delta).max() / 2])
    return max(1, len(t) // (2 * (np.count_nonzero(np.diff(side)) + 1)))


def estimate(record):
    t, psi, delta, r = even_steps(record)
    dt = t[1] - t[0]
    average = np.ones(rows_of_average(t, delta))
    average /= len(average)
    if r is None:
        r, delta = np.diff(psi) / dt, (delta[1:] + delta[:-1]) / 2
    r, delta = np.convolve(r, average, "valid"), np.convolve(delta, average, "valid")

    y, u = r[:-1, None], delta[1:, None]
    model = FROLS(
        order_selection=False, n_terms=4, ylag=1, xlag=2,
        basis_function=Polynomial(degree=1), estimator=TotalLeastSquares(),
    )
    model.fit(X=u, y=y)
    # The library's codes: 0 is the constant, 1001 is y[k-1], 2001 is u[k-1] and 2002 is u[k-2], with u one row ahead.
    theta = dict(zip(model.final_model.ravel().tolist(), model.theta.ravel().tolist()))
    c, a, b0, b1 = theta[0], theta[1001], theta[2001], theta[2002]
    if not 0 < a < 1:
        raise ValueError("the ARX model is not that of a ship of first order")
    return {"K_per_s": (b0 + b1) / (1 - a), "T_s": -dt / np.log(a), "delta_r_rad": c / (b0 + b1)}


if __name__ == "__main__":
    answer_all("SysIdentPy, ARX", estimate)
