#pragma once

#include <string>
#include <vector>

#include "analysis/document/figure.hpp"
#include "runners/design_commands/tune_answer.hpp"

namespace zerocount::design_commands {

// Of a tuning that is drawn (Tuning::drawn); none without a proof, or without the extra.

std::vector<document::Figure> map_figures(const Tuning& tuning);
std::vector<document::Figure> frontier_figures(const Tuning& tuning);
std::vector<document::Figure> lost_ages_figures(const Tuning& tuning);
std::vector<document::Figure> retuning_figures(const Tuning& tuning);
std::vector<document::Figure> room_figures(const Tuning& tuning);

/// "band_settling_time.p95 (s)": what is minimised, with its unit.
std::string criterion_title(const study::Study& study);

}  // namespace zerocount::design_commands
