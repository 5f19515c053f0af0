"""The random numbers of studies, computed anew from their documented definition with hashlib and integers alone."""

import hashlib
import json
import math
import statistics
import struct
import subprocess
import sys

MASK = 0xFFFFFFFF


def philox4x32_10(counter, key):
    c, k = list(counter), list(key)
    for _ in range(10):
        p0, p1 = 0xD2511F53 * c[0], 0xCD9E8D57 * c[2]
        c = [(p1 >> 32) ^ c[1] ^ k[0], p1 & MASK, (p0 >> 32) ^ c[3] ^ k[1], p0 & MASK]
        k = [(k[0] + 0x9E3779B9) & MASK, (k[1] + 0xBB67AE85) & MASK]
    return c


def key_of(seed, name):
    return struct.unpack("<II", hashlib.sha256(f"{seed}:{name}".encode()).digest()[:8])


def bits(seed, name, index, draw, stream):
    key = key_of(seed, name)
    words = philox4x32_10([index & MASK, index >> 32, draw, stream], key)
    return words[0] | words[1] << 32


def bits_in_trial(seed, name, trial, k, stream):
    words = philox4x32_10([trial & MASK, (trial >> 32) + (k >> 32 << 24), k & MASK, stream], key_of(seed, name))
    return words[0] | words[1] << 32


def uniform(w):
    return ((w >> 12) + 0.5) * 2.0**-52


def sobol_first_dimension(index):
    """Gray-code van der Corput sequence as a 64-bit fraction."""
    gray = index ^ (index >> 1)
    return int(format(gray, "064b")[::-1], 2)


def rotor(seed, name, machine, correlation_length, harmonics):
    """Cosine and sine coefficients of a profile of this machine."""
    variances = [1.0] + [2 * math.exp(-((m * correlation_length / 2) ** 2)) for m in range(1, harmonics)]
    normal = statistics.NormalDist().inv_cdf
    coefficients = {}
    for draw, part in ((2, "cosine"), (3, "sine")):
        coefficients[part] = [
            0.0 if part == "sine" and m == 0 else math.sqrt(variance / sum(variances)) * normal(uniform(bits(seed, name, m + machine * 2**32, draw, 0)))
            for m, variance in enumerate(variances)
        ]
    return coefficients


def judge_machines():
    """What is drawn for a machine, the study, a trial and a contact."""
    answers = json.loads(subprocess.check_output([sys.argv[1], "machine_draws"]))
    for a in answers:
        seed, trial, stream = a["seed"], a["trial"], a["stream"]
        machine = trial % a["machines"]
        wanted = {
            "friction.k1.profile.mean": bits(seed, "friction.k1.profile.mean", machine, 0, 0),
            "friction.k2": bits(seed, "friction.k2", machine, 0, 0),
            "friction.beta": bits(seed, "friction.beta", 0, 0, 0),
            "initial.position": bits(seed, "initial.position", trial, 0, stream),
        }
        for name, w in wanted.items():
            if a[name] != (1.0 + uniform(w)) - 1.0:
                sys.exit(f"{a}: {name} should be {uniform(w)}")
        contacts = [uniform(bits(seed, "friction.lambda", trial, 0, stream))]
        contacts += [uniform(bits_in_trial(seed, "friction.lambda/contacts", trial, k, stream)) for k in (1, 2, 3)]
        if a["friction.lambda"] != [(1.0 + u) - 1.0 for u in contacts]:
            sys.exit(f"{a}: the contacts should have {contacts}")
        judged = rotor(seed, "friction.k1", machine, a["correlation_length"], len(a["cosine"]))
        for part in ("cosine", "sine"):
            worst = max(abs(x - y) for x, y in zip(a[part], judged[part], strict=True))
            if worst > 1e-12:
                sys.exit(f"{a}: {part} differs by {worst}")
    if len(answers) < 8 or len({a["friction.k2"] for a in answers}) < 3:
        sys.exit(f"only {len(answers)} trials on machines were compared")
    print(f"{len(answers)} trials on machines agree")


def main():
    assert philox4x32_10([0, 0, 0, 0], [0, 0]) == [0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8]
    answers = json.loads(subprocess.check_output([sys.argv[1], "draws"]))
    compared = 0
    for a in answers:
        stream = a["point"] + 1 if a["independent"] else 0
        for name in ("friction.k1", "initial.position"):
            if a["design"] == "monte_carlo":
                w = bits(a["seed"], name, a["trial"], 0, stream)
            elif a["design"] == "sobol" and name == "friction.k1":
                w = sobol_first_dimension(a["trial"]) ^ bits(a["seed"], name, 0, 1, stream)
            elif a["design"] == "saltelli":
                row, place = divmod(a["trial"], 4)
                from_b = place == 1 or place == (2 if name == "friction.k1" else 3)
                w = bits(a["seed"], name, row + 2**55 if from_b else row, 0, stream)
            else:
                continue
            # The study adds 1 to the uniform number and the answer takes it away again.
            if a[name] != (1.0 + uniform(w)) - 1.0:
                sys.exit(f"{a}: {name} should be {uniform(w)}")
            compared += 1
    if compared < 100:
        sys.exit(f"only {compared} draws were compared")
    print(f"{compared} draws agree")

    # What the trial itself will draw from.
    names = [
        "initial.history/levels",
        "encoder.fine_errors.noise/samples",
        "encoder.fine_errors.missed/samples",
        "encoder.coarse_errors.noise/samples",
        "encoder.coarse_errors.missed/samples",
        "dac.noise/samples",
    ]
    for a in answers:
        randomness = a["randomness"]
        row, place = divmod(a["trial"], 4)
        trial = (row + 2**55 if place == 1 else row) if a["design"] == "saltelli" else a["trial"]
        wanted = {"trial": trial, "stream": a["point"] + 1 if a["independent"] else 0}
        wanted |= {name: list(key_of(a["seed"], name)) for name in names}
        if randomness != wanted:
            sys.exit(f"{randomness} should be {wanted}")
    # A fixed answer, so that the definition cannot drift in both places at once.
    assert key_of(20020721, "initial.history/levels") == (0xD21635AD, 0x895827FC)
    print(f"the keys of {len(answers)} trials agree")
    judge_machines()


main()
