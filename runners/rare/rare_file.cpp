#include "runners/rare/rare_file.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/failure/failure.hpp"
#include "results/hdf5/chunk_transfer.hpp"
#include "results/layout/table_io.hpp"
#include "results/shards/shard.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::rare {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t number_column = 0;
constexpr std::size_t weight_column = 1;
constexpr std::size_t failed_column = 2;
constexpr std::size_t first_coordinate = 3;

/// The table of the trials drawn from the proposal; the inputs come behind the coordinates.
layout::Table drawn_table(const std::vector<randomness::RandomCoordinate>& coordinates,
                          const std::vector<study::InputColumn>& inputs) {
  layout::Table table{"drawn", {"draw", "1", "index of the drawn trial", hdf5::Element::int64}, {}, {}};
  table.columns.push_back({"number", "1",
                           "number from which the random numbers beside the coordinates follow",
                           hdf5::Element::int64});
  table.columns.push_back(
      {"weight", "1", "density of the study's trials over that of the trials drawn here"});
  table.columns.push_back({"failed", "1", "proportion of the moves to which the event happens"});
  for (const randomness::RandomCoordinate& coordinate : coordinates)
    table.columns.push_back(
        {"coordinate/" + coordinate.name, "1", "standard normal number from which the value follows"});
  for (const study::InputColumn& input : inputs)
    table.columns.push_back({"input/" + input.name, input.unit, input.meaning});
  return table;
}

Json state_json(const EstimatorState& state) {
  Json searches = Json::array();
  for (const ScoreSearch& search : state.searches)
    searches.push_back({{"score", search.score},
                        {"reached", search.reached},
                        {"probability", search.probability},
                        {"levels", search.levels},
                        {"trials", search.trials}});
  Json components = Json::array();
  for (const NormalComponent& component : state.proposal.components)
    components.push_back(
        {{"weight", component.weight}, {"mean", component.mean}, {"factor", component.factor}});
  Json values = Json::array();
  for (const PinnedValue& one : state.proposal.values)
    values.push_back({{"draw", one.draw},
                      {"value", one.value},
                      {"weight", one.weight},
                      {"failures", one.failures},
                      {"trials", one.trials}});
  return {{"trials", state.trials},
          {"plain_trials", state.plain_trials},
          {"plain_failures", state.plain_failures},
          {"searches", std::move(searches)},
          {"learned", state.learned},
          {"searched", state.searched},
          {"learnings", state.learnings},
          {"natural", state.proposal.natural},
          {"pinned", state.proposal.pinned},
          {"values", std::move(values)},
          {"components", std::move(components)},
          {"cap", state.cap}};
}

/// Nothing if sizes do not fit.
std::optional<EstimatorState> state_of(const Json& json) {
  EstimatorState state;
  state.trials = json.at("trials").get<std::int64_t>();
  state.plain_trials = json.at("plain_trials").get<std::int64_t>();
  state.plain_failures = json.at("plain_failures").get<std::int64_t>();
  for (const Json& search : json.at("searches"))
    state.searches.push_back({search.at("score").get<std::size_t>(), search.at("reached").get<bool>(),
                              search.at("probability").get<double>(), search.at("levels").get<int>(),
                              search.at("trials").get<std::int64_t>()});
  state.learned = json.at("learned").get<bool>();
  state.searched = json.at("searched").get<std::int64_t>();
  state.learnings = json.at("learnings").get<std::int64_t>();
  state.proposal.natural = json.at("natural").get<double>();
  for (const Json& one : json.at("components")) {
    auto mean = one.at("mean").get<std::vector<double>>();
    auto factor = one.at("factor").get<std::vector<double>>();
    if (factor.size() != mean.size() * mean.size()) return std::nullopt;
    state.proposal.components.push_back(
        normal_component(one.at("weight").get<double>(), std::move(mean), std::move(factor)));
  }
  state.proposal.pinned = json.at("pinned").get<double>();
  for (const Json& one : json.at("values"))
    state.proposal.values.push_back({.draw = one.at("draw").get<std::size_t>(),
                                     .value = one.at("value").get<std::int64_t>(),
                                     .weight = one.at("weight").get<double>(),
                                     .failures = one.at("failures").get<std::int64_t>(),
                                     .trials = one.at("trials").get<std::int64_t>()});
  state.cap = json.at("cap").get<double>();
  return state;
}

bool fits(const RareRecord& record, const Question& question) {
  const std::int64_t changed = std::ssize(question.coordinates) - std::ssize(question.space.unordered);
  const bool components = std::ranges::all_of(
      record.state.proposal.components,
      [&](const NormalComponent& component) { return std::ssize(component.mean) == changed; });
  const bool searches = std::ranges::all_of(record.state.searches, [](const ScoreSearch& search) {
    return search.score < measures::move_scores.size();
  });
  const auto is_one_of = [](const std::optional<std::int64_t>& number, std::int64_t count) {
    return number ? *number >= 0 && *number < count : count == 0;
  };
  const bool world = is_one_of(record.of.world, question.whole.worlds);
  const bool values = std::ranges::all_of(record.state.proposal.values, [&](const PinnedValue& one) {
    return one.draw < question.space.discrete.size() && one.value >= 0 &&
           one.value < question.space.discrete[one.draw].values();
  });
  return components && searches && world && values;
}

/// Completes the pinned values by what follows from the manifest.
void complete_values(std::vector<PinnedValue>& values, const Question& question) {
  for (PinnedValue& one : values) {
    const std::vector<PinnedValue> all = pinned_values(question.space, one.draw);
    const PinnedValue& full = all[static_cast<std::size_t>(one.value)];
    one.rows = full.rows;
    one.probability = full.probability;
  }
}

