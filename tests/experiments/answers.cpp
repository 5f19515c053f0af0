// Prints, as JSON, what the judges in Python compare with their own computation.

#include <iostream>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/trial/open_loop.hpp"
#include "experiments/distributions/distribution_forms.hpp"
#include "experiments/manifest/json_schema.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"

namespace zerocount {
namespace {

using Json = nlohmann::ordered_json;

// [{name, numbers, quantiles: [[u, x], …]}, …]
Json distributions() {
  const std::vector<std::pair<std::string, std::vector<double>>> examples{
      {"uniform", {600, 900}},
      {"log_uniform", {0.1, 2}},
      {"normal", {-3, 2}},
      {"truncated_normal", {110, 15, 90, 130}},
      {"truncated_normal", {0, 1, 4, 6}},
      {"truncated_normal", {0, 1, -6, -4}},
      {"lognormal", {2e5, 0.2}},
      {"lognormal", {1, 2}},
      {"triangular", {0.25, 0.3, 0.35}},
      {"integers", {-4, 30}},
  };
  Json all = Json::array();
  for (const auto& [name, numbers] : examples) {
    for (const distributions::DistributionForm& form : distributions::distribution_forms()) {
      if (form.name != name) continue;
      Json quantiles = Json::array();
      for (const double u : {1e-12, 1e-6, 0.01, 0.123, 0.5, 0.77, 0.99, 1 - 1e-6})
        quantiles.push_back({u, distributions::quantile(form.make(numbers), u)});
      all.push_back({{"name", name}, {"numbers", numbers}, {"quantiles", quantiles}});
    }
  }
  return all;
}

Json key_json(const random::RandomKey& key) {
  return {key[0], key[1]};
}

// Where a trial's own random numbers come from.
Json randomness_json(const random::TrialRandomness& r) {
  return {{"trial", r.trial},
          {"stream", r.stream},
          {"initial.history/levels", key_json(r.history)},
          {"encoder.fine_errors.noise/samples", key_json(r.fine_noise)},
          {"encoder.fine_errors.missed/samples", key_json(r.fine_missed)},
          {"encoder.coarse_errors.noise/samples", key_json(r.coarse_noise)},
          {"encoder.coarse_errors.missed/samples", key_json(r.coarse_missed)},
          {"dac.noise/samples", key_json(r.dac_noise)}};
}

// Draws of a study with two parameters that are uniform on [1, 2), for each design: value − 1 is the uniform
// number.
Json draws() {
  Json all = Json::array();
  for (const char* design : {"monte_carlo", "latin_hypercube", "sobol", "saltelli"}) {
    for (const char* independent : {"false", "true"}) {
      const study::Study study = study_of(
          minimal_manifest("friction: {k1: {uniform: [1, 2]}}\ninitial: {position: {uniform: [1, 2]}}\n"),
          {"seed=20020721", "trials=5000000000", std::string("design=") + design,
           std::string("independent_points=") + independent, "sweep={grid: {controller.ki: [0, 1, 2]}}"});
      for (const std::int64_t trial : {0L, 1L, 2L, 999L, 4'999'999'999L}) {
        for (const std::int64_t point : {0L, 2L}) {
          const study::StudyTrial drawn = study::study_trial(study, point, trial);
          const std::vector<double>& inputs = drawn.inputs;
          all.push_back({{"design", design},
                         {"randomness", randomness_json(drawn.parameters.randomness)},
                         {"independent", study.independent_points},
                         {"seed", study.seed},
                         {"trials", study.trials},
                         {"point", point},
                         {"trial", trial},
                         {"friction.k1", inputs[column_of(study, "friction.k1")] - 1},
                         {"initial.position", inputs[column_of(study, "initial.position")] - 1}});
        }
      }
    }
  }
  return all;
}

// Draws of a study with machines, whose uniform parameters are on [1, 2), less 1: what is drawn for the
// machine, the study, the trial, and contacts 0 to 3 of the trial; and the rotor of a profile.
Json machine_draws() {
  Json all = Json::array();
  for (const char* independent : {"false", "true"}) {
    const study::Study study = study_of(
        minimal_manifest("friction:\n"
                         "  k1: {profile: {mean: {uniform: [1, 2]}, cv: 0.1, correlation_length: 0.7}}\n"
                         "  k2: {uniform: [1, 2]}\n"
                         "  beta: {uniform: [1, 2], per: study}\n"
                         "  lambda: {uniform: [1, 2], per: contact}\n"
                         "initial: {position: {uniform: [1, 2]}}\n"),
        {"seed=20020721", "machines=1000000", "trials=5000000000",
         std::string("independent_points=") + independent, "sweep={grid: {controller.ki: [0, 1]}}"});
    for (const std::int64_t trial : {0L, 1L, 1'000'001L, 4'999'999'999L}) {
      const study::StudyTrial drawn = study::study_trial(study, 1, trial);
      const auto input = [&](const char* name) { return drawn.inputs[column_of(study, name)] - 1; };
      const friction::FrictionAlongRotor& friction = drawn.parameters.friction;
      Json contacts = Json::array();
      for (const std::int64_t k : {0, 1, 2, 3})
        contacts.push_back(friction::friction_at(friction, 0.0, k).lambda - 1);
      const friction::Profile& rotor = *friction.profiled.at(0).profile;
      all.push_back({{"seed", study.seed},
                     {"machines", study.machines},
                     {"trial", trial},
                     {"stream", study.independent_points ? 2 : 0},
                     {"friction.k1.profile.mean", input("friction.k1.profile.mean")},
                     {"friction.k2", input("friction.k2")},
                     {"friction.beta", input("friction.beta")},
                     {"initial.position", input("initial.position")},
                     {"friction.lambda", contacts},
                     {"correlation_length", 0.7},
                     {"cosine", rotor.cosine},
                     {"sine", rotor.sine}});
    }
  }
  return all;
}

// Random histories as trials draw them: [{seed, trial, stream, reversals, torque, levels}, …]
Json histories() {
  Json all = Json::array();
  for (const char* independent : {"false", "true"}) {
    const study::Study study =
        study_of(minimal_manifest(
                     "initial: {history: {reversals: {integers: [1, 9]}, torque: {uniform: [0.1, 0.2]}}}\n"),
                 {"seed=20020721", "trials=5000000000", std::string("independent_points=") + independent,
                  "sweep={grid: {controller.ki: [0, 1]}}"});
    for (const std::int64_t trial : {0L, 1L, 17L, 4'999'999'999L}) {
      const trial::TrialParameters p = study::study_trial(study, 1, trial).parameters;
      all.push_back({{"seed", study.seed},
                     {"trial", trial},
                     {"stream", study.independent_points ? 2 : 0},
                     {"reversals", p.initial.history.reversals},
                     {"torque", p.initial.history.torque},
                     {"levels", trial::draw_history(p.initial.history, p.randomness)}});
    }
  }
  return all;
}

// {column: [value of trial 0, 1, …]} at the first point of the manifest on the standard input.
Json inputs() {
  const study::Study study = study_of({std::istreambuf_iterator<char>(std::cin), {}});
  Json all = Json::object();
  for (std::int64_t trial = 0; trial < study.trials; ++trial) {
    const std::vector<double> values = study::study_trial(study, 0, trial).inputs;
    for (std::size_t i = 0; i < values.size(); ++i) all[study.columns.inputs[i].name].push_back(values[i]);
  }
  return all;
}

int answer(const std::string& question) {
  if (question == "distributions") {
    std::cout << distributions().dump() << '\n';
  } else if (question == "draws") {
    std::cout << draws().dump() << '\n';
  } else if (question == "machine_draws") {
    std::cout << machine_draws().dump() << '\n';
  } else if (question == "inputs") {
    std::cout << inputs().dump() << '\n';
  } else if (question == "histories") {
    std::cout << histories().dump() << '\n';
  } else if (question == "schema") {
    std::cout << manifest::json_schema().dump() << '\n';
  } else if (question == "full_manifest") {
    std::cout << full_manifest();
  } else if (question == "extended_manifest") {
    std::cout << extended_manifest();
  } else if (question == "refusal") {
    std::cout << refusal_of({std::istreambuf_iterator<char>(std::cin), {}}) << '\n';
  } else {
    std::cerr << "expected distributions, draws, inputs, histories, schema, full_manifest, extended_manifest "
                 "or refusal\n";
    return 2;
  }
  return 0;
}

}  // namespace
}  // namespace zerocount

int main(int argc, char** argv) {
  return zerocount::answer(argc == 2 ? argv[1] : "");
}
