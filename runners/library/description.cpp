#include "runners/library/description.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "analysis/basis/text/report_json.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/measures/move_criterion.hpp"
#include "core/failure/failure.hpp"
#include "core/text/text.hpp"
#include "core/trial/outcome.hpp"
#include "experiments/distributions/distribution.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/manifest_text/manifest_text.hpp"
#include "experiments/parameters/study_units.hpp"
#include "experiments/randomness/random_variables.hpp"
#include "experiments/sections/named_tables.hpp"
#include "experiments/yaml/problems.hpp"
#include "experiments/yaml/text_file.hpp"
#include "experiments/yaml/yaml_tree.hpp"
#include "results/layout/header.hpp"
#include "results/layout/measure_table.hpp"
#include "results/reading/results_file.hpp"
#include "runners/plugins/plugin_library.hpp"

namespace zerocount::library {
namespace {

namespace d = distributions;
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using yaml::YamlNode;

/// Maximum size of a text given to the library, bytes; far above the limit of a manifest.
constexpr std::size_t max_text = std::size_t{1} << 26;

template <class Value>
Json json_of(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

std::string_view name_of(layout::MoveReduction rule) {
  switch (rule) {
    case layout::MoveReduction::all:
      return "all";
    case layout::MoveReduction::any:
      return "any";
    case layout::MoveReduction::sum:
      return "sum";
    case layout::MoveReduction::largest:
      return "largest";
    case layout::MoveReduction::last:
      break;
  }
  return "last";
}

/// JSON description of a column of a table, with its unit and meaning in the words for this kind of axis.
Json column_json(const layout::Column& column, parameters::AxisKind axis) {
  Json words = Json::array();
  if (column.element != hdf5::Element::flag) {
    for (const layout::FlagMeaning& flag : column.flags) words.push_back({flag.value, flag.word});
  }
  Json json;
  json["unit"] = parameters::unit_on(axis, column.unit);
  json["meaning"] = parameters::text_on(axis, column.long_name);
  json["flags"] = std::move(words);
  json["type"] = type_of(column.element);
  return json;
}

template <class Record>
Json columns_json(const std::vector<layout::RecordField<Record>>& fields, parameters::AxisKind axis) {
  Json columns = Json::object();
  for (const layout::RecordField<Record>& field : fields)
    columns[field.column.name] = column_json(field.column, axis);
  return columns;
}

/// JSON list of the measures of moves, which also says how the values of a trial's moves are combined.
Json measures_json(const study::StudyFeatures& features) {
  std::set<std::string> names;
  for (const auto& field : layout::outcome_fields(features, layout::measure_table(features)))
    names.insert(field.column.name);
  Json measures = Json::object();
  for (const layout::Measure& measure : layout::measure_table(features)) {
    const layout::Column& column = measure.field.column;
    if (!names.contains(column.name)) continue;
    Json& described = measures[column.name] = column_json(column, features.axis);
    described["of_trial"] = name_of(measure.reduction);
  }
  return measures;
}

/// Words of the outcomes of a move, from best to worst.
std::vector<std::string> outcomes_by_severity() {
  std::vector<layout::FlagMeaning> labels = layout::outcome_labels();
  std::ranges::sort(labels, {}, [](const layout::FlagMeaning& label) {
    return trial::severity(static_cast<trial::Outcome>(label.value));
  });
  std::vector<std::string> words;
  words.reserve(labels.size());
  for (const layout::FlagMeaning& label : labels) words.push_back(label.word);
  return words;
}

Json axes_json(const std::vector<study::SweepAxis>& axes) {
  Json all = Json::array();
  for (const study::SweepAxis& axis : axes) {
    const bool numbers = axis.kind == study::SweepAxis::Kind::number;
    all.push_back({{"name", axis.name},
                   {"unit", axis.unit},
                   {"meaning", axis.meaning},
                   {"values", numbers ? Json(axis.numbers) : Json(axis.texts)}});  // NaN becomes null
  }
  return all;
}

Json inputs_json(const std::vector<study::InputColumn>& columns) {
  Json all = Json::array();
  for (const study::InputColumn& column : columns)
    all.push_back({{"name", column.name}, {"unit", column.unit}, {"meaning", column.meaning}});
  return all;
}

Json goals_json(const study::Study& study) {
  Json goals = Json::array();
  for (const study::Goal& goal : study.goals) {
    Json limits = Json::object();
    for (const study::GoalLimit& limit : goal.limits)
      limits[study::name_in(goal, limit.measure)] = limit.limit.value;
    goals.push_back({{"name", goal.name},
                     {"band", goal.tolerance ? Json() : Json(goal.band)},
                     {"tolerance", json_of(goal.tolerance)},
                     {"within", goal.within.after_profile ? Json() : Json(goal.within.time)},
                     {"after_profile", goal.within.after_profile ? Json(goal.within.time) : Json()},
                     {"moves", goal.moves},
                     {"machines", json_of(goal.machines)},
                     {"confidence", goal.confidence},
                     {"on", goal.on},
                     {"limits", limits},
                     {"rounding", measures::rounding_of_times},
                     {"of", goal.of ? Json(study::mass_text(*goal.of)) : Json()},
                     {"measure", goal::name_of_settling(goal)}});
  }
  return goals;
}

// The form that a distribution has in a manifest.
Json form_of(const d::Uniform& u) {
  return {{"uniform", Json::array({u.low, u.high})}};
}
Json form_of(const d::LogUniform& u) {
  return {{"log_uniform", Json::array({u.low, u.high})}};
}
Json form_of(const d::Normal& n) {
  return {{"normal", {{"mean", n.mean}, {"sd", n.sd}}}};
}
Json form_of(const d::TruncatedNormal& n) {
  return {{"truncated_normal", {{"mean", n.mean}, {"sd", n.sd}, {"low", n.low}, {"high", n.high}}}};
}
Json form_of(const d::Lognormal& l) {
  return {{"lognormal", {{"median", l.median}, {"cv", l.cv}}}};
}
Json form_of(const d::Triangular& t) {
  return {{"triangular", Json::array({t.low, t.mode, t.high})}};
}
Json form_of(const d::Integers& i) {
  return {{"integers", Json::array({i.low, i.high})}};
}
Json form_of(const d::Choice& c) {
  return {{"choice", c.values}};
}

/// Kind of a random variable: "value" (in its unit), "score" (normal score of a profile), or "row" (of joint
/// samples).
std::string_view kind_of(const randomness::RandomCoordinate& coordinate) {
  if (coordinate.rows > 0) return "row";
  return coordinate.kind == randomness::RandomCoordinate::Kind::profile_at_start ? "score" : "value";
}

/// The number that is the whole text, with or without a sign; nothing if the text is anything else.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  return text::parse_number<Number>(text);
}

Json scalar_json(const YamlNode& node) {
  if (!node.plain) return node.text;
  if (node.text == "true" || node.text == "false") return node.text == "true";
  if (const auto whole = number_in<std::int64_t>(node.text)) return *whole;
  if (const auto whole = number_in<std::uint64_t>(node.text)) return *whole;
  const auto real = number_in<double>(node.text);
  return real && std::isfinite(*real) ? Json(*real) : Json(node.text);
}

Json tree_json(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::null:
      break;
    case YamlNode::Kind::scalar:
      return scalar_json(node);
    case YamlNode::Kind::list: {
      Json list = Json::array();
      for (const yaml::YamlPointer& item : node.items) list.push_back(tree_json(*item));
      return list;
    }
    case YamlNode::Kind::map: {
      Json map = Json::object();
      for (const yaml::YamlEntry& entry : node.entries) map[entry.key] = tree_json(*entry.value);
      return map;
    }
  }
  return {};
}

}  // namespace

