#include "tests/benchmarks/engines.hpp"

#include <cstdint>
#include <memory>
#include <span>

#include <benchmark/benchmark.h>

#include "core/batch/batch.hpp"
#include "core/loop/encoder.hpp"
#include "tests/benchmarks/peers/peers.hpp"

namespace zerocount::testing {

namespace {

TimedEngine engine_of(const Peer& peer) {
  const auto simulate = [run = peer.run](const Workload& workload) {
    for (const trial::TrialParameters& trial : workload.trials) benchmark::DoNotOptimize(run(trial));
  };
  return {peer.name, simulate, peer.record, 1};
}

constexpr int copies_of_batch = 8;

void simulate_batch(batch::BatchEngine& engine, const Workload& workload) {
  std::vector<const trial::TrialParameters*> trials;
  for (int copy = 0; copy < copies_of_batch; ++copy) {
    for (const trial::TrialParameters& trial : workload.trials) trials.push_back(&trial);
  }
  std::vector<trial::TrialOutcome> outcomes(trials.size());
  engine.run(trials, outcomes);
  benchmark::DoNotOptimize(outcomes.data());
}

/// The records of a trial by the batch engine up to the first breakaway. Later samples are not compared.
std::vector<trial::SampleRecord> batch_records(batch::BatchEngine& engine,
                                               const trial::TrialParameters& trial) {
  const loop::Encoder coarse = loop::coarse_encoder(trial.encoder, trial.initial.encoder_phase);
  const std::int64_t target = trial.command.targets.front();
  std::vector<trial::SampleRecord> records;
  batch::BatchObservers observers;
  observers.sample = [&](const batch::BatchSample& sample) {
    trial::SampleRecord record;
    record.k = sample.k;
    record.t = static_cast<double>(sample.k) / trial.controller.sample_rate;
    record.torque = static_cast<double>(sample.code) * trial.dac.resolution;
    record.drive_torque = record.torque;
    record.target = target;
    record.count = sample.count;
    record.coarse_count = loop::read_count(coarse, sample.theta);
    record.error = target - sample.count;
    record.code = sample.code;
    record.theta = sample.theta;
    record.xp = sample.xp;
    record.xh = sample.xh;
    records.push_back(record);
  };
  const trial::TrialParameters* const trials[] = {&trial};
  trial::TrialOutcome outcome;
  engine.run(trials, std::span(&outcome, 1), observers);
  return records;
}

TimedEngine batch_engine(batch::InstructionSet instructions, const std::string& name) {
  const auto engine =
      std::make_shared<batch::BatchEngine>(batch::BatchSettings{.instructions = instructions});
  return {name, [engine](const Workload& workload) { simulate_batch(*engine, workload); },
          [engine](const trial::TrialParameters& trial) { return batch_records(*engine, trial); },
          copies_of_batch};
}

}  // namespace

std::vector<TimedEngine> all_engines() {
  std::vector<TimedEngine> engines;
  for (const batch::InstructionSet set :
       {batch::InstructionSet::avx512, batch::InstructionSet::avx2, batch::InstructionSet::portable}) {
    if (batch::is_available(set))
      engines.push_back(batch_engine(set, "batch " + std::string(batch::name_of(set))));
  }
  engines.push_back({"reference",
                     [](const Workload& workload) {
                       for (const trial::TrialParameters& trial : workload.trials) {
                         benchmark::DoNotOptimize(trial::run_trial(trial));
                       }
                     },
                     {},
                     1});
  for (const Peer& peer : all_peers()) engines.push_back(engine_of(peer));
  return engines;
}

}  // namespace zerocount::testing
