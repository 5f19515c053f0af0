#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/manifest/load_study.hpp"
#include "experiments/manifests/shipped_manifests.hpp"
#include "runners/command_line/output_place.hpp"
#include "runners/commands/commands.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/status/status.hpp"

namespace zerocount::commands {
namespace {

constexpr const char* new_help =
    "Copies a manifest that comes with the program to NAME.yaml in this folder, as the start of your own "
    "study.\n"
    "--list prints the names and questions of these manifests.\n"
    "\n"
    "Examples:\n"
    "  zerocount new --list\n"
    "  zerocount new paper-gains -o my-axis.yaml\n";

std::vector<std::string> manifest_names() {
  std::vector<std::string> stems;
  for (const text::EmbeddedFile& file : manifests::shipped_manifests())
    stems.emplace_back(file.name.substr(0, file.name.rfind('.')));
  return stems;
}

void print_list() {
  std::size_t width = 0;
  for (const text::EmbeddedFile& file : manifests::shipped_manifests())
    width = std::max(width, file.name.size());
  for (const text::EmbeddedFile& file : manifests::shipped_manifests()) {
    const study::Study study = manifest::parse_study(std::string(file.bytes), file.name);
    standard_output::print("{:<{}} {}\n", file.name.substr(0, file.name.rfind('.')), width,
                           study.description);
  }
}

ExitCode make_new(const command_line::Arguments& arguments) {
  const bool list = arguments.has("list");
  if (list != arguments.operands().empty()) arguments.refuse("expected the name of a manifest, or --list");
  if (list) {
    print_list();
    return ExitCode::success;
  }
  const text::EmbeddedFile& file = manifests::shipped_manifest(arguments.operands()[0]);
  const std::filesystem::path output =
      command_line::text_place(arguments, "output").value_or(std::filesystem::path(file.name));
  command_line::require_places(arguments, {}, {output});
  command_line::write_text(output, file.bytes);
  if (output != "-") status::tell("wrote {}; next: zerocount check {}\n", output.string(), output.string());
  return ExitCode::success;
}

}  // namespace

Command new_command() {
  return {{"new",
           "[NAME]",
           {{"list", "", "print the names and questions of the manifests"},
            {"output,o", "FILE", "the manifest to make; default: NAME.yaml"},
            command_line::force_option()},
           0,
           1,
           manifest_names()},
          "start a study from a manifest that comes with the program",
          new_help,
          make_new};
}

}  // namespace zerocount::commands
