#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/acceptance/acceptance.hpp"
#include "analysis/iso230/columns.hpp"
#include "analysis/iso230/repeatability.hpp"
#include "analysis/measures/trial_value.hpp"

namespace zerocount::acceptance {
namespace {

using Sequence = std::span<const study::SequenceMove>;
using Values = std::vector<iso230::AxisRepeatability>;

/// By the encoder, for which the true positions of the moves do not matter.
std::optional<iso230::AxisRepeatability> values_of_run(Sequence sequence,
                                                       std::span<const trial::MoveOutcome> moves) {
  trial::TrialParameters parameters;
  parameters.command.targets.resize(sequence.size());
  const auto values = iso230::trial_repeatability(sequence, parameters, moves);
  return values ? std::optional(values->from_encoder.axis) : std::nullopt;
}

Values simulated_values(const reading::AllTrialsFile& file, std::int64_t point) {
  Values values;
  const Sequence sequence = file.study().sequence;
  measures::visit_trials(file, file.rows_of(point),
                         [&](std::int64_t, std::span<const trial::MoveOutcome> moves) {
                           if (const auto of_trial = values_of_run(sequence, moves))
                             values.push_back(*of_trial);
                         });
  return values;
}

/// The values of each whole run in a log.
void add_measured(Sequence sequence, const monitor::MoveLog& log, Values& values) {
  const std::vector<double>& errors = log.find("final_error")->written;
  std::vector<trial::MoveOutcome> run;
  for (std::size_t row = 0; row < errors.size(); ++row) {
    const std::int64_t number = log.numbers()[row];
    if (number != std::ssize(run) || !std::isfinite(errors[row])) run.clear();
    if (number != std::ssize(run) || !std::isfinite(errors[row])) continue;
    trial::MoveOutcome move;
    move.outcome = trial::Outcome::zero_count;
    move.final_error = std::llround(errors[row]);
    run.push_back(move);
    if (run.size() < sequence.size()) continue;
    if (const auto of_run = values_of_run(sequence, run)) values.push_back(*of_run);
    run.clear();
  }
}

/// Between the values of a sorted sample.
double sample_quantile(const std::vector<double>& sorted, double p) {
  const double place = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

}  // namespace

std::vector<StandardValue> standard_values(const reading::AllTrialsFile& file, std::int64_t point,
                                           std::span<const monitor::MoveLog> logs) {
  const Sequence sequence = file.study().sequence;
  const bool told = std::ranges::all_of(logs, [](const monitor::MoveLog& log) {
    return log.find("final_error") != nullptr && !log.numbers().empty();
  });
  if (sequence.empty() || !told) return {};
  Values measured;
  for (const monitor::MoveLog& log : logs) add_measured(sequence, log, measured);
  if (measured.empty()) return {};
  const Values simulated = simulated_values(file, point);
  std::vector<StandardValue> values;
  for (const auto& field : iso230::axis_fields()) {
    std::vector<double> sorted;
    for (const iso230::AxisRepeatability& one : simulated)
      if (std::isfinite(one.*field.value)) sorted.push_back(one.*field.value);
    if (sorted.empty()) continue;
    std::ranges::sort(sorted);
    StandardValue value{.name = field.name, .symbol = field.symbol};
    value.median = sample_quantile(sorted, 0.5);
    value.low = sample_quantile(sorted, 0.025);
    value.high = sample_quantile(sorted, 0.975);
    for (const iso230::AxisRepeatability& one : measured) {
      value.measured.push_back(one.*field.value);
      value.within += one.*field.value >= value.low && one.*field.value <= value.high ? 1 : 0;
    }
    values.push_back(std::move(value));
  }
  return values;
}

}  // namespace zerocount::acceptance
