"""The uniform numbers of a study, for the first manifest of README.md in this folder. The rules: random-numbers.md."""

import hashlib, math, struct

def philox4x32_10(counter, key):
    c, k = counter, key
    for _ in range(10):
        p, q = 0xD2511F53 * c[0], 0xCD9E8D57 * c[2]
        c = [q >> 32 ^ c[1] ^ k[0], q % 2**32, p >> 32 ^ c[3] ^ k[1], p % 2**32]
        k = [(k[0] + 0x9E3779B9) % 2**32, (k[1] + 0xBB67AE85) % 2**32]
    return c

def bits(seed, name, index, purpose, stream=0):
    key = struct.unpack("<2I", hashlib.sha256(f"{seed}:{name}".encode()).digest()[:8])
    word = philox4x32_10([index % 2**32, index >> 32, purpose, stream], key)
    return word[0] + 2**32 * word[1]

def uniform_number(w):
    return ((w >> 12) + 0.5) * 2.0**-52

def monte_carlo(seed, name, trial, stream=0):
    return uniform_number(bits(seed, name, trial, 0, stream))

def latin_hypercube(seed, name, trial, trials, stream=0):
    a = math.ceil(math.sqrt(trials))     # a permutation of a × b ≥ trials numbers, repeated until inside
    b = -(-trials // a)
    interval = trial
    while True:
        left, right = interval % a, interval // a
        for r in range(0, 8, 2):
            left = (left + bits(seed, name, right, 16 + r, stream)) % a
            right = (right + bits(seed, name, left, 17 + r, stream)) % b
        interval = left + a * right
        if interval < trials:
            break
    return min((interval + monte_carlo(seed, name, trial, stream)) / trials, 1 - 2**-53)

def saltelli(seed, name, trial, factor, factors, stream=0):
    row, place = divmod(trial, factors + 2)
    return monte_carlo(seed, name, row + 2**55 if place in (1, factor + 2) else row, stream)

def number_in_trial(seed, name, trial, k, stream=0):
    return uniform_number(bits(seed, name, trial + (k >> 32 << 56), k % 2**32, stream))

def history(seed, trial, reversals, torque, stream=0):
    u = [number_in_trial(seed, "initial.history/levels", trial, k, stream) for k in range(reversals + 1)]
    levels, end = [0.0], torque if u[0] >= 0.5 else -torque
    for k in range(1, reversals + 1):
        levels.append(levels[-1] + u[k] * (end - levels[-1]))
        end = -end
    return levels[1:]                    # N m

u = monte_carlo(20020721, "friction.k2", trial=17)
print(600 + u * (900 - 600))             # /trial/input/friction.k2 of trial 17, N m/rad
