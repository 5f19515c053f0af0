#pragma once

#include <filesystem>
#include <string>

#include "analysis/document/answer.hpp"
#include "runners/tuning/tuner.hpp"

namespace zerocount::design_commands {

/// What `tune` found so far.
struct Tuning {
  const tuning::TuneAnswer& answer;
  const study::Study& study;     ///< that was tuned
  std::filesystem::path output;  ///< the results file of the proof
  bool drawn{false};             ///< with figures
};

/// What is proven, or that nothing could be: it stands before the rest is found.
document::AnswerDescription<Tuning> proven_answer();

/// What the proven values rest on, by simulation; the effort.
document::AnswerDescription<Tuning> rest_answer();

/// All of it, with figures.
document::AnswerDescription<Tuning> tune_answer();

}  // namespace zerocount::design_commands
