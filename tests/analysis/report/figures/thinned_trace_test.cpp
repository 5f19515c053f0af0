#include "analysis/report/figures/report_figures.hpp"
#include "tests/support/test.hpp"

namespace zerocount::report {
namespace {

/// A line of counts that mostly rests, with jerks of one sample here and there.
std::vector<trial::SampleRecord> random_samples(std::uint64_t seed, std::int64_t size) {
  std::mt19937_64 random(seed);
  std::vector<trial::SampleRecord> samples;
  std::int64_t count = 0;
  for (std::int64_t k = 0; k < size; ++k) {
    if (random() % 50 == 0) count += static_cast<std::int64_t>(random() % 7) - 3;
    trial::SampleRecord sample;
    sample.k = k;
    sample.t = static_cast<double>(k) / 2000.0;
    sample.count = count + (random() % 100 == 0 ? 1 : 0);
    sample.error = 10 - sample.count;
    sample.target = 10;
    sample.torque = 1e-4 * static_cast<double>(sample.error);
    samples.push_back(sample);
  }
  return samples;
}

std::vector<trial::SampleRecord> thinned(const std::vector<trial::SampleRecord>& samples,
                                         std::int64_t buckets) {
  TraceThinner thinner(std::ssize(samples), buckets);
  for (const trial::SampleRecord& sample : samples) thinner.add(sample);
  return thinner.finish();
}

/// The value of the step line through `samples` at sample k.
std::int64_t at(const std::vector<trial::SampleRecord>& samples, std::int64_t k) {
  const auto after =
      std::upper_bound(samples.begin(), samples.end(), k,
                       [](std::int64_t at, const trial::SampleRecord& sample) { return at < sample.k; });
  return (after - 1)->error;
}

TEST(TraceThinner, KeepsTheStepLineWhereThereIsRoomForAllOfIt) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<trial::SampleRecord> samples = random_samples(seed, 500);
    const std::vector<trial::SampleRecord> kept = thinned(samples, 500);
    EXPECT_LT(kept.size(), samples.size());
    for (const trial::SampleRecord& sample : samples)
      ASSERT_EQ(at(kept, sample.k), sample.error) << seed << " " << sample.k;
  }
}

TEST(TraceThinner, KeepsTheExtremesOfEveryStretch) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<trial::SampleRecord> samples = random_samples(seed, 10000);
    const std::vector<trial::SampleRecord> kept = thinned(samples, 100);
    EXPECT_LE(kept.size(), 600U);
    EXPECT_EQ(kept.front().k, 0);
    EXPECT_EQ(kept.back().k, 9999);
    for (std::int64_t stretch = 0; stretch < 100; ++stretch) {
      const auto begin = samples.begin() + stretch * 100;
      const auto by_error = [](const trial::SampleRecord& a, const trial::SampleRecord& b) {
        return a.error < b.error;
      };
      const auto [least, most] = std::minmax_element(begin, begin + 100, by_error);
      std::int64_t low = at(kept, stretch * 100);
      std::int64_t high = low;
      for (const trial::SampleRecord& sample : kept) {
        if (sample.k / 100 != stretch) continue;
        low = std::min(low, sample.error);
        high = std::max(high, sample.error);
      }
      ASSERT_EQ(low, least->error) << seed;
      ASSERT_EQ(high, most->error) << seed;
    }
  }
}

TEST(TraceThinner, OfRestOnlyTheEndsAreKept) {
  std::vector<trial::SampleRecord> samples(1000);
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k].k = static_cast<std::int64_t>(k);
  EXPECT_EQ(thinned(samples, 50).size(), 2U);
  EXPECT_TRUE(thinned({}, 50).empty());
}

}  // namespace
}  // namespace zerocount::report
