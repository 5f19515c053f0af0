#include <boost/random/sobol.hpp>

#include "experiments/designs/designs.hpp"
#include "experiments/parameters/element_lists.hpp"
#include "experiments/parameters/parameter_table.hpp"
#include "tests/support/test.hpp"

namespace zerocount::designs {
namespace {

constexpr std::size_t dimension_count = 70;
constexpr std::size_t dimension_limit = boost::random::default_sobol_table::max_dimension;

std::vector<SobolDirections> all_directions() {
  std::vector<std::size_t> dimensions(dimension_count);
  std::iota(dimensions.begin(), dimensions.end(), std::size_t{0});
  return sobol_directions(dimensions);
}

TEST(Sobol, MatchesTheSequenceOfBoostAfterTheOrigin) {
  const auto directions = all_directions();
  boost::random::sobol engine(dimension_count);
  for (std::size_t d = 0; d < dimension_count; ++d) EXPECT_EQ(sobol_bits(0, directions[d]), 0u);
  for (std::uint64_t index = 1; index < 3000; ++index) {
    for (std::size_t d = 0; d < dimension_count; ++d) ASSERT_EQ(sobol_bits(index, directions[d]), engine());
  }
}

TEST(Sobol, ReachesFarPointsDirectly) {
  const auto directions = all_directions();
  for (const std::uint64_t index :
       {std::uint64_t{123'456'789}, std::uint64_t{1} << 40, (std::uint64_t{1} << 53) - 1}) {
    boost::random::sobol engine(dimension_count);
    engine.seed(index - 1);
    for (std::size_t d = 0; d < dimension_count; ++d) ASSERT_EQ(sobol_bits(index, directions[d]), engine());
  }
}

TEST(Sobol, ADimensionDoesNotDependOnTheOtherDimensions) {
  const auto directions = all_directions();
  const std::vector<std::size_t> few{2, 69, 0};
  const auto alone = sobol_directions(few);
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(alone[i], directions[few[i]]);
  EXPECT_TRUE(sobol_directions({}).empty());
}

TEST(Sobol, EveryAlignedBlockOfTrialsFillsEveryStratumOnce) {
  const auto directions = all_directions();
  for (std::size_t d = 0; d < dimension_count; ++d) {
    const random::RandomStream stream{random_key(9, std::to_string(d)), 0};
    for (const std::uint64_t block : {std::uint64_t{0}, std::uint64_t{3}, std::uint64_t{1000}}) {
      std::set<int> strata;
      for (std::uint64_t i = 64 * block; i < 64 * (block + 1); ++i)
        strata.insert(static_cast<int>(64.0 * sobol_uniform(i, directions[d], stream)));
      ASSERT_EQ(strata.size(), 64u) << "dimension " << d;
    }
  }
}

// The point of the design: the first two parameters of the table fill squares, shifted or not.
TEST(Sobol, TheFirstTwoDimensionsFillEverySquareOnce) {
  const auto directions = all_directions();
  std::set<std::pair<int, int>> squares;
  for (std::uint64_t i = 0; i < 256; ++i) {
    const double x = sobol_uniform(i, directions[0], {random_key(9, "x"), 0});
    const double y = sobol_uniform(i, directions[1], {random_key(9, "y"), 0});
    squares.insert({static_cast<int>(16 * x), static_cast<int>(16 * y)});
  }
  EXPECT_EQ(squares.size(), 256u);
}

TEST(Sobol, TheShiftDependsOnSeedNameAndStream) {
  const auto directions = all_directions();
  const double u = sobol_uniform(5, directions[0], {random_key(1, "a"), 0});
  EXPECT_NE(u, sobol_uniform(5, directions[0], {random_key(2, "a"), 0}));
  EXPECT_NE(u, sobol_uniform(5, directions[0], {random_key(1, "b"), 0}));
  EXPECT_NE(u, sobol_uniform(5, directions[0], {random_key(1, "a"), 1}));
}

// The most rows that a list or a key of elements can have: each has its own dimension.
std::vector<parameters::Parameter> all_rows_of(const parameters::Parameter& parameter) {
  constexpr std::size_t filters = 8;
  std::vector<parameters::Parameter> rows;
  for (std::size_t element = 0; parameter.element && element < filters; ++element)
    rows.push_back(element_row(parameter, element, "element"));
  if (!parameter.element) rows.push_back(parameter);
  std::vector<parameters::Parameter> values;
  for (const parameters::Parameter& row : rows) {
    for (std::size_t i = 0; row.list && i < row.list->max_values; ++i)
      values.push_back(value_row(row, i, "value"));
  }
  return parameter.list ? values : rows;
}

// Lists of moves share their dimensions, of which a study has one, and so do the keys of a filter that belong
// to different forms.
TEST(Sobol, ElementsOfListsHaveTheirOwnDimensions) {
  std::map<std::size_t, std::string> owner;
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    std::string group(parameter.name);
    if (parameter.element) group = group.substr(0, group.find(".#"));
    if (parameter.list && group.starts_with("command.")) group = "moves";
    for (const parameters::Parameter& row : all_rows_of(parameter)) {
      EXPECT_LT(row.sobol_dimension, 3600u) << parameter.name;
      const auto [known, added] = owner.emplace(row.sobol_dimension, group);
      EXPECT_EQ(known->second, group) << parameter.name;
    }
    EXPECT_LT(parameter.sobol_dimension, dimension_limit) << parameter.name;
    if (parameter.profiled == nullptr) continue;
    const std::size_t of_mean = parameters::sobol_dimension_of_mean(parameter.sobol_dimension);
    if (parameter.profiled) {
      EXPECT_TRUE(owner.emplace(of_mean, group).second) << parameter.name;
    }
  }
}

TEST(Sobol, KeysOfOneFilterHaveDifferentDimensions) {
  for (const parameters::ElementList& list : parameters::element_lists()) {
    for (const parameters::ElementForm& form : list.forms) {
      std::set<std::size_t> dimensions;
      std::size_t count = 0;
      for (const std::string_view key : form.keys) {
        const auto row = parameters::find_parameter(std::string(list.path) + ".#." + std::string(key));
        parameters::Parameter first = element_row(parameters::parameter_table()[row.value()], 0, "element");
        std::vector<parameters::Parameter> rows = all_rows_of(first);
        for (const parameters::Parameter& value : rows) dimensions.insert(value.sobol_dimension);
        count += rows.size();
      }
      EXPECT_EQ(dimensions.size(), count) << list.path << " " << form.name;
    }
  }
}

TEST(Sobol, EveryParameterHasItsOwnDimensionExceptListsOfMoves) {
  std::set<std::size_t> dimensions;
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    if (!parameters::has_value(parameter)) {
      if (!parameter.name.starts_with("command.")) continue;
      EXPECT_EQ(parameter.sobol_dimension, parameters::first_sobol_dimension_of_moves) << parameter.name;
      continue;
    }
    EXPECT_TRUE(dimensions.insert(parameter.sobol_dimension).second) << parameter.name;
    EXPECT_TRUE(parameter.sobol_dimension < parameters::first_sobol_dimension_of_moves ||
                parameter.sobol_dimension >= parameters::first_sobol_dimension_beyond_moves)
        << parameter.name;
    EXPECT_LT(parameter.sobol_dimension, dimension_limit) << parameter.name;
    if (parameter.profiled == nullptr) continue;
    const std::size_t of_mean = parameters::sobol_dimension_of_mean(parameter.sobol_dimension);
    EXPECT_TRUE(dimensions.insert(of_mean).second) << parameter.name;
    EXPECT_LT(of_mean, dimension_limit) << parameter.name;
  }
  EXPECT_EQ(parameters::first_sobol_dimension_beyond_moves, 3064u);
}