std::string_view type_of(hdf5::Element element) {
  switch (element) {
    case hdf5::Element::float64:
      return "float64";
    case hdf5::Element::int64:
      return "int64";
    case hdf5::Element::int32:
      return "int32";
    case hdf5::Element::int8:
      return "int8";
    case hdf5::Element::flag:
      return "bool";
    case hdf5::Element::text:
      break;
  }
  throw std::logic_error("a column of texts has no numbers");
}

study::Study study_of_text(std::string text, std::string_view source, const fs::path& folder,
                           const std::vector<std::string>& overrides) {
  const sections::ExternalInputs external{
      .plugin = [&](const std::string& path) { return plugins::load_plugin(folder / path); },
      .samples =
          [&](const std::string& path, std::string_view what) {
            return yaml::read_text(folder / path, sections::max_samples_size, what);
          }};
  return manifest::new_study(std::move(text), source, overrides, external);
}

study::Study study_of_file(const fs::path& file) {
  const reading::ResultsFile results(file, reading::Require::any_part);
  return layout::recorded_study(results.header(), file);
}

void require_point(const study::Study& study, std::int64_t point) {
  const std::int64_t points = std::ssize(study.points.labels);
  if (point < 0 || point >= points)
    throw Failure(ExitCode::bad_input, fmt::format("{}: point = {} is out of range; expected 0 to {}",
                                                   study.name, point, points - 1));
}

