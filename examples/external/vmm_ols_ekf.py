"""In the manner of Alexandersson, Mao and Ringsberg: a Kalman filter and smoother, then regression on inverse dynamics.

The filter and the smoother (Rauch, Tung, Striebel) are those of their package vessel-manoeuvring-models; the regression
is `OLS` of statsmodels, which they use too. Their models of three degrees of freedom need speeds and a position, which
a zig-zag record of heading and rudder does not have; the model here is T r' + r = K (delta + delta_r) instead, and the
choices below are not theirs but for the order of the steps.

What was chosen:
- States are the heading and the yaw rate. First the filter knows kinematics alone (the yaw rate stays but for noise);
  then, as in their method, twice more with the model the last regression gave.
- A step of their filter is Euler's; the functions handed to it here make it the exact one over a time step, with the
  mean of the rudder at its two ends.
- The yaw acceleration is the central difference of the smoothed yaw rate, as their package has it. It is regressed on
  yaw rate, rudder and 1, each as a mean over the two steps the difference spans.
- The yaw rate is measured along with the heading where there is one, otherwise it comes from the heading by the filter.
- Standard deviations are those of the regression. It takes its rows as independent, which smoothed ones are not.
- Their filter puts rows on even steps: missing rows and uneven steps are bridged by straight lines, long gaps are
  refused. It looks up every row in a table and takes about a third of a second for 270 rows.
"""
import numpy as np
import pandas as pd
import statsmodels.api as sm
from vessel_manoeuvring_models.extended_kalman_filter import extended_kalman_filter, rts_smoother, time_steps_to_df

from records import answer_all, even_steps

# What the yaw acceleration may do beside the model, rad/s2 over one second: of kinematics alone, and of the ship's.
KINEMATIC, SHIP = 1e-3, 1e-4
PASSES = 3


def smooth(data, model, noise):
    """Heading, yaw rate and yaw acceleration: filtered forwards, smoothed backwards. The last row stays out."""
    h = data.index[1] - data.index[0]
    if model is None:
        transition, gain, bias = np.array([[1, h], [0, 1]]), np.zeros(2), 0.0
    else:
        K, T, bias = model
        e = np.exp(-h / T)
        transition, gain = np.array([[1, T * (1 - e)], [0, e]]), K * np.array([h - T * (1 - e), 1 - e])
    rate = lambda x, input: (transition @ x + gain * (input["delta"] + bias) - x) / h
    jacobian = lambda x, input: transition
    process = np.array([[(KINEMATIC if model is None else SHIP) ** 2 / h]])
    enters = np.array([[0.0], [1.0]])
    measured = ["psi", "r"][: len(noise)]
    start = [data["psi"].iloc[0], np.polyfit(data.index[:10], data["psi"].iloc[:10], 1)[0]]
    steps = extended_kalman_filter(
        P_prd=np.diag([noise[0] ** 2, 0.01**2]), lambda_f=rate, lambda_jacobian=jacobian, data=data, Qd=process,
        Rd=np.diag(np.square(noise)), E=enters, Cd=np.eye(2)[: len(noise)], state_columns=["psi", "r"],
        measurement_columns=measured, input_columns=["delta"], x0=np.array(start), do_checks=False,
    )
    return time_steps_to_df(rts_smoother(steps, jacobian, process, rate, enters), ["psi", "r"])


def estimate(record):
    t, psi, delta, r = even_steps(record)
    noise = [record["heading_sd_rad"] or 1e-3] + ([] if r is None else [1e-3])
    held = np.append((delta[1:] + delta[:-1]) / 2, delta[-1])
    data = pd.DataFrame({"psi": psi, "r": 0.0 if r is None else r, "delta": held}, index=t)
    mean = lambda y: (y[:-2] + 2 * y[1:-1] + y[2:]) / 4

    model = None
    for _ in range(PASSES):
        states = smooth(data, model, noise)
        rates, n = states["r"].to_numpy(), len(states)
        terms = np.column_stack([mean(rates), mean(delta[:n]), np.ones(n - 2)])
        fit = sm.OLS(states["r1d"].to_numpy()[1:-1], terms).fit()
        a, b, c = fit.params
        model = -b / a, -1 / a, c / b
        if not np.isfinite(model).all() or not 0 < model[1] < 1e4:
            raise ValueError("the regression is not that of a ship of first order")
    slope = np.array([[b / a**2, -1 / a, 0], [1 / a**2, 0, 0], [0, -c / b**2, 1 / b]])
    sd = np.sqrt(np.diag(slope @ fit.cov_params() @ slope.T))
    names = ("K_per_s", "T_s", "delta_r_rad")
    return dict(zip(names, model), sd=dict(zip(names, sd)))


if __name__ == "__main__":
    answer_all("EKF and OLS, after VMM", estimate)
