#pragma once

#include <cstdint>

namespace zerocount::random {

/// A standard normal number: Φ⁻¹(u) with u = open_uniform(bits). Its absolute value is below 8.21;
/// complementary bits give exactly the negative.
double standard_normal(std::uint64_t bits);

/// The same for the noise in a running trial, by a formula that lanes have, too: within 1e-15 relative of
/// standard_normal(), whose bits the drawn parameters of manifests keep.
double standard_normal_noise(std::uint64_t bits);

/// A binomial number: how many of `n` independent events of probability `probability` occur. By inversion:
/// the smallest j with F(j) ≥ u, u = open_uniform(bits), F(j) = Σ_{i≤j} C(n, i)·pⁱ·(1 − p)ⁿ⁻ⁱ.
/// @param n not negative. @param probability p, in [0, 1].
std::int64_t binomial_number(std::int64_t n, double probability, std::uint64_t bits);

}  // namespace zerocount::random
