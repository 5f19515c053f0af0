#pragma once

#include <cstdint>
#include <string_view>

#include "core/random/random_numbers.hpp"

namespace zerocount::designs {

/// The random key of the quantity `name` in a study with this seed: the first 8 bytes of SHA-256 of the text
/// "<seed>:<name>" (the seed in decimal, the name the parameter's dotted path, e.g. "20020721:friction.k1"),
/// read as two little-endian 32-bit words: bytes 0–3 are key word 0, bytes 4–7 key word 1.
random::RandomKey random_key(std::uint64_t seed, std::string_view name);

}  // namespace zerocount::designs
