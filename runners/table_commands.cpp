#include <fmt/format.h>

#include "experiments/language/json_schema.hpp"
#include "experiments/parameters/parameter_listing.hpp"
#include "runners/commands.hpp"

namespace zerocount {
namespace {

ExitCode print_parameters(const Arguments& arguments) {
  const std::string format = arguments.one_of("format", {"text", "markdown"});
  fmt::print("{}", format == "text" ? parameters_as_text() : parameters_as_markdown());
  return ExitCode::success;
}

ExitCode print_schema(const Arguments&) {
  fmt::print("{}\n", json_schema().dump(2));
  return ExitCode::success;
}

}  // namespace

Command parameters_command() {
  return {{"parameters", "", 0, 0, {{"format", "FORMAT", "text (default) or markdown"}}},
          "list every parameter: unit, default, range, source",
          "Every physical value of a manifest may be a number or a distribution; what is left out has the "
          "default.\n",
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
