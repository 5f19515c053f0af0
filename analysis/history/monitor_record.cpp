#include <chrono>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/history/run_record.hpp"
#include "core/failure/failure.hpp"
#include "core/hash/sha256.hpp"
#include "experiments/yaml/text_file.hpp"

namespace zerocount::history {
namespace {

using MonitorJson = nlohmann::json;

constexpr std::size_t max_answer_size = std::size_t{64} << 20U;  ///< bytes

double number_or_unknown(const MonitorJson& value) {
  return value.is_number() ? value.get<double>() : statistics::unknown;
}

/// When the file was written, UTC.
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

RunValue value_of(const MonitorJson& answer, const MonitorJson& measure) {
  RunValue value;
  value.point = answer.at("log").get<std::string>();
  value.measure = measure.at("measure").get<std::string>();
  value.unit = measure.at("unit").get<std::string>();
  value.value = number_or_unknown(measure.at("moves"));
  value.n = answer.at("moves").get<std::int64_t>();
  ValueComparison comparison;
  comparison.verdict = measure.at("alarm_at").is_null() ? "no alarm" : "changed";
  comparison.baseline = number_or_unknown(measure.at("baseline"));
  comparison.effect = value.value - comparison.baseline;
  // Valid at every time: without a change the evidence is ever E or more with a probability of at most 1/E.
  // It is the capital over the number of measures that are watched, so that this holds for the largest of
  // them.
  const double evidence = measure.at("evidence").get<double>();
  comparison.p = evidence > 1.0 ? 1.0 / evidence : 1.0;
  value.comparison = comparison;
  return value;
}

/// The medians of each kind of moves, for a measure whose kinds make several peaks.
std::vector<RunValue> values_of_likes(const MonitorJson& answer, const MonitorJson& measure) {
  std::vector<RunValue> values;
  if (!answer.contains("likes")) return values;
  for (const MonitorJson& like : answer.at("likes")) {
    if (like.at("measure") != measure.at("measure")) continue;
    RunValue value = value_of(answer, measure);
    value.point += ", " + like.at("like").get<std::string>();
    value.value = number_or_unknown(like.at("median"));
    value.n = like.at("moves").get<std::int64_t>();
    value.comparison->baseline = number_or_unknown(like.at("baseline"));
    value.comparison->effect = value.value - value.comparison->baseline;
    values.push_back(std::move(value));
  }
  return values;
}

RunRecord run_of(const MonitorJson& answer) {
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
  for (const MonitorJson& measure : answer.at("measures")) {
    std::vector<RunValue> values = values_of_likes(answer, measure);
    if (values.empty()) values.push_back(value_of(answer, measure));
    for (RunValue& value : values)
      if (std::isfinite(value.value)) run.values.push_back(std::move(value));
  }
  return run;
}

}  // namespace

std::optional<RunRecord> monitor_record(const std::filesystem::path& path) {
  if (path.extension() != ".json") return std::nullopt;
  const std::string name = yaml::name_of_text(path);
  const std::string text = yaml::read_text(path, max_answer_size, "the JSON of 'zerocount monitor'");
  try {
    const MonitorJson answer = MonitorJson::parse(text);
    if (answer.at("answer") != "monitor")
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: is another answer; expected that of 'zerocount monitor'", name));
    RunRecord run = run_of(answer);
    if (run.values.empty())
      throw Failure(ExitCode::inconclusive, fmt::format("{}: has no moves with values yet", name));
    run.file_sha256 = hash::sha256_hex(text);
    run.created = time_written(path);
    return run;
  } catch (const MonitorJson::exception&) {
    throw Failure(
        ExitCode::bad_data,
        fmt::format("{}: is not the JSON that 'zerocount monitor --format json' prints, or is damaged",
                    name));
  }
}

}  // namespace zerocount::history
