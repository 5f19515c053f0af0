#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/monitor/monitored_measure.hpp"
#include "analysis/monitor/move_label.hpp"
#include "analysis/monitor/move_log.hpp"
#include "core/trial/parameters.hpp"
#include "results/reading/all_trials_file.hpp"

namespace zerocount::monitor {

/// Moves that later ones are compared with.
struct Baseline {
  struct Column {
    MonitoredMeasure measure;
    std::string unit;            ///< empty: not stated
    std::vector<double> values;  ///< [move] ranked_value(), in SI where there is a unit
  };
  std::string name;  ///< of the file
  std::vector<Column> columns;
  std::int64_t moves{0};
  bool is_model{false};      ///< simulated, not of the machine
  std::int64_t machines{0};  ///< of a model: rigs, or trials that share none
  MoveLabels labels{};
  std::vector<std::string> groups{};  ///< [move] of a log that is read with a group

  const Column* find(std::string_view measure) const;
};

/// The labels of the moves of a trial, which begins at 0.
std::vector<MoveLabel> labels_of(const trial::TrialParameters& parameters);

/// Which moves of a results file.
struct ModelMoves {
  std::int64_t point{0};
  std::optional<std::int64_t> rig{};  ///< none: those of all
};

/// The moves of a log. @throws Failure (bad_data) if there is none
Baseline baseline_of(const MoveLog& log);

/// The moves of a results file, trial after trial.
/// @param file of one condition
Baseline baseline_of(const reading::AllTrialsFile& file, const ModelMoves& moves);

}  // namespace zerocount::monitor