std::string description_of(const study::Study& study) {
  const study::StudyFeatures& features = study.features;
  const auto bands = features.bands.values();
  const auto tolerances = features.tolerances.values();
  Json json;  // filled key by key: an initializer list would copy what it is given
  json["name"] = study.name;
  json["description"] = study.description;
  json["seed"] = study.seed;
  json["trials"] = study.trials;
  json["machines"] = study.machines;
  json["worlds"] = study.worlds;
  json["conditions"] = study::labels_of(study.settings);
  json["condition_names"] = study.settings.conditions;
  json["ages"] = study.settings.ages.at;
  json["age_unit"] = study.settings.ages.unit;
  json["moves"] = study.moves;
  json["labels"] = study.points.labels;
  json["sha256"] = study.study_sha256;
  json["warnings"] = study.warnings;
  json["observed"] = study.observed;
  json["linear"] = features.axis == parameters::AxisKind::linear;
  json["axes"] = axes_json(study.points.axes);
  json["inputs"] = inputs_json(study.columns.inputs);
  json["bands"] = std::vector(bands.begin(), bands.end());
  json["tolerances"] = std::vector(tolerances.begin(), tolerances.end());
  json["goals"] = goals_json(study);
  json["severity"] = outcomes_by_severity();
  json["descriptions"]["samples"] = columns_json(layout::trace_fields(features), features.axis);
  json["descriptions"]["outcome"] = measures_json(features);
  return text::json_text(json, text::one_line);
}

randomness::RandomVariables sampled_variables(const study::Study& study, std::int64_t point) {
  require_point(study, point);
  if (!study.settings.empty())
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: a sample needs one condition; expected one of {}", study.name,
                              fmt::join(study::labels_of(study.settings), ", ")));
  return randomness::random_variables(study, point);
}

std::string variables_of(const study::Study& study, std::int64_t point) {
  const randomness::RandomVariables variables = sampled_variables(study, point);
  Json names = Json::array(), kinds = Json::array(), units = Json::array(), forms = Json::array();
  for (const randomness::RandomVariable& variable : variables.variables) {
    names.push_back(variable.name);
    kinds.push_back(kind_of(variable.coordinate));
    units.push_back(variable.unit);
    forms.push_back(
        std::visit([](const auto& distribution) { return form_of(distribution); }, variable.distribution));
  }
  return text::json_text({{"names", names},
                          {"kinds", kinds},
                          {"units", units},
                          {"distributions", forms},
                          {"correlations", variables.correlations}},
                         text::one_line);
}

std::string manifest_of(const std::string& text, std::string_view source,
                        const std::vector<std::string>& overrides) {
  yaml::Problems problems;
  std::deque<std::string> sources;
  yaml::YamlPointer root = yaml::parse_yaml(text, source, false, problems);
  if (root != nullptr) root = manifest_text::apply_overrides(root, overrides, sources, problems);
  problems.raise_if_any();
  return text::json_text(tree_json(*root), text::one_line);
}

std::string described(std::span<const std::string> words) {
  const auto from = [&](std::size_t first) {
    return std::vector<std::string>(words.begin() + static_cast<std::ptrdiff_t>(first), words.end());
  };
  if (words.size() == 2 && words[0] == "file") return description_of(study_of_file(words[1]));
  if (words.size() >= 3 && words[0] == "study")
    return description_of(
        study_of_text(yaml::read_text("-", max_text, "a manifest"), words[1], words[2], from(3)));
  if (words.size() >= 2 && words[0] == "manifest")
    return manifest_of(yaml::read_text("-", max_text, "a manifest"), words[1], from(2));
  throw Failure(
      ExitCode::bad_input,
      "zerocount --describe: expected study SOURCE FOLDER [SETTING...], manifest SOURCE [SETTING...] "
      "or file FILE");
}

}  // namespace zerocount::library
