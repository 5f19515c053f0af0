#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "runners/tuning/worst_in_box.hpp"

namespace zerocount::tuning {

using NamedValues = std::vector<std::pair<std::string, double>>;

/// "controller.ki = 5, controller.kp = 0"
std::string values_text(const NamedValues& values);
nlohmann::ordered_json values_json(const NamedValues& values);

nlohmann::ordered_json worst_object(const WorstMachine& worst);
std::string worst_text(const WorstMachine& worst, const study::Study& study);

std::string worst_json(const WorstMachines& worst);
/// The worst machine of the study, and a table: the worst of the box, and of the likely ones.
std::string worst_text(const WorstMachines& worst, const study::Study& study);

}  // namespace zerocount::tuning
