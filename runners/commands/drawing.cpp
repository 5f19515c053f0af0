#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "analysis/trials/theory/plausibility.hpp"
#include "core/failure/failure.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/reading/results_file.hpp"
#include "runners/child_process/child_process.hpp"
#include "runners/command_line/command_line.hpp"
#include "runners/commands/command.hpp"
#include "runners/status/status.hpp"

namespace zerocount::commands {
namespace {

/// Runs a program and returns what it writes to standard output.
/// @param words name of the program, and its arguments
/// @param input text for its standard input
/// @param package software package that contains the program, for the message if it is missing
std::string output_of(const std::vector<std::string>& words, std::string_view input,
                      std::string_view package) {
  const std::optional<child_process::ChildResult> result = child_process::run_child(words, input);
  if (!result) {
    throw Failure(ExitCode::machine_failed,
                  fmt::format("{} not found, which draws the figure; install it (Debian: apt-get install {})",
                              words.front(), package));
  }
  if (result->code == 0 && !result->out.empty()) return result->out;
  throw Failure(ExitCode::machine_failed, fmt::format("{} failed with exit code {}; expected "
                                                      "nodejs 18 or later and librsvg 2.50 or later",
                                                      words.front(), result->code));
}

}  // namespace

std::string picture(const report::Figure& figure, std::string_view extension) {
  const char* const form = extension == ".json" ? "specification" : "svg";
  const std::string drawn = output_of({"node", "-"}, report::drawing_program(figure, form), "nodejs");
  if (extension != ".png") return drawn;
  // Three pixels per point of the figure: 300 per inch at a width of 140 mm.
  return output_of({"rsvg-convert", "--format", "png", "--zoom", "3"}, drawn, "librsvg2-bin");
}

DrawingKind drawing_kind(const command_line::Arguments& arguments, std::string_view option,
                         const std::filesystem::path& place) {
  const std::string extension = place.extension().string();
  if (extension == ".html" || extension == ".htm" || yaml::is_standard_stream(place))
    return DrawingKind::page;
  if (extension == ".svg") return DrawingKind::svg;
  if (extension == ".png") return DrawingKind::png;
  arguments.refuse(
      fmt::format("option '--{}': '{}' does not end in .html, .svg or .png", option, place.string()));
}

std::string drawing(const report::ReportPage& page, DrawingKind kind) {
  if (kind == DrawingKind::page) return report::html_page(page);
  return picture(page.sections.front().figures.front(), kind == DrawingKind::png ? ".png" : ".svg");
}

namespace fs = std::filesystem;

}  // namespace zerocount::commands
