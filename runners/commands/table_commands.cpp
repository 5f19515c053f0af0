#include <fmt/format.h>

#include "experiments/manifest/json_schema.hpp"
#include "experiments/manifest/parameter_listing.hpp"
#include "runners/commands/commands.hpp"

namespace zerocount {
namespace {

ExitCode print_parameters(const Arguments& arguments) {
  const std::string format = arguments.one_of("format", {"text", "markdown"});
  StudyUnits units;
  if (arguments.one_of("axis", {"rotary", "linear"}) == "linear") units.axis = AxisKind::linear;
  if (arguments.one_of("units", {"count", "si"}) == "si") units.gains = GainUnits::si;
  fmt::print("{}", format == "text" ? parameters_as_text(units) : parameters_as_markdown(units));
  return ExitCode::success;
}

ExitCode print_schema(const Arguments&) {
  fmt::print("{}\n", json_schema().dump(2));
  return ExitCode::success;
}

}  // namespace

Command parameters_command() {
  return {
      {"parameters",
       "",
       0,
       0,
       {{"format", "FORMAT", "text (default) or markdown"},
        {"axis", "AXIS", "rotary (default) or linear: as they are on an axis of this kind"},
        {"units", "UNITS", "count (default) or si: as the gains are with controller.units"}}},
      "list every parameter: unit, default, range, source",
      "Every physical value of a manifest may be a number or a distribution; what is left out has the "
      "default. A default in other units is none: on a linear axis most values have to be given, and with\n"
      "--units si the integral gain.\n",
      print_parameters};
}

Command schema_command() {
  return {{"schema", "", 0, 0, {}},
          "print the JSON Schema of manifests, for editors",
          "Example: zerocount schema > zerocount.schema.json, and in the manifest's first line\n"
          "  # yaml-language-server: $schema=zerocount.schema.json\n",
          print_schema};
}

}  // namespace zerocount
