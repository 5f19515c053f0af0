// What `check` says of the theory of points.
#include <nlohmann/json.hpp>

#include "analysis/document/answer.hpp"
#include "analysis/theory/point_theory.hpp"
#include "experiments/manifest/load_study.hpp"
#include "tests/support/test.hpp"

namespace zerocount::theory {
namespace {

document::Answer theory_with(const std::string& friction) {
  const study::Study study = manifest::parse_study(
      "zerocount: 1\nname: axis\nseed: 1\ntrials: 1\nplant: {inertia: 2.0e-3, sliding_damping: 2.0e-3}\n"
      "dac: {bits: 24, resolution: 1.0e-6}\nencoder: {fine: 2000000}\n"
      "controller: {units: si, sample_rate: 2000, kp: 2, ki: 4, kd: 0.1}\n"
      "command: {targets: [100000], hold: 50}\nfriction: {" +
          friction + "}\n",
      "m.yaml", {});
  const document::AnswerDescription<PointTheory> answer{{.name = "theory", .meaning = "theory of a point"},
                                                        point_theory_description()};
  return answer.of(examine(study, 0));
}

TEST(PointTheoryDescription, HasTheNumbersOfEachStatement) {
  const document::Answer answer = theory_with("k1: 110");
  const auto theory = document::json(answer);
  EXPECT_TRUE(theory["outside"].is_null());
  EXPECT_LT(theory["stable_below"]["low"], theory["unstable_above"]["low"]);
  EXPECT_EQ(theory["lowest_k1"], 110.0);
  EXPECT_EQ(theory["loops"].size(), 3U);
  const std::string text = document::text(answer);
  for (const char* key : {"stable_below", "sampled_below", "unstable_above", "gain", "dac_bound"}) {
    const std::string number = fmt::format("{:.3g}", theory[key]["low"].get<double>());
    EXPECT_NE(text.find(number), std::string::npos) << key << ": " << number << "\n" << text;
  }
}

// A rotor that stays the same from point to point is searched once.
TEST(PointTheory, RotorsKnownFromThePointBeforeChangeNothing) {
  const study::Study study = manifest::parse_study(
      "zerocount: 1\nname: axis\nseed: 1\nrigs: 5\ntrials: 5\ncommand: {targets: [1], hold: 1}\nsweep:\n  "
      "cases:\n"
      "    a: {friction.k1: {profile: {mean: 110, cv: 0.1, correlation_length: 0.3}}}\n"
      "    b: {friction.k1: {profile: {mean: 110, cv: 0.1, correlation_length: 0.3}}, controller.ki: "
      "2.0e-5}\n"
      "    c: {friction.k1: {profile: {mean: 90, cv: 0.2, correlation_length: 0.3}}}\n",
      "m.yaml", {});
  std::vector<KnownRotor> known;
  std::set<double> lowest;
  for (const std::int64_t point : {0, 1, 2, 0}) {
    const PointTheory theory = examine(study, point, 0, known);
    EXPECT_EQ(theory.lowest.k1.low, examine(study, point).lowest.k1.low) << point;
    EXPECT_EQ(theory.lowest.k1.high, examine(study, point).lowest.k1.high) << point;
    lowest.insert(theory.lowest.k1.low);
  }
  EXPECT_EQ(lowest.size(), 2U);
}

}  // namespace
}  // namespace zerocount::theory
