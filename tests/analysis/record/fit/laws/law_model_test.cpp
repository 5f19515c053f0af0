// The models of the laws: their paths and derivatives.
#include <random>

#include <gtest/gtest.h>

#include "analysis/record/fit/laws/law_identification.hpp"
#include "analysis/record/fit/model.hpp"
#include "core/friction/law.hpp"
#include "tests/analysis/record/fit/presliding/material_tests.hpp"

namespace zerocount::testing {
namespace {

using fit::FitModel;

fit::TestRecord short_record() {
  std::mt19937_64 random(3);
  const fit::ContactParameters contact = random_contact(random);
  TorqueProgramme test;
  test.step(0.08).hold(0.05).step(0.0).hold(0.05).ramp(0.1, 0.8).hold(0.2).ramp(-0.1, 0.8);
  fit::TestRecord record = simulated_test(contact, test, {}, random);
  record.parts = parts_of(record);
  return record;
}

// A moving time offset moves the path by the velocity, and coordinates that a law does not have have no
// effect.
TEST(LawModel, DerivativesCoverOnlyTheFreeCoordinates) {
  const fit::TestRecord record = short_record();
  const auto scales = fit::scales_of(std::span(&record, 1));
  for (const friction::FrictionModel law : fit::fitted_laws()) {
    const FitModel model = fit::law_model(law, scales, std::span(&record, 1));
    const fit::Point& point = model.starts.front();
    const fit::RecordMotion motion = fit::modelled_motions({&record, 1}, model, point, model.free).front();
    for (Eigen::Index j = 0; j < point.size(); ++j) {
      if (!model.free[static_cast<std::size_t>(j)]) {
        EXPECT_EQ(motion.sensitivity.col(j).norm(), 0.0);
        continue;
      }
      constexpr double step = 1e-3;
      fit::Point moved = point;
      moved[j] += step;
      const Eigen::VectorXd there = fit::modelled_path(record, model, moved);
      moved[j] -= 2.0 * step;
      const Eigen::VectorXd back = fit::modelled_path(record, model, moved);
      const Eigen::VectorXd slope = (there - back) / (2.0 * step);
      EXPECT_LT((slope - motion.sensitivity.col(j)).norm(), 0.05 * slope.norm() + 1e-2)
          << friction::traits_of(law).word << " coordinate " << j;
    }
  }
}

}  // namespace
}  // namespace zerocount::testing
