#pragma once

#include <complex>
#include <functional>
#include <vector>

#include "core/theory/frozen_loop.hpp"

/// Where the frequency response L(z), z = exp(i·ωT), of a loop crosses the unit circle and the negative real
/// axis. Angles are ωT, 0 < ωT < π.
namespace zerocount::theory {

/// A frequency response at an angle.
using Response = std::function<std::complex<double>(double angle)>;

/// Angles in increasing order that show the shape of L: from a millionth of π to just below π, spread by
/// their logarithm; closer where the delay turns the phase by more than 0.3 rad from one to the next; and
/// around the plant's poles and the controller's poles and zeros by their distance from the unit circle. At a
/// pole on the circle, where L is infinite, there is none.
std::vector<double> search_angles(const FrozenLoop& loop);

/// Adds angles around those of these poles or zeros, in increasing order.
void add_angles_around(const Eigen::VectorXcd& roots, std::vector<double>& angles);

/// A frequency response, and its values at angles that show its shape.
struct SampledResponse {
  Response at;
  std::vector<double> angles;                  ///< increasing
  std::vector<std::complex<double>> values{};  ///< [angle]
};
SampledResponse sampled(Response response, std::vector<double> angles);

/// The angles at which |response| passes 1. Also between angles at which |response| comes near 1 from the
/// same side.
std::vector<double> gain_crossovers(const SampledResponse& response);

/// The angles at which the response passes the real axis, other than through infinity.
std::vector<double> phase_crossovers(const SampledResponse& response);

}  // namespace zerocount::theory
