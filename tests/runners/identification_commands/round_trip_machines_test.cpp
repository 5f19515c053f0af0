// The round trip of docs/round-trip.md with many machines that share no code with the simulation: another
// integrator, another spring, another controller. How often does the prediction hold what they do?
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/loop/encoder.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/runners/program.hpp"
#include "tests/support/draws.hpp"
#include "tests/support/stop_elements.hpp"

namespace zerocount::testing {
namespace {

constexpr double sample_time = 5e-4;                             // s
constexpr double resolution = 2.0 * std::numbers::pi / 1620000;  // rad per count
constexpr double hold = 0.15;                                    // s
constexpr std::int64_t moves = 40;

/// A rotor on elastic-plastic elements in place of the exponential spring, with creep (paper, eq. 2) and
/// damping. Kicks of the torque, with the damping in closed form, alternate with drifts (Strang splitting).
class ElementMachine {
 public:
  /// @param phase phase of the encoder, counts
  ElementMachine(const trial::TrialParameters& machine, double phase)
      : plant_(machine.plant),
        friction_(machine.friction.uniform),
        elements_(machine.friction.uniform, 12),
        phase_(phase) {}

  /// Applies the torque (N m) to the machine for one sample time.
  void advance(double torque) {
    constexpr int steps = 40;
    constexpr double step = sample_time / steps;
    for (int i = 0; i < steps; ++i) {
      kick(torque, 0.5 * step);
      theta_ += omega_ * step;
      creep(step);
      elements_.move_to(theta_ - creep_);
      kick(torque, 0.5 * step);
    }
    slid_ = slid_ || std::abs(elements_.torque()) > friction_.breakaway;
  }

  /// The reading of the encoder, counts, with this additional error (counts).
  std::int64_t count(double error) const {
    return static_cast<std::int64_t>(std::floor(theta_ / resolution + phase_ + error));
  }
  bool slid() const { return slid_; }

 private:
  void kick(double torque, double time) {
    const double c = plant_.presliding_damping;
    const double settled = (torque - elements_.torque()) / c;
    omega_ = settled + (omega_ - settled) * std::exp(-c / plant_.inertia * time);
  }
  void creep(double time) {
    const double sigma = elements_.torque();
    const double limit = std::pow(std::abs(sigma), friction_.n) / friction_.lambda;
    const double hardening = friction_.alpha * std::max(limit - hardening_, 0.0) * time;
    hardening_ += hardening;
    creep_ += std::copysign(hardening, sigma);
  }

  motion::PlantParameters plant_;
  friction::FrictionParameters friction_;
  StopElements elements_;
  double phase_;           // counts
  double theta_{0.0};      // rad
  double omega_{0.0};      // rad/s
  double creep_{0.0};      // xp, rad
  double hardening_{0.0};  // xh, rad
  bool slid_{false};
};

/// Gains of a PI control, N m/rad and N m/(rad s).
struct Gains {
  double kp;
  double ki;
};

/// The noise of an encoder; its standard deviation is in counts.
struct EncoderNoise {
  double deviation;
  Draws* draw;
  double next() const { return deviation > 0.0 ? deviation * draw->normal() : 0.0; }
};

/// Whether a move by `target` counts ends at zero error, under a PI control with a delay of one sample.
bool succeeds(ElementMachine machine, const EncoderNoise& noise, const Gains& gains, std::int64_t target) {
  const double torque_per_code = loop::DacParameters{}.resolution;
  const auto samples = static_cast<int>(std::lround(hold / sample_time));
  constexpr int window = 100;  // samples
  double integral = 0.0;
  std::int64_t last_error = 0;
  double waiting = 0.0;
  bool zero = true;
  for (int k = 0; k < samples; ++k) {
    const std::int64_t error = target - machine.count(noise.next());
    if (k >= samples - window && error != 0) zero = false;
    integral += gains.ki * resolution * 0.5 * sample_time * static_cast<double>(error + last_error);
    last_error = error;
    const double wanted = integral + gains.kp * resolution * static_cast<double>(error);
    machine.advance(waiting);
    waiting = torque_per_code * std::nearbyint(wanted / torque_per_code);
  }
  return zero && !machine.slid();
}

const std::string guesses =
    "zerocount: 1\nname: guesses\nseed: 11\ntrials: 100\n"
    "plant: {inertia: {lognormal: {median: 5.5e-4, cv: 0.2}},\n"
    "  presliding_damping: {lognormal: {median: 0.2, cv: 0.3}}}\n"
    "friction: {k1: {lognormal: {median: 110, cv: 0.3}}, k2: {lognormal: {median: 750, cv: 0.3}},\n"
    "  beta: {lognormal: {median: 1.0e+5, cv: 0.3}}, alpha: {lognormal: {median: 0.5, cv: 0.3}},\n"
    "  lambda: {lognormal: {median: 10, cv: 0.3}}, breakaway: {uniform: [0.25, 0.4]}}\n"
    "encoder: {fine: 1620000}\ncommand: {targets: [0]}\ninitial: {encoder_phase: {uniform: [0, 1]}}\n";

/// Comparison of a machine's moves with their prediction.
struct Comparison {
  bool consistent;    ///< the rank test at the level 5 % does not reject the prediction
  bool misfit;        ///< `identify` reports a lack of fit
  double difference;  ///< predicted − measured success rate
};

/// Summary of the comparisons of several machines.
struct Agreement {
  int consistent{0};
  int misfits{0};
  /// Root mean square of the differences between predicted and measured success rate.
  double difference{0.0};
};

class RoundTrip : public ProgramTest {
 protected:
  RoundTrip() : study_(manifest::parse_study(guesses, "guesses.yaml")) {
    folder_.write("guesses.yaml", guesses);
    const ProgramResult designed = program({"experiment", "guesses.yaml", "--duration", "1.5", "--budget",
                                            "4", "--machines", "8", "-o", "torque.csv", "--quiet"});
    EXPECT_EQ(designed.code, 0) << designed.err;
    std::istringstream lines(folder_.read("torque.csv"));
    std::string line;
    std::getline(lines, line);  // the header
    while (std::getline(lines, line)) torques_.push_back(std::stod(line.substr(line.find(',') + 1)));
  }

