#include "runners/library/job.hpp"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "analysis/basis/parallel/parallel.hpp"
#include "core/failure/failure.hpp"
#include "core/loop/controller/controller.hpp"
#include "core/plugin/controller_plugin.hpp"
#include "core/trial/trial.hpp"
#include "experiments/randomness/random_variables.hpp"
#include "results/layout/measure_table.hpp"
#include "runners/library/description.hpp"
#include "runners/trials/trial_set.hpp"

namespace zerocount::library {
namespace {

constexpr std::int64_t trials_at_a_time = 64;

/// Replaces the study's control law in the parameters of a trial by the law that the caller of the library
/// gives.
void use_law(trial::TrialParameters& parameters, zerocount_law& law) {
  if (law.size != sizeof law)
    throw Failure(ExitCode::bad_input,
                  fmt::format("zerocount_law has {} bytes; expected {}", law.size, sizeof law));
  if (loop::has_coarse_phase(parameters.controller)) {
    throw Failure(ExitCode::bad_input,
                  "the study has two phases of control, and a law of one's own has one; expected a study "
                  "without controller.coarse");
  }
  plugin::ControllerPlugin plugin{.description = {"a function", "1", "", {}}};
  plugin.start = [&law](const zerocount_setup& setup) -> plugin::StepFunction {
    law.setup = setup;
    return [&law](const zerocount_sample& sample) {
      law.sample = sample;
      return law.step(law.context);
    };
  };
  parameters.controller.user = {std::make_shared<const plugin::ControllerPlugin>(std::move(plugin)), {}};
}

std::vector<std::byte> bytes_of(std::span<const double> numbers) {
  const auto bytes = std::as_bytes(numbers);
  return {bytes.begin(), bytes.end()};
}

auto measures_of(const study::Study& study) {
  return layout::outcome_fields(study.features, layout::measure_table(study.features));
}

}  // namespace

void Result::add(std::string name, hdf5::Element element, std::vector<std::byte> values) {
  columns_.push_back({std::move(name), element, std::move(values)});
}

std::vector<zerocount_array> Result::arrays() const {
  std::vector<zerocount_array> views;
  for (const Column& column : columns_) {
    const auto size = static_cast<std::int64_t>(column.values.size() / hdf5::size_of(column.element));
    views.push_back({column.name.c_str(), type_of(column.element).data(), size, column.values.data()});
  }
  return views;
}

Result simulated(const study::Study& study, std::int64_t point, std::span<const double> values,
                 std::span<const std::int64_t> numbers, int threads, const std::stop_token& stop) {
  const parallel::ThreadLimit limit(threads);
  const randomness::RandomVariables variables = sampled_variables(study, point);
  const std::size_t width = variables.variables.size();
  const auto draw = [&](std::int64_t number) {
    const auto i = static_cast<std::size_t>(number);
    const study::GivenDraws draws =
        randomness::draws_with(study, variables, values.subspan(i * width, width), numbers[i]);
    return study::study_trial(study, point, 0, draws).parameters;
  };
  const std::vector<trial::TrialOutcome> outcomes =
      trials::results_of(std::ssize(numbers), trials_at_a_time, draw, stop,
                         [](const trial::TrialOutcome& outcome) { return outcome; });
  std::vector<const trial::MoveOutcome*> moves;
  for (const trial::TrialOutcome& outcome : outcomes) {
    for (const trial::MoveOutcome& move : outcome.moves) moves.push_back(&move);
  }
  Result result;
  result.add<trial::MoveOutcome>("", measures_of(study), moves);
  return result;
}

Result traced(const study::Study& study, std::int64_t point, std::int64_t index, zerocount_law* law,
              const std::stop_token& stop) {
  study::StudyTrial trial = study::study_trial(study, point, index);
  if (law != nullptr) use_law(trial.parameters, *law);
  std::vector<layout::TraceRecord> samples;
  std::vector<layout::JerkRecord> jerks;
  trial::TrialObservers observers;
  observers.sample = [&](const trial::SampleRecord& record) { samples.push_back({record, 0}); };
  observers.jerk = [&](const trial::Jerk& jerk) { jerks.push_back({jerk, 0}); };
  observers.stop = stop;
  const trial::TrialOutcome outcome = trial::run_trial(trial.parameters, observers);
  Result result;
  result.add("inputs", hdf5::Element::float64, bytes_of(trial.inputs));
  result.add<layout::TraceRecord>("samples/", layout::trace_fields(study.features),
                                  layout::pointers_to(samples));
  result.add<layout::JerkRecord>("jerks/", layout::jerk_fields(), layout::pointers_to(jerks));
  result.add<trial::MoveOutcome>("outcome/", measures_of(study), layout::pointers_to(outcome.moves));
  return result;
}

}  // namespace zerocount::library
