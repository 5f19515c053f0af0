"""Friction of one contact: the branch law of the spring and its parameters along the rotor."""

import math


def sign(value):
    return int(value > 0) - int(value < 0)


class Friction:
    """Parameters of one contact as working-precision numbers."""

    names = ("k1", "k2", "beta", "alpha", "lambda", "n", "breakaway", "coulomb_ratio", "stribeck_velocity")

    def __init__(self, number, along_rotor, angle):
        values = {name: along_rotor[name] for name in self.names}
        for profile in along_rotor.get("profiled", []):
            values[profile["parameter"]] = profile_value(profile, angle)
        for name in self.names:
            setattr(self, "lam" if name == "lambda" else name, number.real(values[name]))
        if along_rotor.get("model") == "spring":
            self.alpha = number.real(0)

    def branch(self, number, u):
        """f(u) = k1·u + (k2/β)(1 − exp(−βu)), N m."""
        return self.k1 * u + self.k2 / self.beta * (1 - number.exp(-self.beta * u))

    def branch_slope(self, number, u):
        return self.k1 + self.k2 * number.exp(-self.beta * u)

    def inverse_branch(self, number, torque):
        """u ≥ 0 with f(u) = torque ≥ 0, by Newton from the soft end, where f is concave and the iteration monotone."""
        u = torque * 0
        for _ in range(200):
            step = (torque - self.branch(number, u)) / self.branch_slope(number, u)
            u = u + step
            if abs(step) <= abs(u) * number.tolerance / 10**3:
                break
        return u


def profile_value(profile, angle):
    angle = float(angle)
    field = sum(c * math.cos(m * angle) + s * math.sin(m * angle)
                for m, (c, s) in enumerate(zip(profile["cosine"], profile["sine"])))
    value = profile["location"] + profile["scale"] * field
    return math.exp(value) if profile["marginal"] == "lognormal" else value
