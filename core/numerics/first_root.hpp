#pragma once

#include <optional>
#include <span>

namespace zerocount::numerics {

/// The first t in (0, end] at which the polynomial Σ_k c[k]·tᵏ changes the sign that it has at t = 0
/// (c[0] ≠ 0); empty if it does not.
///
/// Finds every excursion to the other sign that lasts at least end·2⁻⁴⁰: the polynomial is subdivided in
/// Bernstein form, whose coefficients bound it (Farouki, "The Bernstein polynomial basis: a centennial
/// retrospective", CAGD 29, 2012), until one sign variation of the coefficients isolates one root. At most 16
/// coefficients.
std::optional<double> first_sign_change(std::span<const double> coefficients, double end);

/// The root in [low, high] of a polynomial with opposite signs at the ends, to about the last bit.
double bracketed_root(std::span<const double> coefficients, double low, double high);

}  // namespace zerocount::numerics
