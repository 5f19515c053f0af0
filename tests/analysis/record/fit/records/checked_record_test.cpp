// What a record must be, and the reason that is given where it is not.
#include "analysis/record/fit/records/checked_record.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "core/failure/failure.hpp"
#include "core/plant/plant.hpp"
#include "tests/analysis/record/fit/presliding/material_tests.hpp"

namespace zerocount::testing {
namespace {

constexpr double count_size = 2.0 * std::numbers::pi / 1.62e6;

/// A record that is accepted: the paper's machine, loaded and unloaded slowly, with a hold.
fit::RawSeries good_series() {
  TorqueProgramme programme;
  programme.ramp(0.1, 0.4).ramp(-0.1, 0.4).ramp(0.15, 0.4).hold(0.2).ramp(0.0, 0.4);
  std::mt19937_64 random(1);
  fit::ContactParameters contact;
  contact.friction.beta = 2.0e5;  // stiff enough that a clipped end of a ramp stands out
  const fit::TestRecord record = simulated_test(contact, programme, {}, random);
  fit::RawSeries series;
  series.name = "good.csv";
  for (std::size_t k = 0; k < fit::sample_count(record); ++k) {
    series.lines.push_back(k + 2);
    series.time.push_back(5e-4 * static_cast<double>(k));
    series.torque.push_back(record.torque[k].now);
    series.angle.push_back(record.reading[k]);
  }
  series.count_size = count_size;
  return series;
}

/// The message with which the series is refused once `spoil` has changed it.
std::string record_refusal(const std::function<void(fit::RawSeries&)>& spoil,
                           fit::RawSeries series = good_series()) {
  spoil(series);
  try {
    fit::checked_record(series, false);
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::bad_data);
    return failure.what();
  }
  return "not refused";
}

/// Whether the message of a refused record begins with `place` and contains `reason`.
::testing::AssertionResult refused(const std::string& message, const std::string& place,
                                   const std::string& reason) {
  if (message.starts_with(place + ": ") && message.find(reason) != std::string::npos) {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure() << message;
}

/// The record with angles in rad instead of counts, as an encoder without steps would give it.
fit::RawSeries in_radians(fit::RawSeries series) {
  for (double& angle : series.angle) angle *= count_size;
  series.count_size = 0.0;
  return series;
}

TEST(CheckedRecord, KeepsAGoodSeries) {
  const fit::RawSeries series = good_series();
  const fit::TestRecord record = fit::checked_record(series, false);
  EXPECT_TRUE(record.counted);
  EXPECT_EQ(record.reading, series.angle);
  EXPECT_NEAR(record.sample_time, 5e-4, 1e-15);
  EXPECT_EQ(record.unit, count_size);
  for (std::size_t k = 0; k < fit::sample_count(record); ++k) {
    EXPECT_TRUE(motion::is_constant(record.torque[k]));
    EXPECT_EQ(record.torque[k].now, series.torque[k]);
  }
}

TEST(CheckedRecord, TimeMustRise) {
  EXPECT_TRUE(refused(record_refusal([](fit::RawSeries& s) { s.time[100] = s.time[99]; }), "good.csv:102",
                      "does not come after"));
  EXPECT_TRUE(refused(record_refusal([](fit::RawSeries& s) { s.time[100] = -1.0; }), "good.csv:102",
                      "does not come after"));
}

TEST(CheckedRecord, UnevenSamplesKeepTheirInstants) {
  const auto jittered = [](double proportion) {
    fit::RawSeries series = good_series();
    for (std::size_t k = 1; k + 1 < series.time.size(); k += 2) series.time[k] += proportion * 5e-4;
    return series;
  };
  // Half of the jitter is off the grid between; a quarter of an interval is taken for that of the clock.
  EXPECT_TRUE(fit::checked_record(jittered(0.1), false).intervals.empty());
  EXPECT_TRUE(fit::checked_record(jittered(0.45), false).intervals.empty());
  const fit::TestRecord uneven = fit::checked_record(jittered(0.6), false);
  ASSERT_EQ(uneven.intervals.size(), uneven.reading.size());
  EXPECT_NEAR(uneven.intervals[2], 1.6 * 5e-4, 1e-12);
  EXPECT_NEAR(uneven.intervals[3], 0.4 * 5e-4, 1e-12);
  EXPECT_NEAR(uneven.sample_time, 5e-4, 1e-9);
}

TEST(CheckedRecord, GapsAndCoincidentSamplesAreRefused) {
  EXPECT_TRUE(refused(record_refusal([](fit::RawSeries& s) { s.time[700] += 0.95 * 5e-4; }), "good.csv:702",
                      "Are samples missing?"));
  EXPECT_TRUE(refused(record_refusal([](fit::RawSeries& s) {
                        s.time[700] += 0.74 * 5e-4;
                        s.time[701] -= 0.2 * 5e-4;
                      }),
                      "good.csv:703", "expected 0.1 at least"));

  // A sample that is missing anywhere inside.
  for (const std::size_t missing : {10, 500, 1500}) {
    const std::string message = record_refusal([missing](fit::RawSeries& s) {
      const auto at = static_cast<std::ptrdiff_t>(missing);
      s.time.erase(s.time.begin() + at);
      s.torque.erase(s.torque.begin() + at);
      s.angle.erase(s.angle.begin() + at);
      s.lines.erase(s.lines.begin() + at);
    });
    EXPECT_TRUE(refused(message, "good.csv:" + std::to_string(missing + 3), "Are samples missing?"));
  }
}

TEST(CheckedRecord, MustBeLongEnough) {
  const std::string message = record_refusal([](fit::RawSeries& s) {
    s.time.resize(99);
    s.torque.resize(99);
    s.angle.resize(99);
  });
  EXPECT_TRUE(refused(message, "good.csv", "too short: 99 samples"));
}

TEST(CheckedRecord, SomethingMustMove) {
  EXPECT_TRUE(refused(record_refusal([](fit::RawSeries& s) { s.torque.assign(s.torque.size(), 0.0); }),
                      "good.csv", "the torque is 0 throughout"));
  EXPECT_TRUE(refused(record_refusal([](fit::RawSeries& s) { s.angle.assign(s.angle.size(), 7.0); }),
                      "good.csv", "the angle is constant"));
  EXPECT_TRUE(refused(record_refusal([](fit::RawSeries& s) {
                        for (double& angle : s.angle) angle = std::floor(angle / 400.0);
                        s.count_size *= 400.0;
                      }),
                      "good.csv", "counts only"));
}

TEST(CheckedRecord, TorqueAndAngleMustAgreeInSign) {
  EXPECT_TRUE(refused(record_refusal([](fit::RawSeries& s) {
                        for (double& angle : s.angle) angle = -angle;
                      }),
                      "good.csv", "wrong sign"));
}

TEST(CheckedRecord, ASingleOutlierIsNamed) {
  for (const double off : {-500.0, -30.0, 30.0, 500.0}) {
    EXPECT_TRUE(refused(record_refusal([off](fit::RawSeries& s) { s.angle[1234] += off; }), "good.csv:1236",
                        "probably a read error"));
  }
}

// A counter that was set, or that wraps by a number nobody gave, is not a motion.
TEST(CheckedRecord, AJumpOfTheReadingsIsNamed) {
  for (const double jump : {-4e3, 1e4}) {
    const auto set = [jump](fit::RawSeries& s) {
      for (std::size_t k = 1234; k < s.angle.size(); ++k) s.angle[k] += jump;
    };
    EXPECT_TRUE(refused(record_refusal(set), "good.csv:1236", "the angle jumps by"));
    const std::string masked = record_refusal([&](fit::RawSeries& s) {
      set(s);
      s.excluded.assign(s.angle.size(), false);
      s.excluded[1234] = true;
    });
    EXPECT_EQ(masked.find("jumps by"), std::string::npos) << masked;
  }
}

TEST(CheckedRecord, CountsMustBeWhole) {
  EXPECT_TRUE(refused(record_refusal([](fit::RawSeries& s) { s.angle[5] = 0.5; }), "good.csv:7",
                      "not a whole number"));
}

// What a thousandfold error makes of each quantity is refused, in either direction, and kept where it is
// asked for.
TEST(CheckedRecord, UnitsWrongByAFactorOfAThousandAreRefused) {
  const auto times = [](std::vector<double> fit::RawSeries::*values, double factor) {
    return [values, factor](fit::RawSeries& s) {
      for (double& value : s.*values) value *= factor;
    };
  };
  const fit::RawSeries radians = in_radians(good_series());
  for (const double factor : {1e3, 1e-3}) {
    EXPECT_TRUE(refused(record_refusal(times(&fit::RawSeries::torque, factor)), "good.csv", "plausible"))
        << factor;
    EXPECT_TRUE(
        refused(record_refusal(times(&fit::RawSeries::angle, factor), radians), "good.csv", "plausible"))
        << factor;
    EXPECT_TRUE(refused(record_refusal([factor](fit::RawSeries& s) { s.count_size *= factor; }), "good.csv",
                        "plausible"))
        << factor;
  }
  EXPECT_TRUE(refused(record_refusal(times(&fit::RawSeries::time, 1e3)), "good.csv", "is the time in ms"));
  fit::RawSeries millinewtons = good_series();
  for (double& torque : millinewtons.torque) torque *= 1e3;
  EXPECT_NO_THROW(fit::checked_record(millinewtons, true));
}

TEST(CheckedRecord, ARecordIsCutWhereItBeginsToSlide) {
  fit::RawSeries series = good_series();
  series.sliding.assign(series.time.size(), false);
  series.sliding[1321] = true;
  const fit::TestRecord record = fit::checked_record(series, false);
  EXPECT_EQ(fit::sample_count(record), 1321u);
  EXPECT_EQ(record.torque.size(), 1321u);
  EXPECT_EQ(record.note, "cut at 0.6605 s, where the axis breaks away and slides");
  EXPECT_TRUE(refused(record_refusal([](fit::RawSeries& s) {
                        s.sliding.assign(s.time.size(), false);
                        s.sliding[21] = true;
                      }),
                      "good.csv:23", "breaks away"));
}

// The torque of a loop that moves a sliding axis to and fro: against friction, and ahead of the motion.
TEST(CheckedRecord, ASlidingAxisIsRefusedWithTheOptionForIt) {
  const auto sliding = [](fit::RawSeries& s) {
    constexpr double period = 400.0;  // samples
    for (std::size_t k = 0; k < s.time.size(); ++k) {
      const double phase = 2.0 * std::numbers::pi * static_cast<double>(k) / period;
      s.angle[k] = std::round(4000.0 * (1.0 - std::cos(phase)));
      s.torque[k] = 0.02 * (std::sin(phase) > 0.0 ? 1.0 : -1.0) + 0.1 * std::cos(phase);
    }
  };
  EXPECT_TRUE(refused(record_refusal(sliding), "good.csv", "--sliding identifies a sliding axis"));
}

// Masked readings may be anything; the straight line in their place is not fitted.
TEST(CheckedRecord, MaskedReadingsAreBridged) {
  fit::RawSeries series = good_series();
  for (std::size_t k = 500; k < 520; ++k) series.angle[k] = 1e6;
  EXPECT_TRUE(records::exclude(series, {500 * 5e-4 - 1e-9, 519 * 5e-4 + 1e-9}));
  const fit::TestRecord record = fit::checked_record(series, false);
  EXPECT_EQ(fit::used_samples(record), series.time.size() - 20);
  for (std::size_t k = 499; k < 520; ++k) {
    EXPECT_LE(std::abs(record.reading[k + 1] - record.reading[k]), 20.0) << k;
    EXPECT_EQ(fit::is_excluded(record, k), k >= 500) << k;
  }
}

// The torque that was recorded is cut off, the one that acted was not.
TEST(CheckedRecord, ClippedTorqueIsNamed) {
  for (const double limit : {0.05, 0.08, 0.12, 0.14}) {
    const std::string message = record_refusal([limit](fit::RawSeries& s) {
      for (double& torque : s.torque) torque = std::clamp(torque, -limit, limit);
    });
    EXPECT_NE(message.find("the torque is clipped"), std::string::npos) << limit << ": " << message;
  }
}

TEST(CheckedRecord, CodesAtTheEndOfTheRangeAreClipping) {
  const auto saturated = [](double code, int bits) {
    return [code, bits](fit::RawSeries& s) {
      s.dac_bits = bits;
      s.code.assign(s.time.size(), 0.0);
      for (std::size_t k = 50; k < 60; ++k) s.code[k] = code;
    };
  };
  EXPECT_TRUE(refused(record_refusal(saturated(2047, 12)), "good.csv:54", "end of its range"));
  EXPECT_TRUE(refused(record_refusal(saturated(-2048, 12)), "good.csv:54", "end of its range"));
  EXPECT_TRUE(refused(record_refusal(saturated(32767, 0)), "good.csv:54", "if it has 16 bits"));
  EXPECT_EQ(record_refusal(saturated(2047, 16)), "not refused");
  EXPECT_EQ(record_refusal(saturated(127, 0)), "not refused");
  EXPECT_TRUE(refused(record_refusal(saturated(2048, 12)), "good.csv:52", "beyond the DAC's 12 bits"));

  // The end of a shorter word's range is none where other codes lie beyond it.
  const auto with_larger = [&](fit::RawSeries& s) {
    saturated(-2048, 0)(s);
    s.code[200] = 3000;
  };
  EXPECT_EQ(record_refusal(with_larger), "not refused");
}

// Holds, ring-downs and creep at the extremes of the torque are no clipping.
TEST(CheckedRecord, HoldsAtTheExtremesAreNotClipping) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 20; ++round) {
    const fit::ContactParameters contact = random_contact(random);
    TorqueProgramme programme;
    programme.step(0.1).hold(0.3).step(-0.1).hold(0.3).ramp(0.12, 0.4).hold(0.5).ramp(-0.12, 2.0).hold(0.3);
    const fit::TestRecord record = simulated_test(contact, programme, {}, random);
    fit::RawSeries series;
    for (std::size_t k = 0; k < fit::sample_count(record); ++k) {
      series.time.push_back(5e-4 * static_cast<double>(k));
      series.torque.push_back(record.torque[k].now);
      series.angle.push_back(record.reading[k]);
    }
    series.count_size = count_size;
    EXPECT_NO_THROW(fit::checked_record(series, false)) << round;
  }
}

