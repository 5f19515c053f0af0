#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "core/failure/failure.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "results/layout/header.hpp"
#include "results/layout/layout.hpp"
#include "results/layout/recorded_values.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/shard.hpp"
#include "results/storage/durable_file.hpp"
#include "runners/status/progress.hpp"
#include "runners/status/status.hpp"
#include "runners/study_run/file_run.hpp"
#include "runners/trials/study_runner.hpp"

namespace zerocount::study_run {
namespace {

namespace fs = std::filesystem;

/// The header of a results file without the last override, if this is the number of trials that a stopping
/// rule decided on. So it can be compared with the manifest's study.
layout::FileHeader as_requested(layout::FileHeader header, const study::Study& study) {
  if (study.stop && !header.overrides.empty() && header.overrides.back().starts_with(decided_key))
    header.overrides.pop_back();
  return header;
}

[[noreturn]] void refuse(const fs::path& output, std::string_view what) {
  throw Failure(ExitCode::bad_input, fmt::format("{}: {}; --force replaces it, or give another name with -o",
                                                 output.string(), what));
}

layout::FileHeader header_of(const fs::path& output) {
  try {
    return reading::ResultsFile(output, reading::Require::any_part).header();
  } catch (const Failure& failure) {
    if (failure.code() == ExitCode::machine_failed) throw;  // it may be a good file
    refuse(output, fmt::format("exists, and is not a usable results file ({})", failure.what()));
  }
}

/// Checks that trials can be added to the results file `output` until it has those of the longer study.
/// @throws Failure (bad_input) if the file cannot be extended
void require_extensible(const fs::path& output, const layout::FileHeader& header, const study::Study& study) {
  const auto refuse_more = [&](std::string_view why) {
    refuse(output,
           fmt::format("has {} trials at each point and the study {}; {}", header.trials, study.trials, why));
  };
  if (!header.complete) refuse_more("a part of a study cannot be extended");
  if (layout::has_sums(study.retention))
    refuse_more("a study that does not keep its trials cannot be extended");
  if (study.trials < header.trials) refuse_more("a results file can only be extended");
  if (!study::trials_stay_when_extended(study.design)) {
    refuse_more(fmt::format("the trials of design: {} are laid out for their number, and all change with it",
                            keys::design_labels[static_cast<std::size_t>(study.design)]));
  }
  if (!layout::same_build(header.provenance, layout::current_provenance())) {
    refuse_more(
        fmt::format("its trials were run by another build ({}, commit {}), and trials of different "
                    "builds are not mixed",
                    header.provenance.zerocount_version, header.provenance.git_commit));
  }
}

}  // namespace

ExistingUse use_of_existing(const fs::path& output, const study::Study& study, layout::RowRange wanted) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(output, error))) return ExistingUse::none;
  const layout::FileHeader header = header_of(output);
  const std::vector<manifest_text::ManifestDifference> differences =
      layout::study_differences(output, as_requested(header, study), study);
  if (differences.empty()) layout::require_same_plugin(output, header, study.plugin.get());
  if (header.engine != study.engine) {
    refuse(output, fmt::format("holds the results of the {} engine, and this run is for the {} engine",
                               layout::name_of(header.engine), layout::name_of(study.engine)));
  }
  const bool other_number = differences.size() == 1 && differences.front().key == "trials";
  if (other_number && !study.stop && wanted == layout::all_rows(study)) {
    layout::require_same_plugin(output, header, study.plugin.get());
    require_extensible(output, header, study);
    return ExistingUse::extend;
  }
  if (!differences.empty())
    refuse(output, "holds the results of another study: " + manifest_text::differences_text(differences));
  if (!study.stop && !(header.rows == wanted)) {
    refuse(output, fmt::format("holds trials {} to {} of this study, and this run is for {} to {}",
                               header.rows.first, header.rows.end() - 1, wanted.first, wanted.end() - 1));
  }
  return ExistingUse::complete;
}

}  // namespace zerocount::study_run
