#include "analysis/theory/criterion_curves.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "experiments/manifest/load_study.hpp"

namespace zerocount::theory {
namespace {

const std::string head =
    "zerocount: 1\nname: curves\nseed: 3\ntrials: 40\n"
    "command: {targets: [5], hold: 0.1}\n";

/// (6) and (7) written out for the paper's rig: k_ID = c·(k + kp/Δx)/J·Δx·T/2.
double bound(double stiffness, double kp, double inertia = 5.54e-4) {
  const double dx = 2.0 * std::numbers::pi / 1620000.0;
  return 0.2 * (stiffness + kp / dx) / inertia * dx / 2000.0 / 2.0;
}

const CriterionCurve& curve(const std::vector<CriterionCurve>& curves, const std::string& criterion,
                            bool first) {
  for (const CriterionCurve& one : curves) {
    if (one.criterion == criterion && one.first == first) return one;
  }
  ADD_FAILURE() << criterion << " is missing";
  return curves.front();
}

TEST(CriterionCurves, AreThePapersBoundsForTheSoftestAndTheStiffestTrial) {
  const study::Study study = manifest::parse_study(
      head + "friction: {k1: {choice: [90, 100, 130]}, k2: {choice: [700, 800]}}\n", "test");
  const CriterionPlane plane{{"controller.ki", 1e-5, 6e-4, true}, {"controller.kp", 0.0, 8e-4}};
  const std::vector<CriterionCurve> curves = criterion_curves(study, 0, plane);
  ASSERT_EQ(curves.size(), 4U);
  for (const auto& [criterion, first, stiffness] :
       {std::tuple{"(6)", true, 90.0}, {"(6)", false, 130.0}, {"(7)", true, 790.0}, {"(7)", false, 930.0}}) {
    const CriterionCurve& found = curve(curves, criterion, first);
    EXPECT_GT(found.points.size(), 30U);
    for (const CurvePoint& point : found.points)
      EXPECT_NEAR(point.x, bound(stiffness, point.y), 1e-9 * point.x + 1e-15) << criterion << first;
  }
}

TEST(CriterionCurves, AreFoundInAPlaneWithoutTheGainToo) {
  const study::Study study = manifest::parse_study(head, "test");
  const CriterionPlane plane{{"plant.inertia", 2e-4, 2e-3}, {"friction.k1", 50.0, 200.0}};
  const std::vector<CriterionCurve> curves = criterion_curves(study, 0, plane);
  for (const CurvePoint& point : curve(curves, "(6)", true).points)
    EXPECT_NEAR(bound(point.y, 0.0, point.x), 3.85e-5, 1e-10);
}

TEST(CriterionCurves, ThereAreNoneWhereTheCriteriaSayNothing) {
  const CriterionPlane plane{{"controller.ki", 1e-5, 6e-4, true}, {"controller.kp", 0.0, 8e-4}};
  const study::Study coulomb = manifest::parse_study(head + "friction: {model: coulomb}\n", "test");
  EXPECT_TRUE(criterion_curves(coulomb, 0, plane).empty());
  CriterionPlane strange = plane;
  strange.y.parameter = "command.targets.0";
  EXPECT_TRUE(criterion_curves(manifest::parse_study(head, "test"), 0, strange).empty());
}

}  // namespace
}  // namespace zerocount::theory
