#pragma once

#include <string>
#include <vector>

#include "runners/tuning/tuner.hpp"

namespace zerocount::tuning {

/// @param study that was tuned
std::string json_of(const TuneAnswer& answer, const study::Study& study);

/// "met: the goal is met by these values".
std::string headline(const TuneAnswer& answer, const study::Study& study);

/// The margins that are missing at the nearest point, in sentences; none where some values keep them all.
std::vector<std::string> nearest_lines(const TuneAnswer& answer, const study::Study& study);

/// The statement of the proof, in sentences.
std::vector<std::string> proof_lines(const TuneAnswer& answer, const study::Study& study);

/// What is proven, in sentences and tables, or that nothing could be.
/// @param study that was tuned. @param output the results file of the proof
std::string proven_text(const TuneAnswer& answer, const study::Study& study, const std::string& output);

/// What it rests on, by simulation; empty without a proof.
std::string rest_text(const TuneAnswer& answer, const study::Study& study);

}  // namespace zerocount::tuning
