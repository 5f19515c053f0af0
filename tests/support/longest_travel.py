#!/usr/bin/env python3
"""The longest travel from rest to rest in a given time under limits of velocity, acceleration and jerk.

    longest_travel.py FILE

Each line of FILE: duration velocity_limit acceleration_limit jerk_limit, where a jerk_limit of inf is none. One
line of output for each: the travel.

Nothing is assumed of the shape of the move: it is cut into steps of constant jerk (of constant acceleration without a
jerk limit), and a linear programme finds the steps that go farthest. That is short of the truth by up to a share of about
1/STEPS where the fastest move has segments shorter than a step, and by far less where it has none.
"""

import math
import sys

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import bmat, eye

STEPS = 240


def longest_travel(duration, velocity_limit, acceleration_limit, jerk_limit):
    # Velocity and acceleration are unknown at the inner ends of the steps, and 0 at the ends of the move; in units of
    # their limits.
    h = duration / STEPS
    inner = STEPS - 1
    start = eye(STEPS, inner, k=-1)  # of each step
    change = eye(STEPS, inner) - start
    to_velocity = h * acceleration_limit / velocity_limit
    if math.isinf(jerk_limit):
        equations = bmat([[change, -to_velocity * eye(STEPS)]])
    else:
        to_acceleration = h * jerk_limit / acceleration_limit
        equations = bmat([
            [change, -to_velocity * start, -0.5 * to_velocity * to_acceleration * eye(STEPS)],
            [None, change, -to_acceleration * eye(STEPS)],
        ])
    # The travel is the sum of the velocities times h: what acceleration and jerk add to it over each step, in
    # proportion to their sums, adds up to nothing between two rests.
    velocities = np.zeros(equations.shape[1])
    velocities[:inner] = 1.0
    result = linprog(-velocities, A_eq=equations.tocsr(), b_eq=np.zeros(equations.shape[0]), bounds=(-1.0, 1.0),
                     method="highs")
    if result.status != 0:
        raise SystemExit(f"no solution: {result.message}")
    return -result.fun * velocity_limit * h


def main():
    with open(sys.argv[1], encoding="ascii") as file:
        for line in file:
            print(repr(longest_travel(*map(float, line.split()))))


main()
