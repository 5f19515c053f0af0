// What is printed: the fragment parses as part of a manifest and has the intervals; JSON has the very
// doubles.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "analysis/record/fit/presliding/identification.hpp"
#include "core/failure/failure.hpp"
#include "experiments/distributions/distribution.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study_trial.hpp"

namespace zerocount::testing {
namespace {

struct Named {
  const char* name;
  const char* key;
};
constexpr Named names[] = {{"k1", "friction.k1"},
                           {"k2", "friction.k2"},
                           {"k1_plus_k2", ""},
                           {"beta", "friction.beta"},
                           {"presliding_damping", "plant.presliding_damping"},
                           {"inertia", "plant.inertia"},
                           {"alpha", "friction.alpha"},
                           {"lambda", "friction.lambda"},
                           {"n", "friction.n"}};

/// A made-up identification: random values and intervals over all orders of magnitude, some of the parameters
/// given, some not identifiable.
fit::Identification random_identification(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  fit::Identification found;
  found.records.push_back({});
  found.records.back().name = "ramps.csv";
  for (const Named& named : names) {
    fit::ParameterEstimate parameter;
    parameter.name = named.name;
    parameter.key = named.key;
    parameter.unit = "unit";
    const double kind = uniform(random);
    const double half_width = std::pow(10.0, -7.0 * uniform(random));
    if (parameter.name == "n") {
      parameter.low = 1.0 + 2.0 * uniform(random);
      parameter.high = parameter.low + half_width;
      parameter.value = 0.5 * (parameter.low + parameter.high);
    } else {
      parameter.value = std::pow(10.0, 12.0 * uniform(random) - 6.0);
      parameter.low = parameter.value * std::exp(-half_width);
      parameter.high = parameter.value * std::exp(half_width);
    }
    parameter.status = kind < 0.6   ? fit::EstimateStatus::estimated
                       : kind < 0.8 ? fit::EstimateStatus::known
                                    : fit::EstimateStatus::not_identifiable;
    if (parameter.status == fit::EstimateStatus::not_identifiable) {
      parameter.value = parameter.low = parameter.high = std::numeric_limits<double>::quiet_NaN();
      parameter.reason = "there is no ring-down: the torque never steps";
    }
    found.parameters.push_back(parameter);
  }
  found.fragment = fit::manifest_fragment(found);
  return found;
}

study::Study study_with(const std::string& fragment) {
  return manifest::parse_study(
      "zerocount: 1\nname: pasted\nseed: 1\ntrials: 3000\ncommand: {targets: [3], hold: 0.1}\n" + fragment,
      "pasted.yaml");
}

/// The values of the parameter that the study's trials draw.
std::vector<double> drawn(const study::Study& study, const std::string& key) {
  std::size_t column = 0;
  while (study.columns.inputs[column].name != key) ++column;
  std::vector<double> values;
  for (std::int64_t i = 0; i < study.trials; ++i)
    values.push_back(study::study_trial(study, 0, i).inputs[column]);
  return values;
}

/// Quantile of the parameter's values over the study's trials.
double sampled(const study::Study& study, const std::string& key, double proportion) {
  std::vector<double> values = drawn(study, key);
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(proportion * static_cast<double>(values.size()))];
}

TEST(ManifestFragment, IsAcceptedInAManifestWhateverItsNumbers) {
  std::mt19937_64 random(61);
  for (int round = 0; round < 200; ++round) {
    const fit::Identification found = random_identification(random);
    EXPECT_NO_THROW(study_with(found.fragment)) << found.fragment;
  }
}

// What is drawn lies in the interval in 95 % of the trials.
TEST(ManifestFragment, DistributionsSpanTheIntervals) {
  std::mt19937_64 random(62);
  for (int round = 0; round < 5; ++round) {
    const fit::Identification found = random_identification(random);
    const study::Study study = study_with(found.fragment);
    for (const fit::ParameterEstimate& parameter : found.parameters) {
      if (parameter.key.empty() || parameter.status != fit::EstimateStatus::estimated) continue;
      const double width = parameter.high - parameter.low;
      if (parameter.name == "n" && parameter.low < 1.0 + width) continue;  // cut at 1
      EXPECT_NEAR(sampled(study, parameter.key, 0.025), parameter.low, 0.1 * width) << parameter.name;
      EXPECT_NEAR(sampled(study, parameter.key, 0.975), parameter.high, 0.1 * width) << parameter.name;
    }
  }
}

/// Errors of λ and n that correlate, and the intervals that belong to them.
fit::Identification correlated_creep(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  fit::Identification found;
  found.records.push_back({});
  found.records.back().name = "holds.csv";
  const auto add = [&](const char* name, double middle, double low, double high) {
    fit::ParameterEstimate& one = found.parameters.emplace_back();
    one.name = name;
    one.key = std::string("friction.") + name;
    one.unit = "unit";
    one.status = fit::EstimateStatus::estimated;
    one.value = middle;
    one.low = low;
    one.high = high;
  };
  const double sd_of_lambda = 0.02 + 0.2 * uniform(random);  // of ln λ
  const double sd_of_n = 0.01 + 0.05 * uniform(random);
  const double correlation = (uniform(random) < 0.5 ? -1.0 : 1.0) * (0.9 + 0.099 * uniform(random));
  add("k1", 110.0, 100.0, 121.0);
  add("alpha", 0.5, 0.4, 0.625);
  const double lambda = 1.0 + 20.0 * uniform(random);
  add("lambda", lambda, lambda * std::exp(-1.96 * sd_of_lambda), lambda * std::exp(1.96 * sd_of_lambda));
  const double n = 1.8 + uniform(random);
  add("n", n, n - 1.96 * sd_of_n, n + 1.96 * sd_of_n);
  found.errors.names = {"lambda", "n"};
  found.errors.covariance =
      Eigen::MatrixXd{{sd_of_lambda * sd_of_lambda, correlation * sd_of_lambda * sd_of_n},
                      {correlation * sd_of_lambda * sd_of_n, sd_of_n * sd_of_n}};
  found.correlations = {{"lambda", "n", correlation}};
  found.fragment = fit::manifest_fragment(found);
  return found;
}

// Machines drawn from the fragment have λ and n as the record has them: each in its interval, and together.
TEST(ManifestFragment, DrawsCreepWithTheCorrelationOfItsErrors) {
  std::mt19937_64 random(64);
  for (int round = 0; round < 10; ++round) {
    const fit::Identification found = correlated_creep(random);
    const study::Study study = study_with(found.fragment);
    EXPECT_EQ(found.fragment.find("lambda"), std::string::npos) << found.fragment;
    for (const fit::ParameterEstimate& one : found.parameters) {
      const double width = one.high - one.low;
      EXPECT_NEAR(sampled(study, one.key, 0.025), one.low, 0.1 * width) << one.name << found.fragment;
      EXPECT_NEAR(sampled(study, one.key, 0.975), one.high, 0.1 * width) << one.name << found.fragment;
    }
    const std::vector<double> n = drawn(study, "friction.n"), lambda = drawn(study, "friction.lambda");
    Eigen::MatrixXd errors(study.trials, 2);
    for (Eigen::Index i = 0; i < errors.rows(); ++i)
      errors.row(i) << std::log(lambda[static_cast<std::size_t>(i)]), n[static_cast<std::size_t>(i)];
    errors.rowwise() -= errors.colwise().mean().eval();
    const Eigen::MatrixXd sums = errors.transpose() * errors;
    EXPECT_NEAR(sums(0, 1) / std::sqrt(sums(0, 0) * sums(1, 1)), found.errors.correlation(0, 1), 0.02)
        << found.fragment;
  }
}

TEST(ManifestFragment, GivenValuesAreKeptAndUnidentifiedOnesAreComments) {
  fit::Identification found;
  found.records.push_back({});
  fit::ParameterEstimate given;
  given.name = "n";
  given.key = "friction.n";
  given.status = fit::EstimateStatus::known;
  given.value = given.low = given.high = 2.1;
  fit::ParameterEstimate open;
  open.name = "inertia";
  open.key = "plant.inertia";
  open.reason = "there is no ring-down";
  found.parameters = {given, open};
  const std::string fragment = fit::manifest_fragment(found);
  EXPECT_NE(fragment.find("\nfriction:\n  n: 2.1 "), std::string::npos) << fragment;
  EXPECT_NE(fragment.find("# inertia: not identifiable, because there is no ring-down"), std::string::npos)
      << fragment;
  EXPECT_EQ(study_with(fragment).name, "pasted");
}

TEST(IdentificationReport, JsonReadsBackToTheSameDoubles) {
  std::mt19937_64 random(63);
  const fit::Identification found = random_identification(random);
  const auto json = document::json(fit::identification_answer().of(found));
  ASSERT_EQ(json["parameters"].size(), found.parameters.size());
  for (std::size_t i = 0; i < found.parameters.size(); ++i) {
    const fit::ParameterEstimate& parameter = found.parameters[i];
    const auto& object = json["parameters"][i];
    EXPECT_EQ(object["name"], parameter.name);
    if (parameter.status == fit::EstimateStatus::not_identifiable) {
      EXPECT_TRUE(object["value"].is_null());
      EXPECT_EQ(object["status"], "not_identifiable");
      EXPECT_EQ(object["reason"], parameter.reason);
      continue;
    }
    EXPECT_EQ(object["value"].get<double>(), parameter.value);
    EXPECT_EQ(object["low"].get<double>(), parameter.low);
    EXPECT_EQ(object["high"].get<double>(), parameter.high);
  }
  EXPECT_EQ(json["manifest"], found.fragment);
  EXPECT_TRUE(json["residuals"]["passed"].get<bool>());
}

TEST(IdentificationReport, TextNamesUnidentifiedParametersAndLackOfFit) {
  std::mt19937_64 random(64);
  fit::Identification found = random_identification(random);
  found.parameters[0].status = fit::EstimateStatus::not_identifiable;
  found.parameters[0].reason = "nothing was seen";
  found.checks.passed = false;
  found.checks.widening = 2.5;
  found.checks.spread_chance = 0.002;
  const std::string text = document::text(fit::identification_answer().of(found));
  EXPECT_NE(text.find("k1 is not identifiable from this, because nothing was seen."), std::string::npos)
      << text;
  EXPECT_NE(text.find("LACK OF FIT"), std::string::npos) << text;
  EXPECT_NE(text.find("widened by the factor 2.5"), std::string::npos) << text;
  EXPECT_NE(text.find(found.fragment), std::string::npos) << text;
}

}  // namespace
}  // namespace zerocount::testing
