#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "analysis/goal/question.hpp"
#include "runners/tuning/limits.hpp"

namespace zerocount::tuning {

/// [{"cause", "rate", "note"}]: without a rate the note is the reason, without either it is null.
nlohmann::ordered_json limits_array(const std::vector<Limit>& limits);

std::string limits_json(const std::vector<Limit>& limits);

/// A table: each cause, the rate without it, and the part of the failures that it causes; below it those that
/// are not simulated.
std::string limits_text(const std::vector<Limit>& limits, const goal::Question& question);

}  // namespace zerocount::tuning
