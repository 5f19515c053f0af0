#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/trial/trial.hpp"

/// Encoders, converter and amplifier, computed independently from core/README.md and the recorded samples of
/// a whole trial at once.
namespace zerocount::testing {

/// What an encoder shows at each sample, by the recorded angles.
std::vector<std::int64_t> literal_fine_counts(const trial::TrialParameters& p,
                                              const std::vector<trial::SampleRecord>& samples);
std::vector<std::int64_t> literal_coarse_counts(const trial::TrialParameters& p,
                                                const std::vector<trial::SampleRecord>& samples);

/// The amplifier over a part of a sample.
struct LiteralDrive {
  long double input{0};   ///< v, N m
  long double output{0};  ///< u at its start, N m
  long double time{0};    ///< its duration, s
};

/// The amplifier's input and output in each sample, in two parts, by the recorded codes, or by the recorded
/// torques past the converter.
std::vector<std::array<LiteralDrive, 2>> literal_drive(const trial::TrialParameters& p,
                                                       const std::vector<trial::SampleRecord>& samples);

}  // namespace zerocount::testing
