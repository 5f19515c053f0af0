#include "analysis/pairs/history/run_record.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <functional>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/pairs/comparison/gate_rules.hpp"
#include "analysis/trials/goal/question.hpp"
#include "analysis/trials/summary/summary.hpp"
#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "experiments/parameters/handles.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/setting_study.hpp"
#include "experiments/yaml/text_file.hpp"
#include "results/layout/header.hpp"
#include "results/layout/recorded_values.hpp"
#include "results/storage/file_contents.hpp"

namespace zerocount::history {
namespace {

using Json = nlohmann::json;

double number_of(const Json& value) {
  return value.is_number() ? value.get<double>() : statistics::unknown;
}

/// Reads a file with a command's answer as JSON, and calls `take` with the parsed JSON and with its text.
/// @param command name of the command whose answer is expected
/// @param format option that makes the command print the answer as JSON, for messages
void read_answer(const std::filesystem::path& path, std::string_view command, std::string_view format,
                 const std::function<void(const Json&, const std::string&)>& take) {
  constexpr std::size_t max_size = std::size_t{256} << 20U;  // bytes
  const std::string text =
      yaml::read_text(path, max_size, fmt::format("the JSON of 'zerocount {}'", command));
  try {
    take(Json::parse(text), text);
  } catch (const Json::exception&) {
    throw Failure(ExitCode::bad_data, fmt::format("{}: is not the JSON that 'zerocount {} {}, or is damaged",
                                                  yaml::name_of_text(path), command, format));
  }
}

ValueComparison value_comparison(const Json& measure) {
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

/// Text that describes a run: "NAME, made 2026-… by commit …, seed 7, 200 trials".
std::string description_of(const RunIdentity& run) {
  return fmt::format("{}, made {} by commit {}, seed {}, {} trials", run.study, run.created, run.git_commit,
                     run.seed, run.trials);
}

std::string description_of(const Json& file) {
  RunIdentity run;
  run.study = file.at("name").get<std::string>();
  run.created = file.at("created").get<std::string>();
  run.git_commit = file.at("git_commit").get<std::string>();
  run.seed = file.at("seed").dump();
  run.trials = file.at("trials").get<std::int64_t>();
  return description_of(run);
}

void add(RunRecord& run, const Json& comparison) {
  const Json& baseline = comparison.at("baseline");
  run.comparison =
      RunComparison{comparison.at("verdict").get<std::string>(), comparison.at("layer").get<std::string>(),
                    baseline.at("created").get<std::string>(), baseline.at("git_commit").get<std::string>()};
  for (const Json& point : comparison.at("points")) {
    const auto label = point.at("label").get<std::string>();
    for (const Json& measure : point.at("measures")) {
      const auto name = measure.at("measure").get<std::string>();
      const auto value = std::find_if(run.values.begin(), run.values.end(), [&](const RunValue& one) {
        return one.point == label && one.measure == name;
      });
      if (value != run.values.end()) value->comparison = value_comparison(measure);
    }
  }
}

/// Time at which the file was last written, UTC, as 2002-07-21T12:00:00Z.
std::string time_written(const std::filesystem::path& path) {
  const auto written = std::chrono::file_clock::to_sys(std::filesystem::last_write_time(path));
  const std::time_t time =
      std::chrono::system_clock::to_time_t(std::chrono::time_point_cast<std::chrono::seconds>(written));
  std::tm utc{};
  gmtime_r(&time, &utc);
  std::string text(std::size_t{32}, '\0');
  text.resize(std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc));
  return text;
}

RunValue value_of(const Json& answer, const Json& measure) {
  RunValue value;
  value.point = answer.at("log").get<std::string>();
  value.measure = measure.at("measure").get<std::string>();
  value.unit = measure.at("unit").get<std::string>();
  value.value = number_of(measure.at("moves"));
  value.n = answer.at("moves").get<std::int64_t>();
  ValueComparison comparison;
  comparison.verdict = measure.at("alarm_at").is_null() ? "no alarm" : "changed";
  comparison.baseline = number_of(measure.at("baseline"));
  comparison.effect = value.value - comparison.baseline;
  // Valid at every time: without a change the evidence is ever E or more with a probability of at most 1/E.
  // It is the capital over the number of measures that are watched, so that this holds for the largest of
  // them.
  const double evidence = measure.at("evidence").get<double>();
  comparison.p = evidence > 1.0 ? 1.0 / evidence : 1.0;
  value.comparison = comparison;
  return value;
}

/// The median of the measure for each kind of similar moves in the answer of `zerocount monitor`. Empty
/// unless the kinds of moves make several peaks in the distribution of the measure.
std::vector<RunValue> values_of_likes(const Json& answer, const Json& measure) {
  std::vector<RunValue> values;
  if (!answer.contains("likes")) return values;
  for (const Json& like : answer.at("likes")) {
    if (like.at("measure") != measure.at("measure")) continue;
    RunValue value = value_of(answer, measure);
    value.point += ", " + like.at("like").get<std::string>();
    value.value = number_of(like.at("median"));
    value.n = like.at("moves").get<std::int64_t>();
    value.comparison->baseline = number_of(like.at("baseline"));
    value.comparison->effect = value.value - value.comparison->baseline;
    values.push_back(std::move(value));
  }
  return values;
}

RunRecord run_of(const Json& answer) {
  RunRecord run;
  const auto baseline = answer.at("baseline").get<std::string>();
  run.study = "monitor of " + baseline;
  const bool grouped = answer.contains("group") && !answer.at("group").is_null();
  run.series_sha256 = hash::sha256_hex(fmt::format(
      "monitor\n{}\n{}\n{}\n{}{}", baseline, answer.at("baseline_moves").dump(), answer.at("block").dump(),
      answer.at("alarm").dump(), grouped ? "\n" + answer.at("group").dump() : ""));
  run.study_sha256 = run.series_sha256;
  run.seed = "1";
  run.trials = answer.at("moves").get<std::int64_t>();
  run.comparison = RunComparison{answer.at("status").get<std::string>(), "monitor", "", ""};
  for (const Json& measure : answer.at("measures")) {
    std::vector<RunValue> values = values_of_likes(answer, measure);
    if (values.empty()) values.push_back(value_of(answer, measure));
    for (RunValue& value : values)
      if (std::isfinite(value.value)) run.values.push_back(std::move(value));
  }
  return run;
}

bool drawn_per_study(const manifest_text::ManifestValues& values, const study::Study& study) {
  return study.worlds > 0 ||  // another seed draws other worlds
         std::any_of(
             values.begin(), values.end(),
             [](const auto& entry) { return entry.first.ends_with(".per") && entry.second == "study"; }) ||
         std::any_of(study.profiles.begin(), study.profiles.end(),
                     [](const study::RealisedProfile& profile) { return !profile.of_machine; });
}

RunValue value_of(const comparison::GateMeasure& measure, const measures::PointSummary& point,
                  const std::string& label) {
  const measures::MeasureStatistics& found = point.of(*measure.measure);
  RunValue value{label, std::string(measure.name), std::string(measure.unit)};
  if (measure.proportion()) {
    value.kind = statistics::MeasurementKind::proportion;
    value.value = found.rate.value;
    value.bounds = found.rate.clopper_pearson;
    value.n = point.judged;
  } else {
    value.value = found.mean;
    value.bounds = found.mean_bounds;
    value.n = found.n;
  }
  return value;
}

RunValue proportion_value(const std::string& label, std::string measure, const goal::BoundedProportion& found,
                          std::int64_t n) {
  RunValue value{label, std::move(measure), "1"};
  value.kind = statistics::MeasurementKind::proportion;
  value.value = found.value;
  value.bounds = {found.low, found.high};
  value.n = n;
  return value;
}

/// The values of one goal at a design point, with two-sided bounds like those of other values. With worlds
/// (draws of what all machines share): the value of the worst world, with the bounds of the lowest of all.
/// @param question a question of this goal alone
/// @param label label of the point
std::vector<RunValue> goal_values(const goal::Question& question, const measures::PointSummary& point,
                                  const std::string& label, double confidence) {
  study::Goal both_sides = *question.goal();
  both_sides.confidence = 0.5 * (1.0 + confidence);
  const measures::CellCounts& counts = point.goals[question.parts.front().number];
  const goal::Verdict verdict = goal::judge_goal(both_sides, counts, 1);
  const auto name = [&](std::string_view measure) {
    return comparison::name_of_goal_measure(measure, both_sides.name);
  };
  std::vector<RunValue> values{
      proportion_value(label, name("goal_rate"), verdict.moves, rate_of(question, point).events)};
  if (goal::is_of_machines(question)) {
    const std::int64_t worlds = std::max<std::int64_t>(question.worlds, 1);
    values.push_back(
        proportion_value(label, name("goal_machines"), verdict.machines, point.machines.n / worlds));
  }
  const statistics::Quantile& p95 = settling_of(question, point).p95;
  RunValue time{label, name("goal_settling_time"), "s"};
  time.value = p95.value;
  time.bounds = {p95.low, p95.high};
  time.n = counts.sum().moves;
  values.push_back(std::move(time));
  return values;
}

/// Appends the values of a summary whose trials are all in one setting.
/// @param setting label of the setting (a condition at an age); empty without settings
void add_values(std::vector<RunValue>& values, const summary::StudySummary& summary,
                const std::string& setting) {
  for (std::size_t i = 0; i < summary.points.size(); ++i) {
    const measures::PointSummary& point = summary.points[i];
    const std::string label = study::label_under(summary.labels[i], setting);
    std::vector<RunValue> of_point;
    for (const goal::JudgedCriterion& part : summary.question.parts) {
      if (!part.goal) continue;  // success is one of the gate measures
      std::ranges::move(goal_values(only(summary.question, part.number), point, label, summary.confidence),
                        std::back_inserter(of_point));
    }
    for (const comparison::GateMeasure& measure : comparison::gate_measures(summary.table()))
      of_point.push_back(value_of(measure, point, label));
    for (RunValue& value : of_point) {
      if (std::isfinite(value.value)) values.push_back(std::move(value));
    }
  }
}

[[noreturn]] void fail_without_values(const std::string& name) {
  throw Failure(
      ExitCode::inconclusive,
      fmt::format("{}: measures nothing that a history keeps: it has torque levels in place of targets, "
                  "or no finite trial; nothing is added",
                  name));
}

}  // namespace

void add_comparison(RunRecord& run, const std::filesystem::path& path) {
  read_answer(path, "compare", "--json' writes", [&](const Json& answer, const std::string&) {
    const std::string of = description_of(answer.at("current"));
    if (of != description_of(run))
      throw Failure(ExitCode::bad_input, fmt::format("{}: compares another run: {}; expected {}",
                                                     yaml::name_of_text(path), of, description_of(run)));
    add(run, answer);
  });
}

std::optional<RunRecord> monitor_record(const std::filesystem::path& path) {
  if (path.extension() != ".json") return std::nullopt;
  RunRecord run;
  read_answer(path, "monitor", "--format json' prints", [&](const Json& answer, const std::string& text) {
    const std::string name = yaml::name_of_text(path);
    if (answer.at("answer") != "monitor")
      throw Failure(
          ExitCode::bad_input,
          fmt::format("{}: is the answer of another command; expected one of 'zerocount monitor'", name));
    run = run_of(answer);
    if (run.values.empty())
      throw Failure(ExitCode::inconclusive, fmt::format("{}: has no moves with values yet", name));
    run.file_sha256 = hash::sha256_hex(text);
    run.created = time_written(path);
  });
  return run;
}

std::string series_sha256(const reading::AllTrialsFile& file) {
  const layout::FileHeader& header = file.header();
  manifest_text::ManifestValues values = layout::manifest_values(header, file.path().string());
  for (const char* const key : {"description", "trials"}) values.erase(key);
  std::erase_if(values,
                [](const auto& entry) { return entry.first.ends_with(manifest_text::order_of_keys); });
  if (!drawn_per_study(values, file.study())) values.erase("seed");
  // A part of the hash since this default was another one: databases have it.
  const parameters::Parameter& beta =
      parameters::parameter_table()[parameters::find_parameter(parameter::friction::beta).value()];
  values["default of friction.beta"] = fmt::format("{}", parameters::default_value(beta));
  std::string text;
  for (const auto& [key, value] : values) text += fmt::format("{}: {}\n", key, value);
  return hash::sha256_hex(text);
}

RunRecord record_of(const reading::AllTrialsFile& file) {
  const std::string name = file.path().string();
  const study::StudyFeatures& features = file.study().features;
  if (features.dependent_trials) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("{}: its trials depend on each other (design: saltelli), so that its bounds are "
                    "too narrow for a history; expected another design",
                    name));
  }
  const layout::FileHeader& header = file.header();
  RunRecord run{{header.name, series_sha256(file), header.study_sha256,
                 storage::recorded_checksum(file.path()), std::to_string(header.seed), header.trials,
                 header.provenance.zerocount_version, header.provenance.git_commit,
                 header.provenance.created}};
  reading::for_each_setting(file, [&](const reading::AllTrialsFile& one, const std::string& setting) {
    add_values(run.values, summary::summarise(one, statistics::summary_confidence, /*bootstrap=*/true),
               setting);
  });
  if (run.values.empty() || features.open_loop) fail_without_values(name);
  return run;
}

}  // namespace zerocount::history
