#pragma once

#include <filesystem>

#include "analysis/summary/summary.hpp"
#include "results/reading/study_file.hpp"

namespace zerocount::summary {

/// The summary of a complete results file. What was observed comes from its manifest, what the criteria say
/// from the columns of its /point: the trials are not drawn again. Every bound is found anew.
/// @throws Failure (bad_input) for a confidence outside (0, 1), (bad_data) where the file is damaged.
StudySummary summarise(const reading::StudyFile& file, double confidence = statistics::summary_confidence,
                       bool bootstrap = false);

/// The summary of a run that has not ended: of the trials in its finished shards, of each point those before
/// the first that is missing, so that every rig has as many as there can be. Points without trials at the
/// end are left out, and so are sections about all trials.
/// @param shards the folder of the run's shards
/// @throws Failure (bad_data) where there is no finished trial, a shard is damaged or of another study;
/// (bad_input) where a shard vanishes, as shards do when the run ends.
StudySummary summarise_unfinished(const std::filesystem::path& shards, double confidence, bool bootstrap);

}  // namespace zerocount::summary
