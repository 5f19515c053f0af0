#include "tests/benchmarks/peer_agreement.hpp"

#include <algorithm>

#include <fmt/core.h>

#include "experiments/study/study_trial.hpp"

namespace zerocount::testing {
namespace {

/// Index of the first sample at which the trial is seen to have broken away; the number of samples if it
/// never does. A slide may begin and end between two samples; a new contact is recognised because it has lost
/// its hardening.
std::size_t first_breakaway(const std::vector<trial::SampleRecord>& records) {
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (records[i].mode == trial::HookMode::slide) return i;
    if (i > 0 && records[i].xh < records[i - 1].xh) return i;
  }
  return records.size();
}

}  // namespace

std::vector<trial::SampleRecord> reference_records(const trial::TrialParameters& parameters) {
  std::vector<trial::SampleRecord> records;
  trial::TrialObservers observers;
  observers.sample = [&records](const trial::SampleRecord& record) { records.push_back(record); };
  trial::run_trial(parameters, observers);
  return records;
}

bool EngineAgreement::holds() const {
  const std::int64_t trials = calm_trials + broken_trials;
  return trials > 0 && samples.failures.empty() &&
         samples.edge_trials <= std::max<std::int64_t>(1, trials / 50);
}

std::string EngineAgreement::text() const {
  std::string text = fmt::format("{} trials, {} more up to their breakaway: {}", calm_trials, broken_trials,
                                 samples.figures());
  for (const std::string& failure : samples.failures) text += "\n  " + failure;
  return text;
}

EngineAgreement agreement_with_reference(const TrialRecorder& record, const study::Study& study,
                                         std::int64_t calm) {
  EngineAgreement agreement;
  for (std::int64_t index = 0; index < study.trials && agreement.calm_trials < calm; ++index) {
    const trial::TrialParameters parameters = study::study_trial(study, 0, index).parameters;
    std::vector<trial::SampleRecord> reference = reference_records(parameters);
    const std::size_t end = first_breakaway(reference);
    const bool breaks_away = end < reference.size();
    if (breaks_away && agreement.broken_trials == calm) continue;
    ++(breaks_away ? agreement.broken_trials : agreement.calm_trials);
    std::vector<trial::SampleRecord> records = record(parameters);
    reference.resize(end);
    records.resize(std::min(end, records.size()));
    agreement.samples.add(compare(parameters, records, reference, fmt::format("trial {}", index)));
  }
  return agreement;
}

}  // namespace zerocount::testing
