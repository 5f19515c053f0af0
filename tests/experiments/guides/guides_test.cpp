// Starting values of guides: their table, and what follows from it.
#include "core/friction/presliding/spring.hpp"
#include "experiments/guides/guide_manifest.hpp"
#include "experiments/manifest/parameter_listing.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "experiments/study/study_trial.hpp"
#include "tests/experiments/manifest_texts.hpp"
#include "tests/support/branch_law.hpp"

namespace zerocount::guides {
namespace {

GuideNumber parameter(const Guide& guide, const GuideLoad& load, std::string_view name) {
  for (const GuideNumber& number : guide_parameters(guide, load)) {
    if (number.quantity == name) return number;
  }
  ADD_FAILURE() << guide.name << " lacks " << name;
  return {};
}

std::vector<Guide> loaded_guides() {
  std::vector<Guide> guides;
  for (const Guide& guide : guide_table()) {
    if (has_load(guide)) guides.push_back(guide);
  }
  return guides;
}

double log_uniform(std::mt19937& generator, double low, double high) {
  return low * std::pow(high / low, std::uniform_real_distribution<>(0.0, 1.0)(generator));
}

std::string without_space_before(const std::string& line) {
  return line.substr(line.find_first_not_of(' '));
}

TEST(Guides, EveryNumberHasARangeASourceAndTheUnitOfItsParameter) {
  for (const Guide& guide : guide_table()) {
    std::vector<GuideNumber> numbers = guide.numbers;
    for (const GuideNumber& number : guide_parameters(guide, usual_load(guide))) {
      const auto row = parameters::find_parameter(number.quantity);
      ASSERT_TRUE(row) << number.quantity;
      EXPECT_EQ(number.unit, parameters::unit_of(parameters::parameter_table()[*row], {.axis = guide.axis}))
          << guide.name << " " << number.quantity;
      numbers.push_back(number);
    }
    for (const GuideNumber& number : numbers) {
      EXPECT_GT(number.low, 0.0) << guide.name << " " << number.quantity;
      EXPECT_LE(number.low, number.high) << guide.name << " " << number.quantity;
      EXPECT_FALSE(number.source.empty()) << guide.name << " " << number.quantity;
    }
  }
}

// So the spring of the guide gives way after the travel that was measured on such guides.
TEST(Guides, TheVirginCurveReachesBreakawayAfterTheTravel) {
  for (const Guide& guide : loaded_guides()) {
    const GuideLoad load = usual_load(guide);
    const double travel = centre(*find_number(guide, presliding_travel));
    const double k1 = centre(parameter(guide, load, "friction.k1"));
    const double k2 = centre(parameter(guide, load, "friction.k2"));
    const double beta = centre(parameter(guide, load, "friction.beta"));
    const double force = k1 * travel - 0.5 * k2 / beta * std::expm1(-2.0 * beta * travel);
    EXPECT_NEAR(force / centre(parameter(guide, load, "friction.breakaway")), 1.0, 1e-6) << guide.name;
    EXPECT_LT(0.5 * parameter(guide, load, "friction.k2").high / parameter(guide, load, "friction.beta").low,
              centre(parameter(guide, load, "friction.breakaway")))
        << guide.name << " slides before it softens at a corner of its ranges";
  }
}

TEST(Guides, FrictionBeyondTheConstantResistanceIsProportionalToTheLoad) {
  std::mt19937 generator(1);
  for (const Guide& guide : loaded_guides()) {
    const GuideNumber& constant = *find_number(guide, constant_resistance);
    for (int i = 0; i < 20; ++i) {
      const GuideLoad load{.mass = log_uniform(generator, 0.1, 100),
                           .preload = log_uniform(generator, 1, 1e4)};
      const double factor = log_uniform(generator, 0.1, 10);
      const GuideLoad scaled{.mass = factor * load.mass, .preload = factor * load.preload};
      const GuideNumber friction = parameter(guide, load, "friction.breakaway");
      const GuideNumber more = parameter(guide, scaled, "friction.breakaway");
      EXPECT_NEAR(more.low - constant.low, factor * (friction.low - constant.low), 1e-9 * more.low);
      EXPECT_NEAR(more.high - constant.high, factor * (friction.high - constant.high), 1e-9 * more.high);

      const double ratio = centre(more) / centre(friction);
      const auto growth = [&](std::string_view name) {
        return centre(parameter(guide, scaled, name)) / centre(parameter(guide, load, name));
      };
      EXPECT_NEAR(growth("friction.k1") / ratio, 1.0, 1e-9);
      EXPECT_NEAR(growth("friction.k2") / ratio, 1.0, 1e-9);
      EXPECT_NEAR(growth("friction.lambda") / (ratio * ratio), 1.0, 1e-9);
      EXPECT_NEAR(growth("friction.beta"), 1.0, 1e-9);
      EXPECT_NEAR(growth("plant.presliding_damping") / std::sqrt(ratio * factor), 1.0, 1e-9);
    }
  }
}

TEST(Guides, EveryManifestGivesNoWarningAtAnyUsualLoad) {
  std::mt19937 generator(2);
  for (const Guide& guide : guide_table()) {
    for (int i = 0; i < 10; ++i) {
      GuideAxis axis{.load = usual_load(guide)};
      if (i > 0 && guide.axis == parameters::AxisKind::linear) {
        axis.load.mass *= log_uniform(generator, 0.2, 5);
        axis.load.preload *= log_uniform(generator, 0.2, 5);
        axis.resolution = log_uniform(generator, 1e-9, 1e-7);
      }
      const std::string text = guide_manifest(guide, axis);
      const study::Study study = manifest::parse_study(text, "guide.yaml");
      EXPECT_EQ(study.name, guide.name);
      EXPECT_TRUE(study.warnings.empty()) << study.warnings.front() << "\n" << text;
      EXPECT_EQ(unstated_premises(study), std::vector<std::string_view>{}) << text;
    }
  }
}

// Whatever spring was measured, the study has it: its machines break away after the travel with that force.
TEST(Guides, EveryMachineHasTheMeasuredSpring) {
  std::mt19937 generator(4);
  for (const Guide& guide : guide_table()) {
    for (int i = 0; has_load(guide) && i < 20; ++i) {
      GuideAxis axis{.load = usual_load(guide)};
      MeasuredSpring spring{.breakaway = log_uniform(generator, 1, 100),
                            .travel = log_uniform(generator, 1e-6, 1e-4)};
      spring.secant_travel = spring.travel * log_uniform(generator, 0.05, 0.9);
      const double least = spring.breakaway / spring.travel;
      const double most = spring.breakaway / spring.secant_travel;
      spring.secant_stiffness = least + (most - least) * log_uniform(generator, 0.05, 0.95);
      ASSERT_EQ(fault_of(spring), "");
      axis.spring = spring;
      const std::string text = guide_manifest(guide, axis);
      const study::Study study = manifest::parse_study(text, "guide.yaml");
      for (std::int64_t machine = 0; machine < study.machines; ++machine) {
        const friction::FrictionParameters contact =
            friction::friction_at(study::study_trial(study, 0, machine).parameters.friction, 0.0);
        const auto torque = [&](double travel) { return 0.5 * testing::branch_law(contact, 2.0 * travel); };
        EXPECT_NEAR(torque(spring.travel) / spring.breakaway, 1.0, 1e-12);
        EXPECT_NEAR(torque(spring.secant_travel) / (spring.secant_stiffness * spring.secant_travel), 1.0,
                    1e-12);
      }
    }
  }
}

TEST(Guides, AManifestStatesTheOriginAboveEachOfItsNumbers) {
  for (const Guide& guide : guide_table()) {
    std::istringstream text(guide_manifest(guide, {.load = usual_load(guide)}));
    std::string before;
    std::size_t stated = 0;
    for (std::string line; std::getline(text, line); before = line) {
      for (const GuideNumber& number : guide_parameters(guide, usual_load(guide))) {
        const std::string key = fmt::format("  {}:", number.quantity.substr(number.quantity.find('.') + 1));
        if (!line.starts_with(key)) continue;
        EXPECT_EQ(
            without_space_before(before),
            fmt::format("# {}: {}", origin_labels[static_cast<std::size_t>(number.origin)], number.source));
        ++stated;
      }
    }
    EXPECT_EQ(stated, guide_parameters(guide, usual_load(guide)).size()) << guide.name;
  }
}

TEST(Guides, AnUnknownNameIsRefusedWithTheKnownNames) {
  const std::string message = refusal_by([] { guide_named("bal-rail"); });
  for (const Guide& guide : guide_table()) EXPECT_TRUE(says(message, guide.name));
}

TEST(Guides, TheirRangesReplaceTheMissingDefaultsOfALinearAxis) {
  double low = HUGE_VAL;
  double high = 0.0;
  for (const Guide& guide : loaded_guides()) {
    low = std::min(low, parameter(guide, usual_load(guide), "friction.k1").low);
    high = std::max(high, parameter(guide, usual_load(guide), "friction.k1").high);
  }
  const auto default_of_k1 = [](const parameters::StudyUnits& units) {
    const std::vector<manifest::ListedParameter> rows = manifest::listed_parameters(units);
    return std::ranges::find(rows, "friction.k1", &manifest::ListedParameter::name)->default_value;
  };
  EXPECT_EQ(default_of_k1({.axis = parameters::AxisKind::linear}),
            fmt::format("guides: {:.3g} to {:.3g}", low, high));
  EXPECT_FALSE(says(default_of_k1({}), "guides:"));
}

}  // namespace
}  // namespace zerocount::guides
