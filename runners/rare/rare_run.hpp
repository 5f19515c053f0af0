#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <vector>

#include "runners/rare/estimator.hpp"
#include "runners/rare/failure_description.hpp"
#include "runners/rare/rare_question.hpp"

namespace zerocount::rare {

struct RareSettings {
  std::filesystem::path output;  ///< of the weighted trials; empty: none is written
  double confidence{statistics::summary_confidence};
  double ratio{2.0};                       ///< wanted of the bounds, high / low
  std::optional<std::int64_t> max_trials;  ///< of this run
  std::optional<double> seconds;           ///< of this run
  bool quiet{false};
  bool force{false};  ///< replace a file that answers another question
};

struct RareAnswer {
  const Question& question;
  RareSettings settings;
  EstimatorState state{};
  Estimate estimate{};
  std::vector<FailureInput> inputs{};
  std::optional<CarryingMachines> machines{};
  double seconds{0.0};  ///< of all runs
};

/// Estimates the probability of the event, and writes the results file. Goes on from an earlier file that
/// answers the same question.
/// @param question outlives the answer
/// @throws Failure: bad_input if the file exists and answers another question; machine_failed; interrupted,
/// after the trials drawn so far are written
RareAnswer run_rare(const Question& question, const RareSettings& settings, const std::stop_token& stop);

}  // namespace zerocount::rare
