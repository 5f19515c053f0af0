// What `check` says of the theory of points.
#include "runners/study_commands/point_theory_text.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "analysis/theory/point_theory.hpp"
#include "experiments/manifest/load_study.hpp"

namespace zerocount::study_commands {
namespace {

TEST(PointTheoryText, SaysOfHowManyPointsAStatementIs) {
  const std::vector<std::vector<TheoryItem>> items{{{"loop", "stable"}}, {{"loop", "stable"}}};
  const std::vector<std::string> labels{"a", "b"};
  EXPECT_EQ(theory_text(labels, items, 2).substr(0, 14), "at all points:");
  EXPECT_EQ(theory_text(labels, items, 57).substr(0, 36), "at each of the first 2 of 57 points:");
}

/// The value of the item of trial 0 with this name.
std::string value_of(const std::string& friction, const std::string& name) {
  const study::Study study = manifest::parse_study(
      "zerocount: 1\nname: axis\nseed: 1\ntrials: 1\nplant: {inertia: 2.0e-3, sliding_damping: 2.0e-3}\n"
      "dac: {bits: 24, resolution: 1.0e-6}\nencoder: {fine: 2000000}\n"
      "controller: {units: si, sample_rate: 2000, kp: 2, ki: 4, kd: 0.1}\n"
      "command: {targets: [100000], hold: 50}\nfriction: {" +
          friction + "}\n",
      "m.yaml", {});
  for (const TheoryItem& item : theory_items(theory::examine(study, 0)))
    if (item.name == name) return item.value;
  return "none";
}

// A stiff bristle with a static level sticks and slides as Coulomb friction does.
TEST(PointTheoryText, PredictsStickSlipWithABristleToo) {
  const std::string levels = "breakaway: 0.1, coulomb_ratio: 0.6, stribeck_velocity: 1.0e-3";
  const std::string name = "hunting of trial 0, by stick-slip";
  EXPECT_EQ(value_of("model: coulomb, " + levels, name).substr(0, 9), "amplitude");
  const std::string bristle = value_of("model: lugre, sigma0: 3.0e+4, sigma1: 15, " + levels, name);
  EXPECT_EQ(bristle.substr(0, 9), "amplitude");
  EXPECT_NE(bristle.find("within a third"), std::string::npos) << bristle;
  EXPECT_NE(value_of("model: lugre, sigma0: 3.0e+4, sigma1: 15, " + levels,
                     "hunting of trial 0, by describing function"),
            "no lasting cycle");
  EXPECT_EQ(value_of("model: dahl, sigma0: 3.0e+4, breakaway: 0.1", name), "no lasting cycle");
}

}  // namespace
}  // namespace zerocount::study_commands
