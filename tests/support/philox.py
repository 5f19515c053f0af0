"""The random numbers of studies, from their documented definition with integers alone."""

MASK = 0xFFFFFFFF


def philox4x32_10(counter, key):
    c, k = list(counter), list(key)
    for _ in range(10):
        p0, p1 = 0xD2511F53 * c[0], 0xCD9E8D57 * c[2]
        c = [(p1 >> 32) ^ c[1] ^ k[0], p1 & MASK, (p0 >> 32) ^ c[3] ^ k[1], p0 & MASK]
        k = [(k[0] + 0x9E3779B9) & MASK, (k[1] + 0xBB67AE85) & MASK]
    return c


# The answer published with Random123 (its file kat_vectors).
assert philox4x32_10([0, 0, 0, 0], [0, 0]) == [0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8]


def uniform_at(key, stream, trial, k):
    """The uniform number k of a trial, drawn while it runs."""
    counter = [trial & MASK, (trial >> 32) + ((k >> 32) << 24), k & MASK, stream]
    words = philox4x32_10(counter, key)
    return (((words[0] | words[1] << 32) >> 12) + 0.5) * 2.0**-52