  /// The record of the identification protocol on a machine, as a table for `identify`: the torque and the
  /// counts of the machine.
  std::string record_of(ElementMachine machine, const EncoderNoise& noise) const {
    std::string table = "t [s],torque [N m],count\n";
    for (std::size_t k = 0; k < torques_.size(); ++k) {
      table += fmt::format("{},{},{}\n", static_cast<double>(k) * sample_time, torques_[k],
                           machine.count(noise.next()));
      machine.advance(torques_[k]);
    }
    EXPECT_FALSE(machine.slid());
    return table;
  }

  /// Compares the machine's moves with the success rate that is predicted from its record.
  Comparison comparison(const trial::TrialParameters& machine, const Gains& gains, double deviation,
                        Draws& draw) {
    const EncoderNoise noise{deviation, &draw};
    const auto started = [&] { return ElementMachine(machine, draw.uniform(0.0, 1.0)); };
    folder_.write("recorded.csv", record_of(started(), noise));
    const ProgramResult identified =
        program({"identify", "recorded.csv", "--counts-per-revolution", "1620000", "--posterior",
                 "posterior.csv", "--force", "--quiet"});
    EXPECT_TRUE(identified.code == 0 || identified.code == 3) << identified.err;  // 3: a lack of fit
    std::int64_t successes = 0;
    for (std::int64_t i = 0; i < moves; ++i) {
      const std::int64_t target = draw.integer(1, 30);
      successes += succeeds(started(), noise, gains, target) ? 1 : 0;
    }
    folder_.write(
        "study.yaml",
        fmt::format("zerocount: 1\nname: study\nseed: 1\nmachines: 100\ntrials: {}\n"
                    "samples: posterior.csv\nencoder: {{fine: 1620000, fine_errors: {{noise: {}}}}}\n"
                    "controller: {{units: si, sample_rate: 2000, delay: 1, kp: {}, ki: {}}}\n"
                    "command: {{targets: [{{integers: [1, 30]}}], hold: {}}}\n"
                    "initial: {{encoder_phase: {{uniform: [0, 1]}}}}\n"
                    "observed: {{all: {{successes: {}, of: {}}}}}\n",
                    100 * moves, deviation, gains.kp, gains.ki, hold, successes, moves));
    const ProgramResult run = program({"run", "study.yaml", "-o", "predicted.h5", "--force", "--quiet"});
    EXPECT_EQ(run.code, 0) << run.err;
    const auto summary = nlohmann::json::parse(program({"summary", "predicted.h5", "--format", "json"}).out);
    const nlohmann::json& point = summary["points"][0];
    return {point["observed_counts"]["verdict"] == "consistent", identified.code == 3,
            point["success_rate"].get<double>() - static_cast<double>(successes) / moves};
  }

  /// Compares several random machines with their predictions.
  /// @param deviation standard deviation of the encoder's noise, counts
  Agreement agreement_of(std::int64_t machines, double deviation = 0.0) {
    Draws draw(5);
    Agreement sum;
    for (std::int64_t i = 0; i < machines; ++i) {
      const Comparison found =
          comparison(study::study_trial(study_, 0, i).parameters, {74.0, 6e4}, deviation, draw);
      sum.consistent += found.consistent ? 1 : 0;
      sum.misfits += found.misfit ? 1 : 0;
      sum.difference += found.difference * found.difference / static_cast<double>(machines);
    }
    sum.difference = std::sqrt(sum.difference);
    fmt::print("noise {}: of {} machines {} are consistent, {} have a lack of fit; difference {:.3f}\n",
               deviation, machines, sum.consistent, sum.misfits, sum.difference);
    return sum;
  }

  study::Study study_;
  std::vector<double> torques_;  // [sample] of the protocol, N m
};

// The interval is that of 95 %. At these gains some machines always succeed, and others in a third of their
// moves.
TEST_F(RoundTrip, PredictionsContainTheRatesOfMachines) {
  EXPECT_GE(agreement_of(3).consistent, 2);
}

TEST_F(RoundTrip, DISABLED_PredictionsContainTheRatesOfNoisyMachines) {
  for (const double noise : {0.03, 0.1}) EXPECT_GE(agreement_of(60, noise).consistent, 54) << noise;
}

TEST_F(RoundTrip, DISABLED_PredictionsContainTheRatesOfManyMachines) {
  EXPECT_GE(agreement_of(20).consistent, 18);
  const Agreement many = agreement_of(100);
  EXPECT_GE(many.consistent, 90);
  EXPECT_LE(many.misfits, 5);
  EXPECT_LE(many.difference, 0.08);
}

}  // namespace
}  // namespace zerocount::testing
