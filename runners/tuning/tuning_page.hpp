#pragma once

#include <filesystem>

#include "analysis/report/page.hpp"
#include "runners/tuning/tuner.hpp"

namespace zerocount::tuning {

/// The page of a tuning: the proof, the maps, the frontier, room and limits, and the worst machine; then the
/// report on the results file of the proof. Without a proof what is missing at the nearest point.
/// @param study that was tuned @param proof the results file of the proof
report::ReportPage tuning_page(const TuneAnswer& answer, const study::Study& study,
                               const std::filesystem::path& proof);

}  // namespace zerocount::tuning
