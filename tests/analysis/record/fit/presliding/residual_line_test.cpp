#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "analysis/record/fit/presliding/identification.hpp"
#include "tests/analysis/record/fit/presliding/material_tests.hpp"

namespace zerocount {
namespace {

using fit::ContactParameters;
using fit::Identification;
using fit::TestRecord;

/// The higher of the two natural frequencies (Hz) of a rotor on the spring `ground` (N m/rad) with a load on
/// a coupling, from the two equations of motion.
double higher_frequency(const motion::PlantParameters& plant, double ground) {
  const double rotor = (ground + plant.load.stiffness) / plant.inertia;
  const double load = plant.load.stiffness / plant.load.inertia;
  const double coupling = plant.load.stiffness / plant.inertia * load;
  const double square = 0.5 * (rotor + load) + std::sqrt(0.25 * (rotor - load) * (rotor - load) + coupling);
  return std::sqrt(square) / (2.0 * std::numbers::pi);
}

Identification identified(const motion::PlantParameters& plant, const friction::FrictionAlongRotor& friction,
                          std::mt19937_64& random, double noise = 0.0) {
  testing::TestInstrument instrument;
  instrument.noise = noise;
  std::vector<TestRecord> records;
  for (const testing::TorqueProgramme& programme : testing::three_tests())
    records.push_back(testing::simulated_test(plant, friction, programme, instrument, random));
  return fit::identify(std::move(records), {{}, 100, 0, 0.05});
}

void expect_frequency_of_second_mass(unsigned seed) {
  std::mt19937_64 random(seed);
  ContactParameters contact;
  contact.friction.breakaway = 10.0;
  std::uniform_real_distribution<double> stiffness(500.0, 1000.0);
  contact.plant.load = {.inertia = 1e-4, .stiffness = stiffness(random), .damping = 3e-3};
  const Identification found = identified(contact.plant, {contact.friction, {}}, random);
  EXPECT_FALSE(found.checks.passed);
  ASSERT_TRUE(found.residual_line.has_value()) << contact.plant.load.stiffness;
  EXPECT_EQ(found.residual_line->record, 1U);  // the steps
  const double low = higher_frequency(contact.plant, contact.friction.k1);
  const double high = higher_frequency(contact.plant, contact.friction.k1 + contact.friction.k2);
  EXPECT_GT(found.residual_line->frequency, 0.97 * low);
  EXPECT_LT(found.residual_line->frequency, 1.03 * high);
  EXPECT_NE(second_mass_text(found).find("A second mass on a spring"), std::string::npos);
}

TEST(ResidualLine, IsAtTheResonanceOfASecondMass) {
  expect_frequency_of_second_mass(1);
}

TEST(ResidualLine, DISABLED_IsAtTheResonanceOfOtherSecondMasses) {
  for (const unsigned seed : {2U, 3U}) expect_frequency_of_second_mass(seed);
}

TEST(ResidualLine, DISABLED_IsAbsentUnderAnotherFrictionLaw) {
  std::mt19937_64 random(4);
  const Identification found = identified({}, {{}, {}, friction::FrictionModel::gms}, random);
  EXPECT_FALSE(found.checks.passed);
  EXPECT_FALSE(found.residual_line.has_value());
}

/// Noise of 0.05 counts does not show in the fast motion of a ring-down.
TEST(Identification, DISABLED_ARecordThatDoesNotShowTheNoiseTakesItFromTheOthers) {
  std::mt19937_64 random(1);
  const ContactParameters contact = testing::random_contact(random);
  const Identification found = identified(contact.plant, {contact.friction, {}}, random, 0.05);
  for (const fit::RecordSummary& record : found.records) {
    EXPECT_GT(record.noise, 0.04) << record.name;
    EXPECT_LT(record.noise, 0.15) << record.name;
  }
  EXPECT_TRUE(found.checks.passed);
  EXPECT_FALSE(found.residual_line.has_value());
}

}  // namespace
}  // namespace zerocount
