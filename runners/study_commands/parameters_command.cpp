#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/basis/document/answer.hpp"
#include "experiments/guides/guide_manifest.hpp"
#include "experiments/guides/guide_table.hpp"
#include "experiments/keys/manifest_keys.hpp"
#include "experiments/manifest/parameter_listing.hpp"
#include "runners/answers/answer_format.hpp"
#include "runners/commands/command.hpp"
#include "runners/study_commands/study_commands.hpp"

namespace zerocount::study_commands {
namespace {

struct ParameterTables {
  std::string headline;
  std::vector<manifest::ListedParameter> parameters;
  std::vector<manifest::ListedDistribution> distributions{};
  std::span<const shapes::Shape> keys{};
};

document::AnswerDescription<ParameterTables> parameters_answer() {
  using Parameter = manifest::ListedParameter;
  using Distribution = manifest::ListedDistribution;
  using Key = shapes::Shape;
  document::AnswerDescription<ParameterTables> answer{
      {.name = "parameters", .meaning = "what a manifest can say", .csv_table = "parameters"}, {}};
  answer.items.headline(&ParameterTables::headline)
      .table(
          {"parameters", "Parameters and their defaults", "parameters and their defaults"},
          document::Description<Parameter>()
              .value({"name", "name", "dotted path in a manifest"}, &Parameter::name)
              .value({"unit", "unit", "1 where it is dimensionless"}, &Parameter::unit)
              .value({"default", "default", "value where a manifest has none, or the range over the guides"},
                     &Parameter::default_value)
              .value({"allowed", "allowed", "words, or the range of numbers"}, &Parameter::allowed)
              .value({"source", "source of the default", "source of the default"}, &Parameter::source)
              .value({"meaning", "meaning", "what it is"}, &Parameter::meaning),
          &ParameterTables::parameters)
      .table({"distributions", "Distributions (allowed in place of any number)",
              "what may stand in place of any number"},
             document::Description<Distribution>()
                 .value({"name", "name", "key of the distribution"}, &Distribution::name)
                 .value({"written", "written", "as in a manifest"}, &Distribution::written)
                 .value({"meaning", "meaning", "what it is"}, &Distribution::meaning),
             &ParameterTables::distributions)
      .table({"keys", "Other keys of a manifest", "other keys of a manifest"},
             document::Description<Key>()
                 .value({"name", "name", "dotted path in a manifest"}, &Key::name)
                 .value({"required", "required", "whether every manifest has it"}, &Key::required)
                 .value({"meaning", "meaning", "what it is"}, &Key::meaning),
             &ParameterTables::keys);
  return answer;
}

/// A quantity of a linear guide, with the guide and the load (preload class) for which it is given.
struct NumberOfGuide {
  const guides::Guide& guide;
  guides::GuideLoad load;
  guides::GuideNumber number;
};

struct GuideTables {
  std::vector<NumberOfGuide> quantities;
  std::vector<NumberOfGuide> parameters;
};

GuideTables guide_tables() {
  GuideTables tables;
  for (const guides::Guide& guide : guides::guide_table()) {
    const guides::GuideLoad load = guides::usual_load(guide);
    for (const guides::GuideNumber& number : guide.numbers)
      tables.quantities.push_back({guide, load, number});
    for (const guides::GuideNumber& number : guides::guide_parameters(guide, load))
      tables.parameters.push_back({guide, load, number});
  }
  return tables;
}

document::Description<NumberOfGuide> number_of_guide(const std::string& quantity) {
  constexpr auto digits = document::Notation::three_digits;
  return document::Description<NumberOfGuide>()
      .value({quantity, quantity, "what is between low and high"},
             [](const NumberOfGuide& n) { return n.number.quantity; })
      .value({"unit", "unit", "1 where it is dimensionless"},
             [](const NumberOfGuide& n) { return n.number.unit; })
      .value({"low", "low", "least value to expect, in the unit", "", digits},
             [](const NumberOfGuide& n) { return n.number.low; })
      .value({"high", "high", "largest value to expect, in the unit", "", digits},
             [](const NumberOfGuide& n) { return n.number.high; })
      .value(document::with_words({"origin", "origin", "where the numbers come from"},
                                  {guides::origin_labels.begin(), guides::origin_labels.end()}),
             [](const NumberOfGuide& n) {
               return guides::origin_labels[static_cast<std::size_t>(n.number.origin)];
             });
}

document::AnswerDescription<GuideTables> guides_answer() {
  const auto name = [](const NumberOfGuide& n) { return n.guide.name; };
  const auto mass_unit = [](const NumberOfGuide& n) { return parameters::unit_on(n.guide.axis, "kg m^2"); };
  document::AnswerDescription<GuideTables> answer{{.name = "parameters-guides",
                                                   .meaning = "starting values of guides and bearings",
                                                   .csv_table = "quantities"},
                                                  {}};
  answer.items
      .headline([](const GuideTables&) {
        return fmt::format("{} guides and bearings, with what is known of their friction",
                           guides::guide_table().size());
      })
      .table({"quantities", "Quantities of the guides", "quantities of the guides"},
             document::Description<NumberOfGuide>()
                 .value({"guide", "guide", "name of the guide"}, name)
                 .include(number_of_guide("quantity"), std::identity())
                 .value({"source", "source or reason", "publication and place, or reason of an assumption"},
                        [](const NumberOfGuide& n) { return n.number.source; }),
             &GuideTables::quantities)
      .table({"parameters", "Parameters of the guides with their usual mass and preload",
              "parameters of the guides with their usual mass and preload"},
             document::Description<NumberOfGuide>()
                 .value({"guide", "guide", "name of the guide"}, name)
                 .value({.key = "mass_text", .heading = "mass", .shown = document::Visibility::to_people},
                        [=](const NumberOfGuide& n) {
                          return fmt::format("{:.3g} {}", n.load.mass, mass_unit(n));
                        })
                 .value(document::in_data("mass", "mass or moment of inertia that it moves"),
                        [](const NumberOfGuide& n) { return n.load.mass; })
                 .value(document::in_data("mass_unit", "unit of the mass"), mass_unit)
                 .value({"preload", "preload", "preload; null where friction does not depend on it", "N"},
                        [](const NumberOfGuide& n) {
                          return guides::has_load(n.guide) ? std::optional(n.load.preload) : std::nullopt;
                        })
                 .include(number_of_guide("parameter"), std::identity()),
             &GuideTables::parameters);
  return answer;
}

ParameterTables tables_of_study(const study::Study& study) {
  std::vector<manifest::ListedParameter> parameters = manifest::listed_parameters(study);
  return {fmt::format("{} parameters of the study {}", parameters.size(), study.name), std::move(parameters)};
}

ParameterTables all_tables(const command_line::Arguments& arguments) {
  parameters::StudyUnits units;
  if (arguments.choice("axis") == "linear") units.axis = parameters::AxisKind::linear;
  if (arguments.choice("units") == "si") units.gains = parameters::GainUnits::si;
  std::vector<manifest::ListedParameter> parameters = manifest::listed_parameters(units);
  return {fmt::format("{} parameters; a manifest states those that differ from their defaults",
                      parameters.size()),
          std::move(parameters), manifest::listed_distributions(units), keys::general_keys()};
}

ExitCode print_parameters(const command_line::Arguments& arguments) {
  if (arguments.has("guides")) return answers::print(arguments, guides_answer().of(guide_tables()));
  const auto manifest = arguments.value("manifest");
  return answers::print(
      arguments, parameters_answer().of(manifest ? tables_of_study(commands::load_study(*manifest, arguments))
                                                 : all_tables(arguments)));
}

}  // namespace

commands::Command parameters_command() {
  return {
      {"parameters",
       "",
       {answers::format_option(),
        command_line::excluding(
            {"guides"},
            command_line::read_file(
                {"manifest", "FILE",
                 "list the parameters of this study, which decides the units, including each value of its lists"})),
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
      print_parameters,
      [] {
        return std::vector{parameters_answer().complete_type(), guides_answer().complete_type()};
      }};
}

}  // namespace zerocount::study_commands
