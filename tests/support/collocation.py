"""Gauss-Legendre collocation in more than double precision, with dense output and first crossings.

One step of length h from y0 replaces dy/dt by the polynomial through its values at N Gauss nodes, found by fixed-point
iteration; the solution inside the step is the integral of that polynomial. Order 2N at the end of the step.
See Hairer, Norsett & Wanner, "Solving Ordinary Differential Equations I", section II.7.
"""

import decimal

import numpy as np


class LongDouble:
    """The 64-bit mantissa of the x87: about 19 digits."""

    dtype = np.longdouble
    tolerance = np.longdouble("1e-19")
    still = np.longdouble("1e-19")
    exp = staticmethod(np.exp)

    @staticmethod
    def real(value):
        return np.longdouble(value)

    @staticmethod
    def power(base, exponent):
        return base ** exponent


class Digits:
    """Decimal arithmetic with a chosen number of digits, at least 30."""

    dtype = object

    def __init__(self, digits):
        decimal.getcontext().prec = digits
        decimal.getcontext().Emin = decimal.MIN_EMIN
        decimal.getcontext().Emax = decimal.MAX_EMAX
        self.tolerance = decimal.Decimal(10) ** -(digits - 8)
        self.still = decimal.Decimal(10) ** -(digits - 8)
        self.exp = np.frompyfunc(lambda x: x.exp() if x > -100000 else decimal.Decimal(0), 1, 1)
        self.power = np.frompyfunc(self._power, 2, 1)

    @staticmethod
    def real(value):
        return decimal.Decimal(value)

    @staticmethod
    def _power(base, exponent):
        return base ** (int(exponent) if exponent == int(exponent) else exponent)


def legendre(order, x):
    """P_0 ... P_order at x, by the three-term recurrence."""
    values = [x * 0 + 1, x]
    for m in range(1, order):
        values.append(((2 * m + 1) * x * values[m] - m * values[m - 1]) / (m + 1))
    return values[:order + 1]


class GaussRule:
    """The N-point Gauss-Legendre rule on [0, 1] in the given arithmetic."""

    def __init__(self, count, number):
        self.count = count
        guess, _ = np.polynomial.legendre.leggauss(count)
        x = np.array([number.real(float(g)) for g in guess], dtype=number.dtype)
        for _ in range(6):  # Newton, from 16 digits to more than are carried
            p = legendre(count, x)
            slope = count * (x * p[count] - p[count - 1]) / (x * x - 1)
            x = x - p[count] / slope
        p = legendre(count, x)
        slope = count * (x * p[count] - p[count - 1]) / (x * x - 1)
        weight = 2 / ((1 - x * x) * slope * slope)
        self.nodes = (x + 1) / 2
        # coefficient m of the interpolating Legendre series = sum over nodes of to_series[m, node]·value
        self.to_series = np.array([(2 * m + 1) * weight * p[m] / 2 for m in range(count)], dtype=number.dtype)
        self.integrate = (self.integrals(x) / 2).T.dot(self.to_series)

    def integrals(self, x):
        """[m, point]: the integral of P_m from −1 to x."""
        p = legendre(self.count, x)
        rows = [x + 1] + [(p[m + 1] - p[m - 1]) / (2 * m + 1) for m in range(1, self.count)]
        return np.array(rows, dtype=object if self.nodes.dtype == object else self.nodes.dtype)


class Step:
    """The solution over one accepted step."""

    def __init__(self, rule, start, length, series, node_states, end):
        self.rule, self.start, self.length, self.series = rule, start, length, series
        self.node_states, self.end = node_states, end

    def at(self, fraction):
        """[component, point] at the fractions of the step in the one-dimensional array."""
        return self.start[:, None] + self.series.dot(self.rule.integrals(2 * fraction - 1)) * (self.length / 2)


def collocate(rule, derivative, start, length, tolerance):
    """One step, or None where the iteration or the series has not converged to `tolerance` ([component], absolute)."""
    states = np.repeat(start[:, None], rule.count, axis=1)
    previous = None
    for _ in range(60):
        slopes = derivative(states)
        update = start[:, None] + length * slopes.dot(rule.integrate.T)
        change = (abs(update - states) / tolerance[:, None]).max()
        states = update
        if not change < 1e12 and previous is not None and not change < previous:
            return None
        previous = change
        if change < 0.03125 if rule.nodes.dtype != object else change * 32 < 1:
            break
    else:
        return None
    series = derivative(states).dot(rule.to_series.T)
    tail = abs(series[:, -2:]).max(axis=1) * length / (2 * rule.count)
    if (tail > tolerance).any():
        return None
    return Step(rule, start, length, series, states, start + length * series[:, 0])


def first_crossing(step, guard):
    """The first fraction of the step where guard (a function of states [component, point]) falls below zero, or None.

    The guard is taken to be fulfilled at the start: rounding there says nothing. A dip below zero between nodes is looked
    for wherever the node values have a pronounced minimum.
    """
    rule = step.rule
    one = rule.nodes[0] * 0 + 1
    fractions = np.concatenate([[one * 0], rule.nodes, [one]])
    states = np.concatenate([step.start[:, None], step.node_states, step.end[:, None]], axis=1)
    values = guard(states)
    for i in range(1, len(fractions)):
        if values[i] < 0:
            return refine(step, guard, fractions[i - 1], values[i - 1], fractions[i], values[i])
        if i + 1 < len(fractions) and values[i] < values[i - 1] and values[i] <= values[i + 1]:
            if 2 * values[i] < max(values[i - 1], values[i + 1]):
                fine = fractions[i - 1] + (fractions[i + 1] - fractions[i - 1]) * np.arange(1, 40) / (one * 40)
                between = guard(step.at(fine))
                below = [j for j in range(len(fine)) if between[j] < 0]
                if below:
                    j = below[0]
                    low, value = (fine[j - 1], between[j - 1]) if j else (fractions[i - 1], values[i - 1])
                    return refine(step, guard, low, value, fine[j], between[j])
    return None


def refine(step, guard, low, low_value, high, high_value):
    """The crossing in [low, high], to the last digit, by false position (Illinois) and bisection in turn."""
    if not low_value > 0:
        # Rounding at the start: move inwards until the guard is really fulfilled, or give the start.
        trial = high
        for _ in range(60):
            trial = low + (trial - low) / 2
            value = guard(step.at(np.array([trial])))[0]
            if value > 0:
                low, low_value = trial, value
                break
            high, high_value = trial, value
        else:
            return low
    for iteration in range(200):
        if iteration % 3 == 2:
            middle = (low + high) / 2
        else:
            middle = low + (high - low) * (low_value / (low_value - high_value))
        if not low < middle < high:
            return high
        value = guard(step.at(np.array([middle])))[0]
        if value < 0:
            high, high_value = middle, value
            low_value = low_value / 2
        else:
            low, low_value = middle, value
            high_value = high_value / 2
            if value == 0:
                return middle
        if (high - low) * 10**17 < high and low.__class__ is np.longdouble:
            return high
    return high
