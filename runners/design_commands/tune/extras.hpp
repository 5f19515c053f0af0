#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runners/tuning/extras.hpp"

namespace zerocount::design_commands {

/// The extras of `tune`, in the order of what they tell. A new one is its file and its row here.
const std::vector<tuning::Extra>& all_extras();

/// How much more of controller.delay a goal bears; of a goal that is missed what a wider band would change.
struct MoreDelay {
  std::vector<double> delays{};  ///< [condition] controller.delay of the tuned study, samples; none if missed
  std::optional<double> lost{};  ///< more of it, by which a goal seems lost, to 0.05; nothing up to max_more
  std::size_t claim{0};          ///< of Aim::claims that is lost
  std::optional<double> wider_band_rate{};  ///< of the worst goal, with a band one count wider
};

/// Range of a free parameter, the others as tuned, in which all goals seem to be met under all conditions.
struct Room {
  std::string name;
  double low{0.0};
  double high{0.0};
  /// The claims (Aim::claims) that are lost first beyond the ends; nothing at the end of the range.
  std::optional<std::size_t> lost_below{}, lost_above{};
};

/// A simpler or another control at its own best values.
struct Alternative {
  std::string name;  ///< "controller.kd = 0", "observer added"
  std::vector<std::pair<std::string, double>> fixed;
  std::vector<std::pair<std::string, double>> gains;  ///< empty if none keeps the margins
  std::optional<goal::Verdict> verdict{};             ///< on machines that the search for it never saw
  double criterion{0.0};                              ///< on these machines
  std::optional<std::string> worst_goal{}, worst_condition{};  ///< of several goals, and with conditions
};

}  // namespace zerocount::design_commands
