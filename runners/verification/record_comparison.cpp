#include <array>
#include <cstddef>
#include <cstdint>
#include <stop_token>

#include <fmt/format.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include "core/batch/batch.hpp"
#include "core/trial/trial.hpp"
#include "results/layout/fields.hpp"
#include "results/layout/layout.hpp"
#include "runners/trials/trial_runner.hpp"
#include "runners/verification/replay.hpp"

namespace zerocount::verification {
namespace {

/// Encoder count and code of the digital-to-analogue converter in a loop at one sample.
struct LoopSample {
  std::int64_t count{0};
  std::int64_t code{0};
  bool operator==(const LoopSample&) const = default;
};

std::vector<LoopSample> samples_in_lanes(const trial::TrialParameters& parameters) {
  std::vector<LoopSample> samples;
  batch::BatchObservers observers;
  observers.sample = [&](const batch::BatchSample& sample) {
    samples.push_back({sample.count, sample.code});
  };
  const std::array trials{&parameters};
  std::array<trial::TrialOutcome, 1> outcomes;
  batch::BatchEngine({.lanes = 1}).run(trials, outcomes, observers);
  return samples;
}

}  // namespace

std::string text_of(const Parting& parting) {
  return fmt::format("from t = {:.6g} s on (sample {})", parting.time, parting.sample);
}

std::optional<Parting> parting_of_engines(const trial::TrialParameters& parameters) {
  const std::vector<LoopSample> in_lanes = samples_in_lanes(parameters);
  std::optional<Parting> parting;
  std::stop_source parted;
  trial::TrialObservers observers;
  observers.stop = parted.get_token();
  observers.sample = [&](const trial::SampleRecord& sample) {
    const auto k = static_cast<std::size_t>(sample.k);
    if (parting || (k < in_lanes.size() && in_lanes[k] == LoopSample{sample.count, sample.code})) return;
    parting = {sample.k, sample.t};
    parted.request_stop();
  };
  try {
    trial::run_trial(parameters, observers);
  } catch (const trial::Interrupted&) {  // the rest is not needed
  }
  return parting;
}

TracedTrial compare_with_record(const reading::ResultsFile& file, const study::Study& study,
                                const shards::TrialResult& traced) {
  const layout::RowRange row{traced.row, 1};
  const std::vector<shards::TrialResult> again = trials::TrialRunner(study).run(row);
  TracedTrial result{differences_from_record(file, again.front(), equality_of(file.header())), std::nullopt};
  if (result.differences.empty() && !differences_from_record(file, traced, Equality::rounded).empty())
    result.parting = parting_of_engines(
        study::study_trial(study, traced.row / study.trials, traced.row % study.trials).parameters);
  return result;
}

}  // namespace zerocount::verification
