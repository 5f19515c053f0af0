#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/failure/failure.hpp"
#include "results/hdf5/encoded_rows.hpp"
#include "results/layout/table_io.hpp"
#include "results/shards/shard.hpp"
#include "results/storage/durable_file.hpp"
#include "runners/rare/rare_run.hpp"
#include "runners/trials/trial_runner.hpp"

namespace zerocount::rare {

// The members that a file keeps; the others follow from them and from the manifest.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ScoreSearch, score, reached, probability, levels, trials)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PinnedValue, draw, value, weight, failures, trials)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(NormalComponent, weight, mean, factor)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Proposal, natural, pinned, values, components)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EstimatorState, trials, plain_trials, plain_failures, searches, learned,
                                   searched, learnings, proposal, cap)

namespace {

using Json = nlohmann::json;

constexpr std::size_t number_column = 0;
constexpr std::size_t weight_column = 1;
constexpr std::size_t failed_column = 2;
constexpr std::size_t first_coordinate = 3;

/// Description of the table with one row for each trial drawn from the proposal. Its columns of inputs follow
/// those of the coordinates.
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

/// Whether a state that was read from a file can belong to an estimate of this question: its proposal has the
/// question's number of coordinates and its discrete draws, and its scores exist.
bool fits(const EstimatorState& state, const Question& question) {
  const std::size_t changed = question.coordinates.size() - question.space.unordered.size();
  const auto& [natural, pinned, values, components] = state.proposal;
  return std::ranges::all_of(components,
                             [&](const NormalComponent& one) {
                               return one.mean.size() == changed && one.factor.size() == changed * changed;
                             }) &&
         std::ranges::all_of(values,
                             [&](const PinnedValue& one) {
                               return one.draw < question.space.discrete.size() && one.value >= 0 &&
                                      one.value < question.space.discrete[one.draw].values();
                             }) &&
         std::ranges::all_of(state.searches, [](const ScoreSearch& search) {
           return search.score < measures::move_scores.size();
         });
}

/// Completes a proposal that was read from a file, by the values that are not stored: the inverse factors of
/// its normal components, and what the manifest says of its pinned values.
void complete(Proposal& proposal, const Question& question) {
  for (NormalComponent& one : proposal.components)
    one = normal_component(one.weight, std::move(one.mean), std::move(one.factor));
  for (PinnedValue& one : proposal.values) {
    const std::vector<PinnedValue> all = pinned_values(question.space, one.draw);
    const PinnedValue& full = all[static_cast<std::size_t>(one.value)];
    one.rows = full.rows;
    one.probability = full.probability;
  }
}

void write_drawn(hdf5::File& file, const Question& question, const EstimatorState& state) {
  const layout::Table table = drawn_table(question.coordinates, question.study.columns.inputs);
  const std::int64_t rows = std::ssize(state.drawn);
  layout::TableIo io = layout::TableIo::create(file, table, rows, 1);
  io.number_rows(0);
  std::vector<std::int64_t> numbers;
  std::vector<std::vector<double>> columns(table.columns.size());  // [column][row]
  for (const Trial& trial : state.drawn) {
    numbers.push_back(trial.number);
    std::size_t next = weight_column;
    const auto add = [&](double value) { columns[next++].push_back(value); };
    add(trial.weight);
    add(trial.failed);
    std::ranges::for_each(trial.z, add);
    std::ranges::for_each(trial_at(question, trial).inputs, add);
  }
  std::vector<hdf5::RowsToWrite> all{{&io.column(number_column), 0, rows, numbers.data()}};
  for (std::size_t i = weight_column; i < columns.size(); ++i)
    all.push_back({&io.column(i), 0, rows, columns[i].data()});
  if (rows > 0) hdf5::write_rows(all);
}

std::vector<Trial> read_drawn(const hdf5::File& file, const Question& question) {
  const layout::TableIo io = layout::TableIo::open(file, drawn_table(question.coordinates, {}));
  const auto numbers = layout::read_column<std::int64_t>(io, number_column);
  const auto weights = layout::read_column<double>(io, weight_column);
  const auto failed = layout::read_column<double>(io, failed_column);
  std::vector<Trial> drawn;
  for (std::size_t row = 0; row < numbers.size(); ++row)
    drawn.push_back(
        {std::vector<double>(question.coordinates.size()), numbers[row], failed[row], {}, weights[row]});
  for (std::size_t i = 0; i < question.coordinates.size(); ++i) {
    const auto z = layout::read_column<double>(io, first_coordinate + i);
    for (std::size_t row = 0; row < z.size(); ++row) drawn[row].z[i] = z[row];
  }
  return drawn;
}

}  // namespace

void write_rare_file(const RareAnswer& answer) {
  const Question& question = answer.question;
  const std::filesystem::path& path = answer.settings.output;
  const storage::UnfinishedFile part(path);
  hdf5::File file = hdf5::File::create(part.path());
  layout::FileHeader header = layout::make_header(
      question.whole, layout::FileKind::rare, layout::all_rows(question.whole), layout::current_provenance());
  header.engine = trials::engine_that_runs(question.whole);
  layout::write_header(file, header);
  const document::Description<RareAnswer> items = rare_answer().items;
  nlohmann::ordered_json estimate{{"point", question.of.point},
                                  {"world", question.of.world ? Json(*question.of.world) : Json()},
                                  {"event", question.event.text},
                                  {"seconds", answer.seconds},
                                  {"answer", document::json(items.items(), items.members_of(answer))},
                                  {"state", Json(answer.state)}};
  if (question.of.setting) estimate["condition"] = *question.of.setting;
  layout::write_single_text(file, "estimate", estimate.dump(),
                            "question, answer and state of the estimate, as JSON");
  write_drawn(file, question, answer.state);
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
    estimate.at("point").get_to(record.of.point);
    if (!estimate.at("world").is_null()) record.of.world = estimate.at("world").get<std::int64_t>();
    if (estimate.contains("condition")) record.of.setting = estimate.at("condition").get<std::int64_t>();
    estimate.at("event").get_to(record.event);
    estimate.at("seconds").get_to(record.seconds);
    estimate.at("state").get_to(record.state);
  } catch (const Json::exception&) {
    file.fail("/estimate cannot be read");
  }
  const Question question = recorded_question(record, path);
  if (!fits(record.state, question)) file.fail("/estimate does not fit its manifest");
  complete(record.state.proposal, question);
  record.state.drawn = read_drawn(file, question);
  return record;
}

bool is_rare_file(const std::filesystem::path& path) {
  return layout::is_rare(layout::open_results(path));
}

Question recorded_question(const RareRecord& record, const std::filesystem::path& path,
                           std::shared_ptr<const plugin::ControllerPlugin> plugin) {
  study::Study study = layout::recorded_study(record.header, path, std::move(plugin));
  const auto require = [&](std::string_view what, const std::optional<std::int64_t>& number,
                           std::int64_t count) {
    if (number ? *number >= 0 && *number < count : count == 0) return;
    throw Failure(ExitCode::bad_data,
                  fmt::format("{}: damaged: its manifest does not have the {}", path.string(), what));
  };
  require("point", record.of.point, study::point_count(study));
  require("world", record.of.world, study.worlds);
  require("condition", record.of.setting, study.settings.listed());
  measures::MoveEvent event =
      record.event.empty() ? measures::missed_criteria(study) : measures::parse_event(study, record.event);
  return question_of(std::move(study), record.of, std::move(event));
}

}  // namespace zerocount::rare
