#include <fmt/format.h>

#include "analysis/trials/iso230/results_group.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/reading/export.hpp"
#include "results/reading/results_file.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/status/status.hpp"
#include "runners/study_commands/study_commands.hpp"

namespace zerocount::study_commands {
namespace {

constexpr const char* export_help =
    "Writes the tables of a results file as CSV: points.csv, trials.csv, outcomes.csv and jerks.csv;\n"
    "profiles.csv if there are profiles, machines.csv and machine_counts.csv if there are machines, worlds.csv and\n"
    "world_counts.csv if there are worlds, trace.csv if the study retains trials, levels.csv for an\n"
    "open-loop study, and four tables repeatability_….csv for one with a sequence of moves. A file\n"
    "without its trials (keep) gives the tables that it has. The header row has the units, such as\n"
    "arrival_time [s]; columns without a unit are dimensionless. Numbers read back to the same double.\n"
    "\n"
    "Example: zerocount export gains.h5 -o gains-csv\n";

ExitCode export_file(const command_line::Arguments& arguments) {
  const std::string directory = arguments.required("output");
  if (yaml::is_standard_stream(directory)) {
    arguments.refuse(
        "option '--output': the tables are several files and cannot go to standard output; name a folder");
  }
  const std::string& results = arguments.operands()[0];
  const auto existing =
      arguments.has("force") ? reading::ExistingFiles::replace : reading::ExistingFiles::refuse;
  const reading::ResultsFile file(results);
  reading::export_csv(file, directory, iso230::repeatability_exports(file), existing);
  status::tell("wrote the tables to {}\n", directory);
  return ExitCode::success;
}

}  // namespace

commands::Command export_command() {
  return {{"export",
           "FILE -o DIR",
           {command_line::renewed_file({"output,o", "DIR", "the folder for the tables (required)"}),
            command_line::force_option()}},
          "write a results file's tables as CSV",
          export_help,
          export_file};
}

}  // namespace zerocount::study_commands