// That a study drawn with them once gets the same trials for ever.
TEST(Sobol, DimensionsOfParametersNeverChange) {
  const std::map<std::string_view, std::size_t> fixed{
      {"friction.k1", 0},
      {"friction.k2", 1},
      {"initial.encoder_phase", 2},
      {"friction.beta", 3},
      {"friction.alpha", 4},
      {"friction.lambda", 5},
      {"friction.breakaway", 6},
      {"friction.coulomb_ratio", 7},
      {"friction.stribeck_velocity", 8},
      {"initial.position", 9},
      {"initial.hardening", 10},
      {"initial.preload", 11},
      {"plant.inertia", 12},
      {"plant.presliding_damping", 13},
      {"plant.sliding_damping", 14},
      {"friction.n", 15},
      {"encoder.fine", 16},
      {"encoder.coarse", 17},
      {"dac.bits", 18},
      {"dac.resolution", 19},
      {"controller.sample_rate", 20},
      {"controller.kp", 21},
      {"controller.ki", 22},
      {"controller.kd", 23},
      {"controller.delay", 24},
      {"controller.anti_windup", 25},
      {"command.hold", 26},
      {"verdict.dwell", 27},
      {"verdict.window", 28},
      {"encoder.fine_errors.eccentricity", 29},
      {"encoder.fine_errors.eccentricity_angle", 30},
      {"encoder.fine_errors.interpolation", 31},
      {"encoder.fine_errors.interpolation_period", 32},
      {"encoder.fine_errors.noise", 33},
      {"encoder.fine_errors.missed", 34},
      {"encoder.coarse_errors.eccentricity", 35},
      {"encoder.coarse_errors.eccentricity_angle", 36},
      {"encoder.coarse_errors.interpolation", 37},
      {"encoder.coarse_errors.interpolation_period", 38},
      {"encoder.coarse_errors.noise", 39},
      {"encoder.coarse_errors.missed", 40},
      {"dac.offset", 41},
      {"dac.gain_error", 42},
      {"dac.nonlinearity", 43},
      {"dac.noise", 44},
      {"amplifier.bandwidth", 45},
      {"controller.coarse.kp", 46},
      {"controller.coarse.ki", 47},
      {"controller.coarse.kd", 48},
      {"controller.coarse.fine_within", 49},
      {"controller.coarse.fine_rate", 50},
      {"controller.coarse.fine_dwell", 51},
      {"controller.coarse.coarse_beyond", 52},
      {"command.profile.velocity_limit", 53},
      {"command.profile.acceleration_limit", 54},
      {"command.profile.jerk_limit", 55},
      {"command.torque.rate", 56},
      {"command.sequence.overrun", 57},
      {"initial.velocity", 58},
      {"initial.integral", 59},
      {"initial.history.reversals", 60},
      {"initial.history.torque", 61},
      {"verdict.limit", 62},
      {"friction.model", 3064},
      {"controller.encoder", 3065},
      {"controller.coarse.encoder", 3066},
      {"command.torque.through", 3067},
      {"command.profile.shape", 3068},
      {"initial.mode", 3069},
      {"verdict.stop", 3070},
      {"encoder.resolution", 3071},
      {"encoder.coarse_resolution", 3072},
      {"friction.sigma0", 3073},
      {"friction.sigma1", 3074},
      {"friction.gms.attraction", 3075},
      {"plant.load.inertia", 3076},
      {"plant.load.stiffness", 3077},
      {"plant.load.damping", 3078},
      {"plant.load.encoder", 3079},
      {"plant.load.gap", 3349},
      {"plant.load.damping_to_ground", 3350},
      {"initial.gap", 3351},
      {"disturbance.load.torque", 3352},
      {"plant.load.friction.model", 3353},
      {"plant.load.friction.breakaway", 3354},
      {"plant.load.friction.coulomb_ratio", 3355},
      {"plant.load.friction.stribeck_velocity", 3356},
      {"plant.load.friction.sigma0", 3357},
      {"plant.load.friction.sigma1", 3358},
      {"encoder.load.counts_per_revolution", 3359},
      {"encoder.load.resolution", 3360},
      {"encoder.load.fine_errors.eccentricity", 3361},
      {"encoder.load.fine_errors.eccentricity_angle", 3362},
      {"encoder.load.fine_errors.interpolation", 3363},
      {"encoder.load.fine_errors.interpolation_period", 3364},
      {"encoder.load.fine_errors.noise", 3365},
      {"encoder.load.fine_errors.noise_bandwidth", 3366},
      {"encoder.load.fine_errors.missed", 3367},
      {"controller.cascade.position", 3368},
      {"controller.cascade.velocity", 3369},
      {"initial.load_encoder_phase", 3370},
      {"dac.range", 3080},
      {"controller.structure", 3096},
      {"controller.cascade.kv", 3097},
      {"controller.cascade.kp", 3098},
      {"controller.cascade.ki", 3099},
      {"controller.deadband.enter", 3100},
      {"controller.deadband.leave", 3101},
      {"controller.integrator_zone", 3102},
      {"controller.integrator_leak", 3103},
      {"controller.derivative_cutoff", 3104},
      {"controller.feedforward.velocity", 3105},
      {"controller.feedforward.acceleration", 3106},
      {"controller.feedforward.friction", 3107},
      {"controller.observer.bandwidth", 3108},
      {"controller.observer.inertia", 3109},
      {"controller.coarse.structure", 3128},
      {"controller.coarse.cascade.kv", 3129},
      {"controller.coarse.cascade.kp", 3130},
      {"controller.coarse.cascade.ki", 3131},
      {"controller.coarse.deadband.enter", 3132},
      {"controller.coarse.deadband.leave", 3133},
      {"controller.coarse.integrator_zone", 3134},
      {"controller.coarse.integrator_leak", 3135},
      {"controller.coarse.derivative_cutoff", 3136},
      {"controller.coarse.feedforward.velocity", 3137},
      {"controller.coarse.feedforward.acceleration", 3138},
      {"controller.coarse.feedforward.friction", 3139},
      {"controller.coarse.observer.bandwidth", 3140},
      {"controller.coarse.observer.inertia", 3141},
      {"controller.coarse.error_deadband.band", 3081},
      {"controller.coarse.error_deadband.form", 3082},
      {"controller.coarse.hold.enter", 3083},
      {"controller.coarse.hold.leave", 3084},
      {"controller.coarse.hold.dwell", 3085},
      {"controller.coarse.standstill.band", 3086},
      {"controller.coarse.standstill.dwell", 3087},
      {"controller.coarse.standstill.kp", 3088},
      {"controller.coarse.standstill.ki", 3089},
      {"controller.coarse.standstill.kd", 3090},
      {"dac.sigma_delta", 3091},
      {"encoder.fine_errors.noise_bandwidth", 3092},
      {"encoder.coarse_errors.noise_bandwidth", 3093},
      {"disturbance.torque", 3094},
      {"initial.holding", 3095},
      {"controller.error_deadband.band", 3110},
      {"controller.error_deadband.form", 3111},
      {"controller.hold.enter", 3112},
      {"controller.hold.leave", 3113},
      {"controller.hold.dwell", 3114},
      {"controller.standstill.band", 3115},
      {"controller.standstill.dwell", 3116},
      {"controller.standstill.kp", 3117},
      {"controller.standstill.ki", 3118},
      {"controller.standstill.kd", 3119},
      {"controller.dither.amplitude", 3120},
      {"controller.dither.frequency", 3121},
      {"controller.missed", 3122},
      {"controller.jitter", 3123},
      {"friction.measured.creep.torque", 3332},
      {"friction.measured.creep.extension", 3333},
      {"friction.measured.creep.rate", 3334},
      {"friction.measured.creep.exponent", 3335},
      {"friction.measured.initial_stiffness", 3336},
      {"friction.measured.secant_stiffness", 3337},
      {"friction.measured.secant_travel", 3338},
      {"friction.measured.final_stiffness", 3339},
      {"friction.measured.breakaway", 3340},
      {"friction.measured.breakaway_travel", 3341},
      {"controller.derivative_window", 3342},
      {"controller.cascade.feedforward", 3343},
      {"controller.cascade.divider", 3344},
      {"controller.cascade.latency", 3345},
      {"controller.cascade.resolution", 3346},
      {"controller.cascade.limit", 3347},
      {"amplifier.limit", 3348},
      {"command.profile.amplitude", 3124},
      {"command.profile.frequency", 3125},
      {"verdict.motion", 3126},
      {"verdict.rest_band", 3127},
  };
  std::size_t checked = 0;
  for (const parameters::Parameter& parameter : parameters::parameter_table()) {
    if (!parameters::has_value(parameter)) continue;
    const auto known = fixed.find(parameter.name);
    ASSERT_NE(known, fixed.end()) << parameter.name << " is new: add it here";
    EXPECT_EQ(parameter.sobol_dimension, known->second) << parameter.name;
    ++checked;
  }
  EXPECT_EQ(checked, fixed.size());
}

}  // namespace
}  // namespace zerocount::designs
