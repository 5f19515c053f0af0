#include "runners/tuning/search/tuning_journal.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/failure/failure.hpp"

namespace zerocount::tuning {
namespace {

using Json = nlohmann::ordered_json;

/// JSON of one machine's result: [slid, claim, …]. Each claim (goal in a setting) is [moves, met, value, …];
/// null stands for an infinite value.
Json json_of(const MachineResult& machine) {
  Json json = Json::array({machine.slid});
  for (const ClaimResult& claim : machine.claims) {
    Json& one = json.emplace_back(Json::array({claim.moves, claim.met}));
    for (const double value : claim.values) one.push_back(value);
  }
  return json;
}

ClaimResult claim_of(const Json& json) {
  ClaimResult claim{json.at(0).get<std::int32_t>(), json.at(1).get<std::int32_t>(), {}};
  for (std::size_t i = 2; i < json.size(); ++i)
    claim.values.push_back(json[i].is_null() ? std::numeric_limits<double>::infinity()
                                             : json[i].get<double>());
  return claim;
}

MachineResult machine_of(const Json& json) {
  MachineResult machine{.claims = {}, .slid = json.at(0).get<bool>()};
  for (std::size_t i = 1; i < json.size(); ++i) machine.claims.push_back(claim_of(json[i]));
  return machine;
}

std::string header_of(const std::string& tuning) {
  return Json{{"zerocount_tuning", 3}, {"tuning", tuning}}.dump();
}

}  // namespace

std::filesystem::path journal_path(const std::filesystem::path& output) {
  return output.string() + ".tuning";
}

std::string interruption_text(const std::filesystem::path& output) {
  const std::filesystem::path journal = journal_path(output);
  std::error_code error;
  if (!std::filesystem::exists(journal, error))
    return "interrupted before a point was simulated: nothing is kept; give the same command again";
  return fmt::format(
      "interrupted: the simulated points are kept in {}; give the same command again to continue",
      journal.string());
}

TuningJournal::TuningJournal(std::filesystem::path path, const std::string& tuning, bool replace)
    : path_(std::move(path)) {
  std::error_code error;
  header_ = header_of(tuning);
  if (std::filesystem::exists(path_, error)) {
    std::ifstream file(path_);
    std::string line;
    resumed_ = std::getline(file, line) && line == header_;
    if (!resumed_ && !replace) {
      throw Failure(
          ExitCode::bad_input,
          fmt::format("{}: is the unfinished tuning of another study, or by another build; expected "
                      "another FILE, or --force to replace it",
                      path_.string()));
    }
    while (resumed_ && std::getline(file, line)) read_line(line);
    torn_ = resumed_;
  }
  if (!resumed_) remove();
}

/// Reads a line of the journal, the file from which an interrupted tuning resumes. Incomplete lines are
/// skipped: a killed run may leave one, whose evaluation is then made again.
void TuningJournal::read_line(const std::string& line) {
  const Json json = Json::parse(line, nullptr, false);
  if (json.is_discarded()) return;
  try {
    if (json.contains("speed")) {
      speed_ = json.at("speed").get<double>();
      return;
    }
    std::vector<MachineResult>& known = known_[{json.at("search"), json.at("values").get<Values>()}];
    if (json.at("from").get<std::size_t>() != known.size()) return;
    for (const Json& machine : json.at("units")) known.push_back(machine_of(machine));
    seconds_ = json.at("seconds");
  } catch (const Json::exception&) {
    return;
  }
}

void TuningJournal::take(const std::string& search, const Values& values, std::int64_t from, std::int64_t to,
                         std::vector<MachineResult>& machines) {
  const auto known = known_.find({search, values});
  if (known == known_.end()) return;
  for (std::int64_t i = from; i < std::min(to, std::ssize(known->second)); ++i)
    machines.push_back(std::move(known->second[static_cast<std::size_t>(i)]));
}

void TuningJournal::add(std::span<const std::string> evaluations) {
  if (!evaluations.empty()) append(evaluations);
}

void TuningJournal::keep_speed(double speed) {
  const std::string line = Json{{"speed", speed}}.dump();
  if (!speed_) append({&line, 1});
  speed_ = speed;
}

void TuningJournal::append(std::span<const std::string> lines) {
  if (path_.empty()) return;
  errno = 0;
  std::ofstream file(path_, std::ios::app);
  // A line break first ends the part of a line that a killed run may have left.
  file << (std::exchange(torn_, false) ? "\n" : "");
  if (!resumed_ && !begun_) file << header_ << '\n';
  for (const std::string& line : lines) file << line << '\n';
  file << std::flush;
  begun_ = true;
  if (file) return;
  throw Failure(ExitCode::machine_failed,
                fmt::format("{}: cannot be written: {}", path_.string(),
                            std::error_code(errno, std::generic_category()).message()));
}

void TuningJournal::remove() {
  if (path_.empty()) return;
  std::error_code error;
  std::filesystem::remove(path_, error);
}

std::string evaluation_line(const std::string& search, const Values& values, std::int64_t from,
                            std::span<const MachineResult> machines, double seconds) {
  Json json{{"search", search}, {"values", values}, {"from", from}, {"units", Json::array()}};
  for (const MachineResult& machine : machines) json["units"].push_back(json_of(machine));
  json["seconds"] = seconds;
  return json.dump();
}

}  // namespace zerocount::tuning
