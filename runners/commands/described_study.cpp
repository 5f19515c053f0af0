#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "analysis/report/report.hpp"
#include "analysis/trials/summary/chosen_summary.hpp"
#include "analysis/trials/theory/plausibility.hpp"
#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/sections/named_tables.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/hdf5/foreign_file.hpp"
#include "results/layout/header.hpp"
#include "results/reading/results_file.hpp"
#include "results/shards/shard.hpp"
#include "results/storage/file_contents.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/plugins/crash_message.hpp"
#include "runners/plugins/plugin_library.hpp"
#include "runners/status/status.hpp"
#include "runners/verification/replay.hpp"

namespace zerocount::commands {
namespace {

/// Study that a complete results file describes. Refuses options such as --set, which change a manifest only.
study::Study study_in_file(const fs::path& path, const command_line::Arguments& arguments) {
  if (!arguments.values("set").empty())
    arguments.refuse("option '--set': changes a manifest, not a results file; expected a manifest");
  const reading::ResultsFile file(path);
  require_simulable(file);
  return file.study();
}

}  // namespace

void require_simulable(const reading::ResultsFile& file) {
  if (file.header().plugin)
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: its controller is a plugin, which the file does not contain; expected its "
                              "manifest",
                              file.path().string()));
}

bool is_results_file(const fs::path& path) {
  if (path.extension() == ".h5") return true;
  return !yaml::is_stream(path) && hdf5::is_hdf5_with_user_block(path);
}

study::Study described_study(const fs::path& path) {
  return layout::recorded_study(shards::inspect_header(path, layout::Checksum::not_yet), path);
}

study::Study load_study(const fs::path& operand, const command_line::Arguments& arguments) {
  if (is_results_file(operand)) return study_in_file(operand, arguments);
  const std::vector<fs::path> outputs = command_line::outputs_of(arguments);
  const fs::path folder = yaml::is_stream(operand) ? fs::path() : operand.parent_path();
  const auto input = [&](const fs::path& path) {
    command_line::require_no_output(arguments, path, outputs);
    return path;
  };
  const auto load_plugin = [&](const std::string& path) {
    plugins::name_in_crashes(folder / path);
    return plugins::load_plugin(input(folder / path));
  };
  const auto read_table = [&](const std::string& path, std::string_view what) {
    return yaml::read_text(input(folder / path), sections::max_samples_size, what);
  };
  return manifest::load_study(operand, arguments.values("set"),
                              {.plugin = load_plugin, .samples = read_table});
}

std::optional<std::int64_t> study_point(const command_line::Arguments& arguments, const study::Study& study) {
  const std::vector<std::string>& labels = study.points.labels;
  if (arguments.value("point") != "best" || std::ranges::find(labels, "best") != labels.end())
    return command_line::point_option(arguments, labels);
  const std::string& operand = arguments.operands()[0];
  if (is_results_file(operand)) return summary::summarise_chosen(operand).chosen.point;
  if (labels.size() > 1)
    arguments.refuse(
        "option '--point': a manifest has no results to tell which of its points is best; "
        "expected a results file, or a point by label or number");
  return 0;
}

std::shared_ptr<const plugin::ControllerPlugin> plugin_option(const command_line::Arguments& arguments) {
  const std::optional<std::string> path = arguments.value("plugin");
  if (!path) return nullptr;
  plugins::name_in_crashes(*path);
  const sections::LoadedPlugin loaded = plugins::load_plugin(*path);
  if (const auto* fault = std::get_if<plugin::PluginFault>(&loaded))
    arguments.refuse(fmt::format("option '--plugin': {}; expected {}", fault->what, fault->expected));
  return std::get<std::shared_ptr<const plugin::ControllerPlugin>>(loaded);
}

std::string report_source(const std::filesystem::path& file) {
  return fmt::format("{} by zerocount {}", storage::recorded_checksum(file),
                     layout::current_provenance().git_commit);
}

report::StudyReport verified_report(const reading::AllTrialsFile& file, report::ReportOptions options) {
  options.check = [&](const report::ReplayedTrial& replayed) {
    auto [different, parting] = verification::compare_with_record(file, file.study(), replayed.result);
    if (parting)
      different.push_back(
          verification::text_of(*parting) +
          ", because the loop amplifies the rounding that parts the two engines, and the figure "
          "is of the reference engine");
    return different;
  };
  report::StudyReport report = report::study_report(file, options);
  report.page.source = report_source(file.path());
  for (const std::string& warning : report.warnings) status::tell("zerocount: warning: {}\n", warning);
  return report;
}

}  // namespace zerocount::commands
