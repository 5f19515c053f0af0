#include <algorithm>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "results/layout/header.hpp"
#include "results/shards/merge.hpp"
#include "results/storage/output_lock.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/status/status.hpp"
#include "runners/study_commands/study_commands.hpp"
#include "runners/study_run/file_run.hpp"

namespace zerocount::study_commands {
namespace {

namespace fs = std::filesystem;

constexpr const char* merge_help =
    "Joins the parts of one study into its results file. An input is a part file made with\n"
    "'run --shard', a shard, or a folder of shards. Together they must hold every trial of\n"
    "the study exactly once.\n"
    "\n"
    "Example: zerocount merge a.h5 b.h5 -o all.h5\n";

void require_everything(const std::vector<shards::ShardInfo>& parts, const study::Study& study) {
  const std::vector<layout::RowRange> missing = shards::missing_ranges(parts, layout::all_rows(study));
  if (missing.empty()) return;
  std::string ranges;
  for (std::size_t i = 0; i < std::min<std::size_t>(missing.size(), 8); ++i) {
    ranges += fmt::format("{}{} to {}", i > 0 ? ", " : "", missing[i].first, missing[i].end() - 1);
  }
  throw Failure(
      ExitCode::bad_data,
      fmt::format("the inputs do not contain the whole study: of its {} trials, {}{} are missing; run "
                  "those parts and merge them too",
                  study::trial_count(study), ranges, missing.size() > 8 ? " and more" : ""));
}

ExitCode merge(const command_line::Arguments& arguments) {
  const fs::path output = command_line::output_place(arguments);
  const std::vector<fs::path> inputs(arguments.operands().begin(), arguments.operands().end());
  const study::Study study = layout::recorded_study(shards::first_header(inputs), inputs.front());
  const storage::OutputLock lock(output);
  commands::print_fallback_lock(lock, output);
  const std::vector<shards::ShardInfo> parts = shards::merge_inputs(inputs, study);
  require_everything(parts, study);
  study_run::assemble(parts, study, output, layout::all_rows(study));
  status::tell("wrote {}\n", output.string());
  return ExitCode::success;
}

}  // namespace

commands::Command merge_command() {
  return {{"merge",
           "PART... -o FILE",
           {command_line::kept_file({"output,o", "FILE", "the results file to make (required)"}),
            command_line::force_option()},
           1,
           100000},
          "join the parts of a study that was run in parts",
          merge_help,
          merge};
}

}  // namespace zerocount::study_commands
