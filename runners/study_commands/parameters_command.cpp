#include <string>

#include <fmt/format.h>

#include "experiments/manifest/parameter_listing.hpp"
#include "runners/commands/command.hpp"
#include "runners/commands/study_argument.hpp"
#include "runners/standard_output/standard_output.hpp"
#include "runners/study_commands/study_commands.hpp"

namespace zerocount::study_commands {
namespace {

/// @param text a text for people; otherwise Markdown, whose lines are not wrapped
void print_table(bool text, const std::string& table) {
  if (text) {
    standard_output::write_fitted(table);
  } else {
    standard_output::write(table);
  }
}

ExitCode print_parameters_of_study(const command_line::Arguments& arguments, const std::string& manifest,
                                   bool text) {
  const study::Study study = commands::load_study(manifest, arguments);
  print_table(text, text ? manifest::parameters_as_text(study) : manifest::parameters_as_markdown(study));
  return ExitCode::success;
}

ExitCode print_guides(bool text) {
  print_table(text, text ? manifest::guides_as_text() : manifest::guides_as_markdown());
  return ExitCode::success;
}

ExitCode print_parameters(const command_line::Arguments& arguments) {
  const std::string format = arguments.choice("format");
  if (arguments.has("guides")) return print_guides(format == "text");
  if (const auto manifest = arguments.value("manifest"))
    return print_parameters_of_study(arguments, *manifest, format == "text");
  parameters::StudyUnits units;
  if (arguments.choice("axis") == "linear") units.axis = parameters::AxisKind::linear;
  if (arguments.choice("units") == "si") units.gains = parameters::GainUnits::si;
  const bool text = format == "text";
  print_table(text, text ? manifest::parameters_as_text(units) : manifest::parameters_as_markdown(units));
  return ExitCode::success;
}

}  // namespace

commands::Command parameters_command() {
  return {
      {"parameters",
       "",
       {command_line::format_option({"text", "markdown"}),
        command_line::excluding({"guides"}, {"manifest", "FILE",
                                             "list the parameters of this study, which decides the units, "
                                             "including each value of its lists"}),
        command_line::needing({"manifest"},
                              {"set", "KEY=VALUE", "override a key of that manifest; may be repeated", true}),
        command_line::excluding(
            {"manifest", "guides"},
            command_line::choice_option("axis", "AXIS", {"rotary", "linear"}, "units on this kind of axis")),
        command_line::excluding({"manifest", "guides"},
                                command_line::choice_option("units", "UNITS", {"count", "si"},
                                                            "unit of the gains (controller.units)")),
        {"guides", "", "list the starting values of guides and bearings, with their sources"}},
       0,
       0},
      "list every parameter: unit, default, range, source",
      "Every physical value of a manifest is a number or a distribution. Missing values take the\n"
      "default, unless its unit differs: on a linear axis most values are required, and with\n"
      "--units si the integral gain. Such values of friction show the range of common guides.\n",
      print_parameters};
}

}  // namespace zerocount::study_commands
