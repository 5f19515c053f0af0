#include <utility>

#include <unistd.h>

#include "analysis/basis/text/report_json.hpp"
#include "experiments/manifest/json_schema.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/design_commands/design_commands.hpp"
#include "runners/program/commands.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/status/status.hpp"

namespace zerocount::program {
namespace {

/// Types of the answers that all commands give, for their schemas.
std::vector<document::AnswerType> answer_types() {
  std::vector<document::AnswerType> types;
  for (const commands::Command& command : commands()) {
    if (command.answers == nullptr) continue;
    for (document::AnswerType& type : command.answers()) types.push_back(std::move(type));
  }
  return types;
}

ExitCode print_schema(const command_line::Arguments& arguments) {
  standard_output::write(text::json_text(arguments.has("answers") ? document::json_schema(answer_types())
                                                                  : manifest::json_schema()));
  return ExitCode::success;
}

}  // namespace

commands::Command schema_command() {
  return {
      {"schema", "", {{"answers", "", "the schema of what the commands answer with --format json"}}, 0, 0},
      "print the JSON Schema of manifests, for editors, or of answers",
      "Example: zerocount schema > zerocount.schema.json, and in the manifest's first line\n"
      "  # yaml-language-server: $schema=zerocount.schema.json\n",
      print_schema};
}

}  // namespace zerocount::program
