#pragma once

#include <cstdint>

namespace zerocount::random {

/// A standard normal number: Φ⁻¹(u) with u = open_uniform(bits). Its absolute value is below 8.21;
/// complementary bits give exactly the negative.
double standard_normal(std::uint64_t bits);

/// A standard normal number for the noise in a running trial, by a formula that the lanes evaluate as well.
/// It is within a relative 1e-15 of standard_normal(), which draws the parameters of manifests.
double standard_normal_noise(std::uint64_t bits);

/// A binomial number: how many of `n` independent events of probability `probability` occur. By inversion:
/// the smallest j with F(j) ≥ u, u = open_uniform(bits), F(j) = Σ_{i≤j} C(n, i)·pⁱ·(1 − p)ⁿ⁻ⁱ.
/// @param n not negative. @param probability p, in [0, 1].
std::int64_t binomial_number(std::int64_t n, double probability, std::uint64_t bits);

}  // namespace zerocount::random
