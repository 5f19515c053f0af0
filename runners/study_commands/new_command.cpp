#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/text/text.hpp"
#include "experiments/guides/guide_manifest.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/manifests/shipped_manifests.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/status/status.hpp"
#include "runners/study_commands/study_commands.hpp"

namespace zerocount::study_commands {
namespace {

constexpr const char* new_help =
    "Copies a manifest that comes with the program to NAME.yaml in this folder, as the start of your own study.\n"
    "--list prints the names and questions of these manifests, and the guides.\n"
    "With --guide it writes a manifest of an axis on that guide instead, whose friction nobody has measured\n"
    "yet: each value has a range and its source (zerocount parameters --guides). It is a starting point, to\n"
    "be replaced by what zerocount identify finds. --breakaway, --travel and --secant say what was measured\n"
    "of its friction spring: the force at which it slides, the travel up to there, and the force over travel\n"
    "at a shorter one. The stiffness to which it softens is drawn within what these allow.\n"
    "\n"
    "Examples:\n"
    "  zerocount new --list\n"
    "  zerocount new paper-gains -o my-axis.yaml\n"
    "  zerocount new --guide ball-rail --preload 800 --mass 12 -o my-axis.yaml\n"
    "  zerocount new --guide crossed-roller --breakaway 4 --travel 10e-6 --secant 1.5e6@2e-6\n";

// Beyond them a number is a mistake, of units for example.
constexpr double max_mass = 1e5;         // kg
constexpr double max_preload = 1e6;      // N
constexpr double max_resolution = 1e-3;  // m
constexpr double max_travel = 1.0;       // m
constexpr double max_stiffness = 1e12;   // N/m

std::vector<std::string> manifest_names() {
  std::vector<std::string> stems;
  for (const text::EmbeddedFile& file : manifests::shipped_manifests())
    stems.emplace_back(file.name.substr(0, file.name.rfind('.')));
  return stems;
}

std::vector<std::string> guide_names() {
  std::vector<std::string> names;
  for (const guides::Guide& guide : guides::guide_table()) names.emplace_back(guide.name);
  return names;
}

command_line::OptionSpec guide_choice() {
  command_line::OptionSpec option{
      "guide", "GUIDE", fmt::format("write a manifest of an axis on {}", fmt::join(guide_names(), ", "))};
  option.words = guide_names();
  return option;
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
  standard_output::print("\nGuides (zerocount new --guide NAME):\n");
  for (const guides::Guide& guide : guides::guide_table())
    standard_output::print("{:<{}} {}\n", guide.name, width, guide.description);
}

double positive_number(const command_line::Arguments& arguments, std::string_view option,
                       std::string_view text, double high) {
  const std::optional<double> number = text::parse_number<double>(text);
  if (!number || !(*number > 0.0) || !(*number <= high))
    arguments.refuse(
        fmt::format("option '--{}': '{}'; expected a number above 0 and at most {:g}", option, text, high));
  return *number;
}

/// Value of an option that needs --guide, a number above 0 and at most `high`; nothing without the option.
/// @param applies whether the option has an effect on this guide; otherwise it is refused
std::optional<double> guide_option(const command_line::Arguments& arguments, std::string_view option,
                                   const guides::Guide& guide, bool applies, double high) {
  const std::optional<std::string> text = arguments.value(option);
  if (!text) return std::nullopt;
  if (!applies) arguments.refuse(fmt::format("option '--{}' has no effect on {}", option, guide.name));
  return positive_number(arguments, option, *text, high);
}

/// Measured values of the friction spring of a guide, from the options --breakaway, --travel and --secant;
/// nothing without these options.
std::optional<guides::MeasuredSpring> measured_spring(const command_line::Arguments& arguments,
                                                      const guides::Guide& guide) {
  const bool applies = guides::has_load(guide);
  const auto breakaway = guide_option(arguments, "breakaway", guide, applies, max_preload);
  const auto travel = guide_option(arguments, "travel", guide, applies, max_travel);
  const std::optional<std::string> secant = arguments.value("secant");
  if (!breakaway && !travel && !secant) return std::nullopt;
  if (!breakaway || !travel || !secant)
    arguments.refuse(
        fmt::format("option '--{}' is missing; a measured spring has --breakaway, --travel and --secant",
                    !breakaway ? "breakaway"
                    : !travel  ? "travel"
                               : "secant"));
  if (!applies) arguments.refuse(fmt::format("option '--secant' has no effect on {}", guide.name));
  const auto at = secant->find('@');
  if (at == std::string::npos)
    arguments.refuse(fmt::format("option '--secant': '{}'; expected N/m@m, such as 1.5e6@2e-6", *secant));
  const guides::MeasuredSpring spring{
      *breakaway, *travel, positive_number(arguments, "secant", secant->substr(0, at), max_stiffness),
      positive_number(arguments, "secant", secant->substr(at + 1), max_travel)};
  if (const std::string fault = guides::fault_of(spring); !fault.empty())
    arguments.refuse(fmt::format(
        "no friction spring has this --breakaway (N), --travel (m) and --secant (N/m@m): {}", fault));
  return spring;
}

std::string manifest_of_guide(const command_line::Arguments& arguments) {
  const guides::Guide& guide = guides::guide_named(arguments.choice("guide"));
  const bool linear = guide.axis == parameters::AxisKind::linear;
  guides::GuideAxis axis{.load = guides::usual_load(guide)};
  axis.load.mass = guide_option(arguments, "mass", guide, linear, max_mass).value_or(axis.load.mass);
  axis.load.preload = guide_option(arguments, "preload", guide, guides::has_load(guide), max_preload)
                          .value_or(axis.load.preload);
  axis.resolution =
      guide_option(arguments, "resolution", guide, linear, max_resolution).value_or(axis.resolution);
  axis.spring = measured_spring(arguments, guide);
  return guides::guide_manifest(guide, axis);
}

void write_manifest(const command_line::Arguments& arguments, const std::string& usual_name,
                    std::string_view manifest) {
  const std::optional<std::filesystem::path> named = command_line::text_place(arguments, "output");
  const std::filesystem::path output = named.value_or(usual_name);
  if (!named) command_line::require_replaceable(arguments, output);
  command_line::write_text(output, manifest);
  if (output != "-")
    status::tell("wrote {}; next: zerocount check {}\n", output.string(), text::shell_path(output));
}

ExitCode make_new(const command_line::Arguments& arguments) {
  const bool list = arguments.has("list");
  const bool guide = arguments.has("guide");
  if (static_cast<int>(list) + static_cast<int>(guide) + static_cast<int>(std::ssize(arguments.operands())) !=
      1)
    arguments.refuse("expected either the name of a manifest, --guide or --list");
  if (list) {
    print_list();
  } else if (guide) {
    write_manifest(arguments, arguments.choice("guide") + ".yaml", manifest_of_guide(arguments));
  } else {
    const text::EmbeddedFile& file = manifests::shipped_manifest(arguments.operands()[0]);
    write_manifest(arguments, std::string(file.name), file.bytes);
  }
  return ExitCode::success;
}

command_line::OptionSpec of_guide(command_line::OptionSpec option) {
  return command_line::needing({"guide"}, std::move(option));
}

}  // namespace

commands::Command new_command() {
  return {
      {"new",
       "[NAME]",
       {{"list", "", "print the names and questions of the manifests, and the guides"},
        guide_choice(),
        command_line::excluding(
            {"breakaway"},
            of_guide({"preload", "N", "with --guide: normal force on all its carriages together, N"})),
        of_guide({"mass", "KG", "with --guide: moving mass of a linear axis, kg"}),
        of_guide({"resolution", "M", "with --guide: encoder of a linear axis, m per count; default 1e-8"}),
        of_guide({"breakaway", "N", "with --guide: measured force at which it slides, N"}),
        of_guide({"travel", "M", "with --guide: measured travel up to breakaway, m"}),
        of_guide({"secant", "K@M", "with --guide: measured force over travel, N/m, at a travel, m"}),
        command_line::excluding(
            {"list"},
            command_line::kept_file({"output,o", "FILE", "the manifest to make; default: NAME.yaml"})),
        command_line::excluding({"list"}, command_line::force_option())},
       0,
       1,
       manifest_names()},
      "start a study from a manifest that comes with the program",
      new_help,
      make_new};
}

}  // namespace zerocount::study_commands
