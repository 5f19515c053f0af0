#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "analysis/document/answer.hpp"
#include "runners/tuning/worst_machines/worst_machines.hpp"

namespace zerocount::design_commands {

/// The answer of `worst` on a point of a study with targets, whose machine is written to no manifest.
/// @throws as tuning::worst_machines
document::Answer worst_of(const study::Study& study, std::int64_t point, const trials::Effort& effort);

using NamedValues = std::vector<std::pair<std::string, double>>;

/// "controller.ki = 5, controller.kp = 0"
std::string values_text(const NamedValues& values);

/// "rig 3", or "trial 3" of a study without rigs.
std::string machine_name(const tuning::WorstMachine& worst, bool on_rigs);

/// "rig 3, 75 % of its moves meet the goal; friction.k1 = 175".
std::string worst_machine_text(const tuning::WorstMachine& worst, const study::Study& study);

/// The machine of a study that does worst; for data only, because worst_machine_text() says it.
document::Description<tuning::WorstMachine> worst_description();

}  // namespace zerocount::design_commands