TEST(CheckedRecord, CountsWrittenInRadAreRecognised) {
  fit::RawSeries series = in_radians(good_series());
  const fit::TestRecord exact = fit::checked_record(series, false);
  EXPECT_TRUE(exact.counted);
  EXPECT_NEAR(exact.unit, count_size, 1e-12 * exact.unit);
  const fit::RawSeries counts = good_series();
  for (std::size_t k = 0; k < counts.angle.size(); ++k) {
    EXPECT_EQ(exact.reading[k], counts.angle[k] - counts.angle[0]);
  }
  // With seven digits of an angle that is far from 0.
  for (double& angle : series.angle) angle = std::round((angle + 0.01) * 1e9) / 1e9;
  EXPECT_TRUE(fit::checked_record(series, false).counted);
  // A smooth angle is none of an encoder.
  for (std::size_t k = 0; k < series.angle.size(); ++k)
    series.angle[k] += 1e-7 * std::sin(static_cast<double>(k));
  EXPECT_FALSE(fit::checked_record(series, false).counted);
}

TEST(CheckedRecord, ACommandedTorqueActsAfterTheDelay) {
  fit::RawSeries series = good_series();
  series.delay = 3;
  const fit::TestRecord record = fit::checked_record(series, false);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(record.torque[k].now, 0.0);
  for (std::size_t k = 3; k < series.torque.size(); ++k) {
    EXPECT_EQ(record.torque[k].now, series.torque[k - 3]);
  }
}

