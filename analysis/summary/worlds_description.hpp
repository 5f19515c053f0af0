#pragma once

#include <vector>

#include "analysis/document/description.hpp"
#include "analysis/worlds/world_statistics.hpp"

namespace zerocount::summary {

/// The worlds at a design point, and what differs between them.
struct WorldsReading {
  const worlds::PointWorlds& point;
  const std::vector<worlds::WorldInput>& inputs;
};

/// Rates and verdicts by world, the bad worlds and the rule that tells them apart; for data only, because
/// bad_worlds_sentence() and tables say what matters of them.
document::Description<WorldsReading> worlds_description();

}  // namespace zerocount::summary
