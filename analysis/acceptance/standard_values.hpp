#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/monitor/move_log.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::acceptance {

/// A value of ISO 230-2 by the encoder, counts: of the simulated machines, and of the measured ones.
struct StandardValue {
  std::string_view name;    ///< "repeatability"
  std::string_view symbol;  ///< of the standard
  double median{0.0};       ///< of the simulated runs of the test
  double low{0.0};          ///< 95 % of them lie between these
  double high{0.0};
  std::vector<double> measured{};  ///< [run] of all machines; NaN where it is not defined
  std::int64_t within{0};          ///< measured runs between `low` and `high`
};

/// The values of the axis, where the study has a sequence of moves and each log the columns `final_error` and
/// `move`; empty otherwise. A run of the test is as many rows with the numbers 0 to the last one in this
/// order; other rows are left out.
std::vector<StandardValue> standard_values(const reading::AllTrialsFile& file, std::int64_t point,
                                           std::span<const monitor::MoveLog> logs);

}  // namespace zerocount::acceptance