// The amplifier's lag: from what it was told, or from what it gave at the samples.
TEST(CheckedRecord, TheLagOfAnAmplifierIsIncluded) {
  constexpr double bandwidth = 100.0;
  const double rate = 2.0 * std::numbers::pi * bandwidth;
  fit::RawSeries commanded = good_series();
  commanded.bandwidth = bandwidth;
  fit::RawSeries motor = commanded;
  motor.torque_kind = fit::TorqueKind::motor;
  double now = 0.0;
  for (std::size_t k = 0; k < commanded.torque.size(); ++k) {
    motor.torque[k] = now;
    now = motion::course_after({now, commanded.torque[k], rate}, 5e-4).now;
  }
  const fit::TestRecord told = fit::checked_record(commanded, false);
  const fit::TestRecord given = fit::checked_record(motor, false);
  for (std::size_t k = 0; k + 1 < told.torque.size(); ++k) {
    EXPECT_NEAR(told.torque[k].now, motor.torque[k], 1e-12);
    EXPECT_NEAR(given.torque[k].now, motor.torque[k], 1e-12);
    EXPECT_NEAR(told.torque[k].settled, commanded.torque[k], 1e-12);
    EXPECT_NEAR(given.torque[k].settled, commanded.torque[k], 1e-11);
    EXPECT_EQ(given.torque[k].rate, rate);
  }
}

}  // namespace
}  // namespace zerocount::testing
