// A record ends where the rotor begins to slide, and nowhere else.
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "analysis/record/fit/presliding/identification.hpp"
#include "analysis/record/fit/records/checked_record.hpp"
#include "core/failure/failure.hpp"
#include "core/plant/plant.hpp"
#include "tests/analysis/record/fit/presliding/material_tests.hpp"

namespace zerocount::testing {
namespace {

fit::RawSeries series_of(const fit::TestRecord& record) {
  fit::RawSeries series;
  series.name = "simulated";
  for (std::size_t k = 0; k < fit::sample_count(record); ++k) {
    series.time.push_back(record.sample_time * static_cast<double>(k));
    series.torque.push_back(record.torque[k].now);
    series.angle.push_back(record.reading[k]);
  }
  series.count_size = record.unit;
  return series;
}

/// Adds noise with a standard deviation of half a count to the readings, before they are rounded to counts.
void add_noise(fit::RawSeries& series, std::mt19937_64& random) {
  std::uniform_real_distribution<double> within_count(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, 0.5);
  for (double& count : series.angle) count = std::floor(count + within_count(random) + noise(random));
}

/// Index of the first sample at which core's plant, driven by the torque of the record, slides; empty if it
/// never slides.
std::optional<std::size_t> breakaway_sample(const fit::ContactParameters& contact,
                                            const fit::TestRecord& record) {
  plant::Plant plant(contact.plant, {contact.friction, {}}, {}, {1e-11 * record.unit});
  for (std::size_t k = 0; k < record.torque.size(); ++k) {
    if (plant.sliding()) return k;
    plant.advance(record.torque[k], record.sample_time);
  }
  return std::nullopt;
}

/// A torque programme of several steps of growing height, the first one small: the torque grows most, and the
/// rotor overshoots.
TorqueProgramme growing_steps(std::mt19937_64& random) {
  std::uniform_real_distribution<double> factor(1.1, 3.0);
  std::uniform_real_distribution<double> duration(0.01, 1.0);
  TorqueProgramme programme;
  programme.hold(0.05);
  for (double torque = 0.01; torque < 0.3; torque *= factor(random)) {
    programme.step(torque).hold(duration(random));
    if (duration(random) < 0.3) programme.step(0.0).hold(duration(random));
  }
  return programme;
}

/// A torque programme: ring-downs, two loops below the breakaway torque, and a ramp beyond it, after which
/// the rotor sticks again.
TorqueProgramme breaking_away(double rate) {
  TorqueProgramme programme;
  for (int i = 0; i < 2; ++i) programme.step(0.03).hold(0.1).step(0.0).hold(0.1);
  programme.ramp(0.08, rate).ramp(-0.08, rate).ramp(0.08, rate).ramp(0.0, rate).ramp(0.15, rate);
  return programme.ramp(0.0, 1.0).hold(0.2).ramp(0.05, rate);
}

/// A random friction contact that breaks away at 0.1 N m, with a random level of sliding friction.
fit::ContactParameters random_breakaway(std::mt19937_64& random) {
  fit::ContactParameters contact = random_contact(random);
  contact.friction.breakaway = 0.1;
  contact.friction.coulomb_ratio = std::uniform_real_distribution<double>(0.5, 1.0)(random);
  return contact;
}

constexpr std::array breakaway_rates{0.1, 0.2, 0.4};

void expect_no_cut(std::uint64_t machines) {
  for (std::uint64_t set = 0; set < machines; ++set) {
    std::mt19937_64 random(set);
    const fit::ContactParameters contact = random_contact(random);
    std::vector<TorqueProgramme> programmes{growing_steps(random)};
    for (const auto& protocol : {three_tests(), one_test(), short_test()}) {
      programmes.insert(programmes.end(), protocol.begin(), protocol.end());
    }
    TestInstrument instrument;
    instrument.skew = set % 2 == 0 ? 0.0 : 3.0;
    for (std::size_t i = 0; i < programmes.size(); ++i) {
      fit::RawSeries series = series_of(simulated_test(contact, programmes[i], instrument, random));
      EXPECT_FALSE(fit::find_gross_sliding(series)) << "machine " << set << ", programme " << i;
      add_noise(series, random);
      EXPECT_FALSE(fit::find_gross_sliding(series)) << "machine " << set << ", noisy programme " << i;
    }
  }
}

TEST(GrossSliding, TestsBelowBreakawayAreNotCut) {
  expect_no_cut(12);
}

TEST(GrossSliding, DISABLED_TestsBelowBreakawayOfManyMachinesAreNotCut) {
  expect_no_cut(60);
}

TEST(GrossSliding, TheCutIsShortlyBeforeBreakaway) {
  for (std::uint64_t set = 0; set < 30; ++set) {
    std::mt19937_64 random(set);
    const fit::ContactParameters contact = random_breakaway(random);
    TestInstrument instrument;
    instrument.noise = set % 2 == 0 ? 0.0 : 0.5;
    const TorqueProgramme programme = breaking_away(breakaway_rates.at(set % 3));
    const fit::TestRecord record = simulated_test(contact, programme, instrument, random);
    const std::optional<std::size_t> truth = breakaway_sample(contact, record);
    ASSERT_TRUE(truth) << set;
    const auto sliding = fit::find_gross_sliding(series_of(record));
    ASSERT_TRUE(sliding) << set;
    EXPECT_LE(sliding->first, *truth) << set;
    EXPECT_GE(sliding->first + 50, *truth) << set;
  }
}

/// A made-up record: slow loading to 0.1 N m within 0.25 s, and from sample `breakaway` on a slide with the
/// acceleration of `acceleration` counts per sample².
fit::RawSeries made_slide(std::size_t breakaway, double acceleration) {
  TorqueProgramme programme;
  programme.ramp(0.1, 0.4);
  std::mt19937_64 random(3);
  fit::RawSeries series = series_of(simulated_test(fit::ContactParameters{}, programme, {}, random));
  for (std::size_t k = breakaway; k < series.angle.size(); ++k) {
    const auto after = static_cast<double>(k - breakaway);
    series.angle[k] += std::round(0.5 * acceleration * after * after);
  }
  return series;
}

TEST(GrossSliding, TooEarlyABreakawayIsRefused) {
  try {
    fit::checked_record(made_slide(80, 100.0), false);
    FAIL();
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_data);
    EXPECT_NE(std::string(failure.what()).find("expected 100 before it"), std::string::npos)
        << failure.what();
    EXPECT_NE(std::string(failure.what()).find("--sliding"), std::string::npos) << failure.what();
  }
  EXPECT_GE(fit::sample_count(fit::checked_record(made_slide(300, 100.0), false)), 250u);
}

TEST(GrossSliding, TheSlidingFlagOfAFileDecides) {
  fit::RawSeries series = made_slide(300, 100.0);
  series.sliding.assign(series.time.size(), false);
  EXPECT_TRUE(fit::checked_record(series, true).note.empty());
}

TEST(GrossSliding, AJumpOfTheReadingIsNotTakenForSliding) {
  for (const double leap : {-1e5, 1e5}) {
    fit::RawSeries series = made_slide(499, 0.0);
    for (std::size_t k = 300; k < series.angle.size(); ++k) series.angle[k] += leap;
    EXPECT_FALSE(fit::find_gross_sliding(series));
    EXPECT_TRUE(fit::find_gross_sliding(made_slide(300, std::copysign(100.0, leap))));
  }
}

TEST(GrossSliding, MaskedReadingsAreNotTakenForSliding) {
  fit::RawSeries series = made_slide(400, 100.0);
  EXPECT_TRUE(fit::find_gross_sliding(series));
  EXPECT_TRUE(records::exclude(series, {399 * 5e-4, 1.0}));
  EXPECT_FALSE(fit::find_gross_sliding(series));
}

// The samples before the breakaway give k1.
TEST(GrossSliding, TheRestOfTheRecordIsIdentified) {
  for (std::uint64_t set = 0; set < 2; ++set) {
    std::mt19937_64 random(set);
    const fit::ContactParameters contact = random_breakaway(random);
    const fit::TestRecord record = simulated_test(contact, breaking_away(0.4), {}, random);
    const fit::TestRecord part = fit::checked_record(series_of(record), false);
    EXPECT_NE(part.note.find("begins to slide"), std::string::npos) << part.note;
    const fit::Identification found = fit::identify({part}, {{}, 100});
    const fit::ParameterEstimate& k1 = found.parameters.front();
    ASSERT_EQ(k1.name, "k1");
    const double truth = contact.friction.k1;
    EXPECT_TRUE((k1.low <= truth && truth <= k1.high) || std::abs(k1.value / truth - 1.0) < 0.03)
        << set << ": " << k1.value << ", truth " << truth;
  }
}

}  // namespace
}  // namespace zerocount::testing
