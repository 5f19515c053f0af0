#pragma once

#include <string>

#include "runners/tuning/tuner.hpp"

namespace zerocount::tuning {

std::string json_of(const TuneAnswer& answer);

/// The answer in sentences and tables: what is proven first, then what it rests on.
/// @param study that was tuned. @param output the results file of the proof
std::string text_of(const TuneAnswer& answer, const study::Study& study, const std::string& output);

std::string limits_json(const std::vector<Limit>& limits);
/// A table: each cause, the rate without it, and the part of the failures that it causes.
std::string limits_text(const std::vector<Limit>& limits, bool of_machines);

std::string worst_json(const WorstMachine& worst);
std::string worst_text(const WorstMachine& worst, bool on_rigs);

}  // namespace zerocount::tuning