/// The columns of the drawn trials, [column][row].
std::vector<std::vector<double>> columns_of(const Question& question, const EstimatorState& state,
                                            std::size_t count) {
  std::vector<std::vector<double>> columns(count);
  for (const WeightedTrial& trial : state.drawn) {
    std::size_t next = weight_column;
    columns[next++].push_back(trial.weight);
    columns[next++].push_back(trial.failed);
    for (const double z : trial.point.z) columns[next++].push_back(z);
    for (const double value : trial_at(question, trial.point).inputs) columns[next++].push_back(value);
  }
  return columns;
}

void write_drawn(hdf5::File& file, const Question& question, const EstimatorState& state) {
  const layout::Table table = drawn_table(question.coordinates, question.study.columns.inputs);
  const std::int64_t rows = std::ssize(state.drawn);
  layout::TableIo io = layout::TableIo::create(file, table, rows, 1);
  io.number_rows(0);
  std::vector<std::int64_t> numbers;
  for (const WeightedTrial& trial : state.drawn) numbers.push_back(trial.point.number);
  const std::vector<std::vector<double>> columns = columns_of(question, state, table.columns.size());
  std::vector<hdf5::RowsToWrite> all{{&io.column(number_column), 0, rows, numbers.data()}};
  for (std::size_t i = weight_column; i < columns.size(); ++i)
    all.push_back({&io.column(i), 0, rows, columns[i].data()});
  if (rows > 0) hdf5::write_rows(all);
}

std::vector<WeightedTrial> read_drawn(const hdf5::File& file, const Question& question) {
  const layout::TableIo io = layout::TableIo::open(file, drawn_table(question.coordinates, {}));
  const auto numbers = layout::read_column<std::int64_t>(io, number_column);
  const auto weights = layout::read_column<double>(io, weight_column);
  const auto failed = layout::read_column<double>(io, failed_column);
  std::vector<WeightedTrial> drawn;
  for (std::size_t row = 0; row < numbers.size(); ++row)
    drawn.push_back(
        {{std::vector<double>(question.coordinates.size()), numbers[row]}, weights[row], failed[row]});
  for (std::size_t i = 0; i < question.coordinates.size(); ++i) {
    const auto z = layout::read_column<double>(io, first_coordinate + i);
    for (std::size_t row = 0; row < z.size(); ++row) drawn[row].point.z[i] = z[row];
  }
  return drawn;
}

}  // namespace

void write_rare_file(const std::filesystem::path& path, const Question& question, const EstimatorState& state,
                     double seconds, const Json& answer) {
  const storage::UnfinishedFile part(path);
  hdf5::File file = hdf5::File::create(part.path());
  layout::write_header(
      file, layout::make_header(question.whole, layout::FileKind::rare, layout::all_rows(question.whole),
                                layout::current_provenance()));
  Json estimate{{"point", question.of.point},
                {"world", question.of.world ? Json(*question.of.world) : Json()},
                {"event", question.event.text},
                {"seconds", seconds},
                {"answer", answer},
                {"state", state_json(state)}};
  if (question.of.condition) estimate["condition"] = *question.of.condition;
  layout::write_single_text(file, "estimate", estimate.dump(),
                            "question, answer and state of the estimate, as JSON");
  write_drawn(file, question, state);
  layout::mark_finished(file);
  shards::finish_results(path, file.close());
}

RareRecord read_rare_file(const std::filesystem::path& path) {
  const hdf5::File file = layout::open_results(path);
  RareRecord record;
  record.header = layout::read_rare_header(file);
  const std::optional<std::string> text = layout::read_single_text(file, "estimate");
  if (!text) file.fail("/estimate is missing");
  try {
    const Json estimate = Json::parse(*text);
    record.of.point = estimate.at("point").get<std::int64_t>();
    if (!estimate.at("world").is_null()) record.of.world = estimate.at("world").get<std::int64_t>();
    if (estimate.contains("condition")) record.of.condition = estimate.at("condition").get<std::int64_t>();
    record.event = estimate.at("event").get<std::string>();
    record.seconds = estimate.at("seconds").get<double>();
    std::optional<EstimatorState> state = state_of(estimate.at("state"));
    if (!state) file.fail("/estimate does not fit together");
    record.state = std::move(*state);
  } catch (const Json::exception&) {
    file.fail("/estimate cannot be read");
  }
  const Question question = recorded_question(record, path);
  if (!fits(record, question)) file.fail("/estimate does not fit its manifest");
  complete_values(record.state.proposal.values, question);
  record.state.drawn = read_drawn(file, question);
  return record;
}

bool is_rare_file(const std::filesystem::path& path) {
  return layout::is_rare(layout::open_results(path));
}

Question recorded_question(const RareRecord& record, const std::filesystem::path& path,
                           std::shared_ptr<const plugin::ControllerPlugin> plugin) {
  study::Study study = layout::recorded_study(record.header, path, std::move(plugin));
  if (record.of.point < 0 || record.of.point >= study::point_count(study))
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: damaged: its manifest does not have the point", path.string()));
  const std::int64_t condition = record.of.condition.value_or(0);
  if (record.of.condition.has_value() == study.conditions.empty() || condition < 0 ||
      condition >= study::condition_count(study))
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: damaged: its manifest does not have the condition", path.string()));
  measures::MoveEvent event =
      record.event.empty() ? measures::missed_question(study) : measures::parse_event(study, record.event);
  return question_of(std::move(study), record.of, std::move(event));
}

}  // namespace zerocount::rare
