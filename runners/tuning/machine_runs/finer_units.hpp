#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/trial/error_bands.hpp"
#include "core/trial/move_measures.hpp"
#include "core/trial/outcome.hpp"

/// Conversion of a changed trial's results to the units of its study. A finer encoder measures in finer
/// counts, and a faster controller in shorter samples. The goal of the study still refers to the study's
/// counts.
///
/// If n finer counts are one count of the study, an error of e' finer counts is an error of e counts of the
/// study:
///
///   |e| = 0 where |e'| ≤ n/2,   |e| ≤ b where |e'| ≤ n·b + n/2,   sgn e = sgn e',
///
/// So zero counts extend over ± half a count of the study, and a band keeps its length. Measures that zero
/// counts define are the measures of the band 0 (core/trial/measures.md).
namespace zerocount::tuning {

/// Units of a trial with a finer encoder or a higher sample rate, in relation to the study's.
struct FinerUnits {
  std::int64_t counts{1};  ///< Encoder counts of the changed trial in one count of the study; 1 or even.
  /// Samples of the changed trial in one sample of the study: ratio of the sample rates.
  std::int64_t samples{1};

  bool operator==(const FinerUnits&) const = default;
};

/// Converts a position error from finer encoder counts to counts of the study, rounded to whole counts.
/// @param counts FinerUnits::counts, finer counts in one count of the study
std::int64_t error_in_study_counts(std::int64_t finer_error, std::int64_t counts);

/// Error bands, in finer counts, that represent the study's bands and the bands of 0 and 1 count of the
/// study. Nothing if these are more bands than a trial can measure.
/// @param counts FinerUnits::counts, finer counts in one count of the study
std::optional<trial::ErrorBands> finer_bands(const trial::ErrorBands& of_study, std::int64_t counts);

/// Whether a measure of a move with finer counts can be converted to counts of the study. It cannot if it
/// depends on zero counts of single samples.
bool is_known_in_study_units(std::string_view measure);

/// Converts the measures of a move to the units of the study. Measures that cannot be converted are NaN.
/// @param finer measures of the changed move, with finer_bands() of the study
/// @param timing timing of the changed move
trial::MoveOutcome in_study_units(const trial::MoveOutcome& finer, const FinerUnits& units,
                                  const trial::ErrorBands& of_study, const trial::MoveTiming& timing);

}  // namespace zerocount::tuning
