// The cost of a user's control law at a sample, beside the built-in law that it equals.
#include <cmath>
#include <cstdint>
#include <ctime>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/loop/controller/controller.hpp"
#include "core/loop/dac.hpp"
#include "runners/plugins/plugin_library.hpp"
#include "tests/benchmarks/registration.hpp"

namespace zerocount::testing {
namespace {

constexpr double kp = 2e-5;     // N m/count
constexpr double ki = 3.85e-5;  // N m/count
constexpr double zone = 20.0;   // counts
constexpr int samples_per_turn = 20'000;

/// Encoder counts that oscillate about a target; some of them are outside the zone in which the integrator
/// acts.
std::vector<std::int64_t> ringing_counts() {
  std::mt19937_64 random(15);
  std::normal_distribution<double> noise(0.0, 2.0);
  std::vector<std::int64_t> counts;
  for (int k = 0; k < samples_per_turn; ++k)
    counts.push_back(std::llround(25.0 * std::sin(0.05 * k) + noise(random)));
  return counts;
}

loop::ControllerParameters built_in_law() {
  loop::ControllerParameters law;
  law.kp = kp;
  law.ki = ki;
  law.blocks.integrator_zone = zone;
  return law;
}

/// The control law of a plugin library, with the parameters kp, ki and zone.
loop::ControllerParameters law_of(const std::string& library) {
  loop::ControllerParameters law;
  law.user.plugin = std::get<std::shared_ptr<const plugin::ControllerPlugin>>(plugins::load_plugin(library));
  law.user.parameters = {kp, ki, zone};
  return law;
}

/// CPU time of this thread, s.
double thread_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The decisions of a controller in one trial, with the check that each torque is finite.
struct Decisions {
  double seconds{0.0};
  double sum{0.0};  ///< sum of the torques, N m
};

Decisions decide(const loop::ControllerParameters& law, const std::vector<std::int64_t>& counts) {
  const loop::DacParameters dac;
  const loop::TorqueRange range{loop::lowest_torque(dac), loop::highest_torque(dac)};
  loop::Controller controller(law, {}, 0.0, {range, dac.resolution});
  Decisions decisions;
  double torque = 0.0;
  const double begin = thread_time();
  for (const std::int64_t count : counts) {
    torque = controller.update(0, {count, 0}, torque);
    if (!std::isfinite(torque)) break;
    decisions.sum += torque;
  }
  decisions.seconds = thread_time() - begin;
  return decisions;
}

void time_by_turns(benchmark::State& state, const std::string& library, BenchmarkRun& run) {
  const std::vector<std::int64_t> counts = ringing_counts();
  const loop::ControllerParameters built_in = built_in_law();
  const loop::ControllerParameters own = law_of(library);
  double samples = 0.0;
  double seconds_built_in = 0.0;
  double seconds_own = 0.0;
  for (auto _ : state) {
    const Decisions expected = decide(built_in, counts);
    const Decisions given = decide(own, counts);
    if (given.sum != expected.sum) {
      run.failed = true;
      state.SkipWithError("its torques are not those of the built-in law");
      return;
    }
    state.SetIterationTime(given.seconds);
    samples += static_cast<double>(counts.size());
    seconds_built_in += expected.seconds;
    seconds_own += given.seconds;
  }
  count_samples(state, samples);
  state.counters["built_in_ns"] = 1e9 * seconds_built_in / samples;
  state.counters["call_ns"] = 1e9 * (seconds_own - seconds_built_in) / samples;
  state.counters["ratio"] = seconds_own / seconds_built_in;
}

}  // namespace

void register_controller_benchmarks(BenchmarkRun& run) {
  for (const char* example : {"pi_c", "pi_cpp"}) {
    const std::string library = std::string(ZEROCOUNT_EXAMPLE_CONTROLLERS) + "/" + example + ".so";
    benchmark::RegisterBenchmark(
        (std::string("controller/") + example).c_str(),
        [library, &run](benchmark::State& state) { time_by_turns(state, library, run); })
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime();
  }
}

}  // namespace zerocount::testing
