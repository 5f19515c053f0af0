#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "analysis/record/records/dataset_file.hpp"
#include "analysis/record/records/raw_series.hpp"

namespace zerocount::records {
namespace {

constexpr std::size_t neighbourhood = 10;  // samples to both sides
constexpr double like_neighbours = 3.0;    // of the longest step among them

/// Jumps of the angle with which the encoder's reading may wrap, in the unit of RawSeries::angle (counts, rad
/// or m).
std::vector<double> possible_wraps(const RawSeries& series) {
  std::vector<double> wraps;
  const bool counted = series.count_size > 0.0;
  if (!series.linear) wraps.push_back(2.0 * std::numbers::pi / (counted ? series.count_size : 1.0));
  if (counted) wraps.insert(wraps.end(), {0x1p16, 0x1p32});
  return wraps;
}

double step_to(const RawSeries& series, std::size_t k) {
  return series.angle[k] - series.angle[k - 1];
}

/// Longest step of the angle between neighbouring samples near sample k, in the unit of RawSeries::angle;
/// steps of a quarter of `wrap` or more are left out.
double longest_about(const RawSeries& series, std::size_t k, double wrap) {
  double longest = 0.0;
  const std::size_t first = k > neighbourhood ? k - neighbourhood : 1;
  for (std::size_t i = first; i < std::min(k + neighbourhood + 1, series.angle.size()); ++i) {
    const double step = std::abs(step_to(series, i));
    if (step < 0.25 * wrap) longest = std::max(longest, step);
  }
  return longest;
}

/// Indices of the samples at which the angle wraps by `wrap`; empty if any long step is neither a wrap nor a
/// plausible motion.
std::vector<std::size_t> wrapped_samples(const RawSeries& series, double wrap) {
  std::vector<std::size_t> wrapped;
  const double rounding = series.count_size > 0.0 ? 1.0 : 1e-4 * wrap;
  for (std::size_t k = 1; k < series.angle.size(); ++k) {
    const double step = step_to(series, k);
    if (std::abs(step) < 0.25 * wrap) continue;
    const double without = std::abs(step - std::copysign(wrap, step));
    if (without > std::max(rounding, like_neighbours * longest_about(series, k, wrap))) return {};
    wrapped.push_back(k);
  }
  return wrapped;
}

}  // namespace

void unwrap(RawSeries& series) {
  for (const double wrap : possible_wraps(series)) {
    const std::vector<std::size_t> wrapped = wrapped_samples(series, wrap);
    if (wrapped.empty()) continue;
    series.notes.push_back(
        fmt::format("the encoder wraps: its reading jumps by {:.6g} {} at {}{}, and is continued", wrap,
                    series.count_size > 0.0 ? "counts" : "rad", place_of(series, wrapped.front()),
                    wrapped.size() > 1 ? fmt::format(" and {} more", wrapped.size() - 1) : ""));
    std::vector<double> turned(series.angle.size(), 0.0);
    for (const std::size_t k : wrapped) turned[k] = -std::copysign(wrap, step_to(series, k));
    double sum = 0.0;
    for (std::size_t k = 0; k < turned.size(); ++k) series.angle[k] += sum += turned[k];
    return;
  }
}

}  // namespace zerocount::records
