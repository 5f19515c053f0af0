"""The random numbers of studies, computed anew from their documented definition with hashlib and integers alone."""

import hashlib
import json
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


def uniform(w):
    return ((w >> 12) + 0.5) * 2.0**-52


def sobol_first_dimension(index):
    """Gray-code van der Corput sequence as a 64-bit fraction."""
    gray = index ^ (index >> 1)
    return int(format(gray, "064b")[::-1], 2)


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


main()
