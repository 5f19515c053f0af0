// What the encoders, the drive and the random histories give for random parameters, for an independent
// implementation to judge: JSON on standard output. The argument is the number of histories.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <iostream>
#include <random>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/loop/drive.hpp"
#include "core/loop/measurement.hpp"
#include "core/trial/open_loop.hpp"

namespace zerocount {
namespace {

using Json = nlohmann::ordered_json;

class Answers {
 public:
  Json measurement() {
    loop::EncoderParameters encoders;
    if (random_() % 2 == 0) {
      encoders.coarse = std::floor(power_of_ten(1.0, 5.0));
      encoders.fine = std::floor(power_of_ten(1.0, 6.0));
    }
    encoders.fine_errors = errors();
    encoders.coarse_errors = errors();
    const double phase = random_() % 4 == 0 ? 0.0 : uniform(0.0, 1.0);
    const double position = uniform(-7.0, 7.0);
    const random::TrialRandomness randomness = random_randomness();
    loop::Measurement measurement(encoders, phase, position, randomness);

    Json samples = Json::array();
    const std::int64_t first = first_sample();
    const double pace = measurement.fine_resolution() * power_of_ten(-1.0, 2.5);
    double theta = 0.0;
    for (std::int64_t k = first; k < first + 150; ++k) {
      const loop::EncoderReading reading = measurement.read(k, theta);
      samples.push_back({k, theta, reading.fine, reading.coarse, measurement.disagreements()});
      theta += random_() % 20 == 0 ? uniform(-1.0, 1.0) : pace * uniform(-0.8, 1.0);
    }
    return {
        {"fine", encoder(encoders.fine, encoders.fine_errors, randomness.fine_noise, randomness.fine_missed)},
        {"coarse",
         encoder(encoders.coarse, encoders.coarse_errors, randomness.coarse_noise, randomness.coarse_missed)},
        {"phase", phase},
        {"position", position},
        {"trial", randomness.trial},
        {"stream", randomness.stream},
        {"samples", samples}};
  }

  Json drive() {
    loop::DacParameters dac;
    dac.bits = static_cast<int>(4 + random_() % 13);
    dac.resolution = power_of_ten(-5.0, -2.0);
    dac.offset = sometimes(uniform(-0.1, 0.1));
    dac.gain_error = sometimes(uniform(-0.1, 0.1));
    dac.nonlinearity = sometimes(uniform(-3.0, 3.0));
    dac.noise = sometimes(power_of_ten(-5.0, -1.0));
    const loop::AmplifierParameters amplifier{sometimes(power_of_ten(0.0, 4.0))};
    const int delay = static_cast<int>(random_() % 4);
    const double sample_time = power_of_ten(-5.0, -2.0);
    const bool exact = random_() % 4 == 0;
    const random::TrialRandomness randomness = random_randomness();
    loop::Drive drive(dac, amplifier, delay, sample_time, randomness);

    Json samples = Json::array();
    const std::int64_t first = first_sample();
    const double range = dac.resolution * std::exp2(dac.bits - 1);
    for (std::int64_t k = first; k < first + 40; ++k) {
      const double wanted = uniform(-1.1, 1.1) * range;
      const loop::DacOutput decided = loop::convert(dac, wanted);
      exact ? drive.send_exact(wanted) : drive.send(k, decided);
      const motion::TorqueCourse course = drive.pieces().front().course;
      samples.push_back({k, wanted, decided.code, course.now, course.settled, course.rate});
    }
    return {{"bits", dac.bits},
            {"resolution", dac.resolution},
            {"offset", dac.offset},
            {"gain_error", dac.gain_error},
            {"nonlinearity", dac.nonlinearity},
            {"noise", dac.noise},
            {"bandwidth", amplifier.bandwidth},
            {"delay", delay},
            {"sample_time", sample_time},
            {"exact", exact},
            {"key", randomness.dac_noise},
            {"trial", randomness.trial},
            {"stream", randomness.stream},
            {"samples", samples}};
  }

  Json history() {
    const trial::RandomHistory history{static_cast<int>(random_() % 20), power_of_ten(-3.0, 1.0)};
    const random::TrialRandomness randomness = random_randomness();
    return {{"reversals", history.reversals}, {"torque", history.torque},
            {"key", randomness.history},      {"trial", randomness.trial},
            {"stream", randomness.stream},    {"levels", trial::draw_history(history, randomness)}};
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double power_of_ten(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  double sometimes(double value) { return random_() % 2 == 0 ? value : 0.0; }
  std::int64_t first_sample() {
    return random_() % 2 == 0 ? 0 : static_cast<std::int64_t>(random_() % ((std::uint64_t{1} << 40) - 200));
  }

  loop::EncoderErrors errors() {
    loop::EncoderErrors errors;
    errors.eccentricity = sometimes(power_of_ten(-6.0, -2.0));
    errors.eccentricity_angle = uniform(-7.0, 7.0);
    errors.interpolation = sometimes(power_of_ten(-1.0, 1.0));
    errors.interpolation_period = random_() % 2 == 0 ? 4.0 : uniform(0.5, 100.0);
    errors.noise = sometimes(power_of_ten(-1.0, 1.0));
    errors.missed = sometimes(power_of_ten(-3.0, 0.0));
    return errors;
  }

  random::RandomKey random_key() {
    return {static_cast<std::uint32_t>(random_()), static_cast<std::uint32_t>(random_())};
  }

  random::TrialRandomness random_randomness() {
    random::TrialRandomness randomness;
    randomness.trial = random_() >> (11 + random_() % 40);
    randomness.stream = static_cast<std::uint32_t>(random_() >> (32 + random_() % 32));
    for (random::RandomKey* key :
         {&randomness.history, &randomness.fine_noise, &randomness.fine_missed, &randomness.coarse_noise,
          &randomness.coarse_missed, &randomness.dac_noise})
      *key = random_key();
    return randomness;
  }

  static Json encoder(double counts, const loop::EncoderErrors& errors, const random::RandomKey& noise,
                      const random::RandomKey& missed) {
    return {{"counts", counts},
            {"eccentricity", errors.eccentricity},
            {"eccentricity_angle", errors.eccentricity_angle},
            {"interpolation", errors.interpolation},
            {"interpolation_period", errors.interpolation_period},
            {"noise", errors.noise},
            {"missed", errors.missed},
            {"noise_key", noise},
            {"missed_key", missed}};
  }

  std::mt19937_64 random_{2002};
};

void print(int histories) {
  Answers answers;
  Json all{{"measurement", Json::array()}, {"drive", Json::array()}, {"history", Json::array()}};
  for (int i = 0; i < 2 * histories; ++i) all["measurement"].push_back(answers.measurement());
  for (int i = 0; i < 3 * histories / 2; ++i) all["drive"].push_back(answers.drive());
  for (int i = 0; i < histories; ++i) all["history"].push_back(answers.history());
  std::cout << all << "\n";
}

}  // namespace
}  // namespace zerocount

int main(int, char** arguments) {
  zerocount::print(std::atoi(arguments[1]));
}
