#pragma once

#include <string>
#include <vector>

#include "runners/tuning/tuner.hpp"
#include "runners/tuning/worst_in_box.hpp"

namespace zerocount::tuning {

std::string json_of(const TuneAnswer& answer);

/// "met: the goal is met by these values"
std::string headline(const TuneAnswer& answer);

/// The statement of the proof, in sentences.
std::vector<std::string> proof_lines(const TuneAnswer& answer, const study::Study& study);

/// The answer in sentences and tables: what is proven first, then what it rests on.
/// @param study that was tuned. @param output the results file of the proof
std::string text_of(const TuneAnswer& answer, const study::Study& study, const std::string& output);

std::string worst_json(const WorstMachine& worst, const WorstInBox& in_box, const WorstInBox& likely);
/// A table: the worst machine of the box, and of the likely ones.
std::string worst_text(const WorstInBox& in_box, const WorstInBox& likely);
std::string worst_text(const WorstMachine& worst, bool on_rigs);

}  // namespace zerocount::tuning
