"""Makes limit_cycles_more.csv: exact symmetric limit cycles by 40-digit arithmetic, independent of the core.

Needs mpmath (pip install mpmath). Half period h and state x0 at the rise solve
    (I + e^{Ah}) x0 = k [G(h-L) - e^{A(h-L)} G(L)],  C x0 = eps,  G(t) = int_0^t e^{As} ds B,   0 <= L < h,
from the first change of sign about the describing function's frequency on. The crossing must be the first one: y stays beyond the
threshold on a grid of 400 points. The amplitude is the largest |y| of the half period, at a zero of its derivative or where
the input jumps. Run it in this folder: python limit_cycles.py > limit_cycles_more.csv
"""

import mpmath as mp

mp.mp.dps = 40

# Ratio of the half periods between which a change of sign is looked for.
STEP = mp.mpf("1.03")


def companion(num, den):
    lead = mp.mpf(den[0])
    den = [mp.mpf(c) / lead for c in den]
    num = [mp.mpf(c) / lead for c in num]
    n = len(den) - 1
    num = [mp.mpf(0)] * (n - len(num)) + num
    a = mp.zeros(n)
    for i in range(n - 1):
        a[i, i + 1] = 1
    for j in range(n):
        a[n - 1, j] = -den[n - j]
    b = mp.zeros(n, 1)
    b[n - 1] = 1
    c = mp.matrix([[num[n - 1 - j] for j in range(n)]])
    return a, b, c


def flow(a, b, t):
    """e^{At} and G(t) from one exponential of the augmented matrix."""
    n = a.rows
    m = mp.zeros(n + 1)
    m[:n, :n] = a * t
    m[:n, n] = b * t
    e = mp.expm(m)
    return e[:n, :n], e[:n, n]


def start(a, b, k, lag, h):
    n = a.rows
    whole, _ = flow(a, b, h)
    late, g_late = flow(a, b, h - lag)
    _, g_lag = flow(a, b, lag)
    right = k * (g_late - late * g_lag)
    # From h = +1 on: u = +k until the lag is over, -k afterwards; the state at the end is minus that at the begin.
    return mp.lu_solve(mp.eye(n) + whole, right)


def balance(a, b, c, k, lag, eps, h):
    return (c * start(a, b, k, lag, h))[0] - eps


def output(a, b, c, k, lag, x0, t):
    if t <= lag:
        e, g = flow(a, b, t)
        x = e * x0 + k * g
        u = k
    else:
        e, g = flow(a, b, lag)
        x = e * x0 + k * g
        e, g = flow(a, b, t - lag)
        x = e * x - k * g
        u = -k
    return (c * x)[0], (c * (a * x + b * u))[0]


def solve(num, den, lag, k, eps, guess):
    a, b, c = companion(num, den)
    lag, k, eps = mp.mpf(lag), mp.mpf(k), mp.mpf(eps)
    at = lambda h: balance(a, b, c, k, lag, eps, h)
    low = max(guess / 3, lag * mp.mpf("1.01"))
    while (at(low) < 0) == (at(low * STEP) < 0):
        low *= STEP
        assert low < 30 * guess, "no root"
    h = mp.findroot(at, (low, low * STEP), solver="anderson")
    x0 = start(a, b, k, lag, h)
    grid = [h * i / 400 for i in range(401)]
    values = [output(a, b, c, k, lag, x0, t) for t in grid]
    assert values[0][1] > 0 and h > lag, "not a rise"
    assert all(y > -eps for y, _ in values[1:-1]), "an earlier crossing"
    best = output(a, b, c, k, lag, x0, lag)[0]
    for i in range(400):
        if values[i][1] > 0 >= values[i + 1][1] or (values[i][1] < 0 <= values[i + 1][1]):
            low, high = grid[i], grid[i + 1]
            if low < lag < high:
                low, high = (low, lag) if output(a, b, c, k, lag, x0, lag)[1] <= 0 else (lag + mp.mpf(10) ** -30, high)
            if output(a, b, c, k, lag, x0, low)[1] * output(a, b, c, k, lag, x0, high)[1] < 0:
                t = mp.findroot(lambda t: output(a, b, c, k, lag, x0, t)[1], (low, high), solver="anderson")
                best = max(best, abs(output(a, b, c, k, lag, x0, t)[0]))
    best = max(best, eps, max(abs(y) for y, _ in values))
    return 2 * h, best


def guess(num, den, lag, k, eps):
    """Half period where Im P(jw) = -pi eps/(4k) with Re P < 0, by a scan."""
    def p(w):
        s = mp.mpc(0, w)
        return mp.polyval([mp.mpf(x) for x in num], s) / mp.polyval([mp.mpf(x) for x in den], s) * mp.exp(-s * lag)
    level = -mp.pi * eps / (4 * k)
    last = None
    for i in range(2000):
        w = mp.mpf("0.01") * mp.mpf("1.006") ** i
        now = p(w)
        if last is not None and (last.imag < level) != (now.imag < level) and now.real < 0:
            return mp.pi / w
        last = now
    raise ValueError("none")


PLANTS = [
    ("lag_3", ["1"], ["1", "3", "3", "1"], "0"),
    ("lag_4", ["2"], ["1", "4", "6", "4", "1"], "0"),
    ("lags_apart", ["1"], ["0.02", "0.312", "1.302", "1"], "0"),
    ("lag_dead_time", ["1"], ["2", "1"], "0.5"),
    ("two_lags_dead_time", ["3"], ["2", "3", "1"], "0.3"),
    ("integrator_two_lags", ["1"], ["1", "2", "1", "0"], "0"),
]
RELAYS = [("1", "0"), ("1", "0.08"), ("2.5", "0.2")]

# A fifth lag, a zero on either side of the axis, and a resonance behind a dead time.
MORE_PLANTS = [
    ("lag_5", ["1"], ["1", "5", "10", "10", "5", "1"], "0"),
    ("lead", ["0.1", "1"], ["1", "3", "3", "1"], "0"),
    ("inverse_response", ["-0.4", "1"], ["1", "3", "3", "1"], "0"),
    ("resonance_dead_time", ["1"], ["1", "0.6", "1"], "0.4"),
]
MORE_RELAYS = [("1", "0"), ("0.8", "0.03"), ("3", "0.5")]

# Lags a thousand times apart, an integrator with a lag behind a dead time, and three lags with a slow zero.
LAST_PLANTS = [
    ("stiff", ["1"], ["0.001", "1.002", "2.001", "1"], "0"),
    ("integrator_lag_dead_time", ["0.5"], ["0.8", "1", "0"], "0.6"),
    ("slow_zero", ["2", "1"], ["0.5", "2", "2.5", "1"], "0.1"),
]

if __name__ == "__main__":
    print("name,numerator,denominator,dead_time_s,k,epsilon,period_s,amplitude,check")
    loops = [(p, r) for p in PLANTS for r in RELAYS] + [(p, r) for p in MORE_PLANTS for r in MORE_RELAYS]
    loops += [(p, r) for p in LAST_PLANTS for r in MORE_RELAYS]
    for (name, num, den, lag), (k, eps) in loops:
        at = guess(num, den, mp.mpf(lag), mp.mpf(k), mp.mpf(eps))
        period, amplitude = solve(num, den, lag, k, eps, at)
        row = [f"{name}_k{k}_eps{eps}", " ".join(num), " ".join(den), lag, k, eps]
        print(",".join(row + [mp.nstr(period, 15), mp.nstr(amplitude, 15), "valid"]), flush=True)
