#include <algorithm>
#include <cstddef>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/history/run_record.hpp"
#include "core/failure/failure.hpp"
#include "experiments/yaml/text_file.hpp"

namespace zerocount::history {
namespace {

using ComparisonJson = nlohmann::json;

constexpr std::size_t max_size = std::size_t{256} << 20U;  ///< bytes of JSON

double number_of(const ComparisonJson& value) {
  return value.is_null() ? statistics::unknown : value.get<double>();
}

ValueComparison value_comparison(const ComparisonJson& measure) {
  ValueComparison found;
  found.verdict = measure.at("verdict").get<std::string>();
  found.baseline = number_of(measure.at("baseline"));
  found.effect = number_of(measure.at("effect"));
  found.bounds = {number_of(measure.at("effect_low")), number_of(measure.at("effect_high"))};
  found.margin = number_of(measure.at("margin"));
  const double one_sided = std::min(number_of(measure.at("p")), number_of(measure.at("improvement_p")));
  found.p = std::min(1.0, 2.0 * one_sided);
  return found;
}

/// "NAME, made 2026-… by commit …, seed 7, 200 trials".
std::string description_of(const std::string& name, const std::string& created, const std::string& commit,
                           const std::string& seed, std::int64_t trials) {
  return fmt::format("{}, made {} by commit {}, seed {}, {} trials", name, created, commit, seed, trials);
}

std::string description_of(const RunRecord& run) {
  return description_of(run.study, run.created, run.git_commit, run.seed, run.trials);
}

std::string description_of(const ComparisonJson& file) {
  return description_of(file.at("name").get<std::string>(), file.at("created").get<std::string>(),
                        file.at("git_commit").get<std::string>(), file.at("seed").dump(),
                        file.at("trials").get<std::int64_t>());
}

void add(RunRecord& run, const ComparisonJson& comparison) {
  const ComparisonJson& baseline = comparison.at("baseline");
  run.comparison =
      RunComparison{comparison.at("verdict").get<std::string>(), comparison.at("layer").get<std::string>(),
                    baseline.at("created").get<std::string>(), baseline.at("git_commit").get<std::string>()};
  for (const ComparisonJson& point : comparison.at("points")) {
    const auto label = point.at("label").get<std::string>();
    for (const ComparisonJson& measure : point.at("measures")) {
      const auto name = measure.at("measure").get<std::string>();
      const auto value = std::find_if(run.values.begin(), run.values.end(), [&](const RunValue& one) {
        return one.point == label && one.measure == name;
      });
      if (value != run.values.end()) value->comparison = value_comparison(measure);
    }
  }
}

}  // namespace

void add_comparison(RunRecord& run, const std::filesystem::path& path) {
  const std::string name = yaml::name_of_text(path);
  const std::string text = yaml::read_text(path, max_size, "the JSON of 'zerocount compare'");
  try {
    const ComparisonJson parsed = ComparisonJson::parse(text);
    const std::string of = description_of(parsed.at("current"));
    if (of != description_of(run)) {
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: compares another run: {}; expected {}", name, of, description_of(run)));
    }
    add(run, parsed);
  } catch (const ComparisonJson::exception&) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: is not the JSON that 'zerocount compare --json' writes, or is damaged", name));
  }
}

}  // namespace zerocount::history
