// The figures of an identification: what is drawn of a record is what the fit left of it.
#include "analysis/record/fit/presliding/identification.hpp"
#include "analysis/report/figures/answer_figures.hpp"
#include "analysis/report/page.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using fit::FittedRecord;
using fit::Identification;
using nlohmann::ordered_json;

/// A random fitted record in counts with noise, outliers of one sample, and some masked stretches (samples
/// that the fit leaves out).
FittedRecord random_record(std::uint64_t seed, std::size_t samples, bool masked) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  FittedRecord record;
  bool excluded = false;
  for (std::size_t k = 0; k < samples; ++k) {
    if (masked && uniform(random) < 0.02) excluded = !excluded;
    const double phase = 0.01 * static_cast<double>(k);
    record.time.push_back(3.0 + 5e-4 * static_cast<double>(k));
    record.torque.push_back(0.1 * std::sin(phase) + (uniform(random) < 0.01 ? 0.05 : 0.0));
    record.fitted.push_back(1e6 + 200.0 * std::sin(phase - 0.3));
    record.reading.push_back(std::round(record.fitted.back() + (uniform(random) < 0.01 ? 7.0 : 0.0)));
    record.excluded.push_back(excluded);
  }
  return record;
}

/// The page of `identify --plot`.
std::string page_of(const Identification& found) {
  document::AnswerDescription<Identification> answer = fit::identification_answer();
  answer.items.figures(report::identification_figures);
  return report::html_page(report::answer_page(answer.of(found)));
}

/// An identification with these records of counts, without parameters.
Identification identification_of(std::vector<FittedRecord> records) {
  Identification found;
  for (const FittedRecord& record : records) {
    fit::RecordSummary& summary = found.records.emplace_back();
    summary.name = "test " + std::to_string(found.records.size());
    summary.samples = record.time.size();
    summary.duration = record.time.back() - record.time.front();
    summary.counted = true;
    summary.unit = 4e-6;
    summary.excluded =
        static_cast<std::size_t>(std::count(record.excluded.begin(), record.excluded.end(), true));
  }
  found.fitted = std::move(records);
  return found;
}

/// The figures in the page's data.
ordered_json figures_in(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"figures\">";
  const std::size_t first = page.find(begin) + begin.size();
  return ordered_json::parse(page.substr(first, page.find("</script>", first) - first))["figures"];
}

/// The column of a field in the rows of a dataset of a figure.
std::vector<ordered_json> column_of(const ordered_json& figure, std::size_t dataset,
                                    const std::string& field) {
  const ordered_json& data = figure["data"][dataset];
  std::vector<ordered_json> values;
  for (std::size_t i = 0; i < data["columns"].size(); ++i) {
    if (data["columns"][i][0] != field) continue;
    for (const ordered_json& row : data["rows"]) values.push_back(row[i]);
  }
  return values;
}

TEST(ExtremeSamples, IncludeTheEnds) {
  const std::vector<double> values{3, 5, 1, 2, 9, 4, 4};
  const auto value = [&](std::size_t k) { return values[k]; };
  EXPECT_EQ(report::extreme_samples(0, 7, {value}), (std::vector<std::size_t>{0, 2, 4, 6}));
  EXPECT_EQ(report::extreme_samples(2, 5, {value}), (std::vector<std::size_t>{2, 4}));
  EXPECT_EQ(report::extreme_samples(3, 4, {value}), (std::vector<std::size_t>{3}));
  EXPECT_TRUE(report::extreme_samples(3, 3, {value}).empty());
}

// A peak of one sample must stay visible, and so must each end of a masked interval.
TEST(DrawnSamples, KeepTheExtremesAndTheMasks) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const FittedRecord record = random_record(seed, 10000, seed % 2 == 0);
    const std::vector<std::size_t> drawn = report::drawn_samples(record, 100);
    EXPECT_EQ(drawn.front(), 0U);
    EXPECT_EQ(drawn.back(), 9999U);
    EXPECT_TRUE(std::is_sorted(drawn.begin(), drawn.end()));
    EXPECT_EQ(std::adjacent_find(drawn.begin(), drawn.end()), drawn.end());
    if (seed % 2 == 1) {
      EXPECT_LE(drawn.size(), 1000U);
    }
    for (std::size_t k = 1; k < record.time.size(); ++k) {
      if (record.excluded[k] == record.excluded[k - 1]) continue;
      ASSERT_TRUE(std::binary_search(drawn.begin(), drawn.end(), k)) << seed;
      ASSERT_TRUE(std::binary_search(drawn.begin(), drawn.end(), k - 1)) << seed;
    }
    const auto largest = [&](auto quantity, std::size_t group, bool masked) {
      std::pair<double, double> of_all{-1e300, -1e300};
      for (std::size_t k = 100 * group; k < 100 * group + 100; ++k) {
        if (record.excluded[k] != masked) continue;
        of_all.first = std::max(of_all.first, quantity(k));
        if (std::binary_search(drawn.begin(), drawn.end(), k))
          of_all.second = std::max(of_all.second, quantity(k));
      }
      return of_all;
    };
    const std::vector<report::SampleQuantity> quantities{[&](std::size_t k) { return record.torque[k]; },
                                                         [&](std::size_t k) { return -record.torque[k]; },
                                                         [&](std::size_t k) { return record.reading[k]; },
                                                         [&](std::size_t k) { return -record.reading[k]; },
                                                         [&](std::size_t k) { return record.fitted[k]; },
                                                         [&](std::size_t k) { return -record.fitted[k]; },
                                                         [&](std::size_t k) { return residual(record, k); },
                                                         [&](std::size_t k) { return -residual(record, k); }};
    for (std::size_t i = 0; i < quantities.size(); ++i) {
      for (std::size_t group = 0; group < 100; ++group) {
        for (const bool masked : {false, true}) {
          const auto [all, kept] = largest(quantities[i], group, masked);
          ASSERT_EQ(all, kept) << seed << " " << i << " " << group << " " << masked;
        }
      }
    }
  }
}

TEST(IdentificationPage, HasTheDataOfEachRecord) {
  const Identification found =
      identification_of({random_record(1, 300, false), random_record(2, 5000, false)});
  const ordered_json figures = figures_in(page_of(found));
  ASSERT_EQ(figures.size(), 2U);
  for (std::size_t r = 0; r < figures.size(); ++r) {
    const FittedRecord& record = found.fitted[r];
    const auto times = column_of(figures[r], 0, "time");
    const auto readings = column_of(figures[r], 0, "reading");
    const auto fitted = column_of(figures[r], 0, "fitted");
    const auto residuals = column_of(figures[r], 0, "residual");
    const auto torques = column_of(figures[r], 0, "torque");
    if (r == 0) {
      EXPECT_EQ(times.size(), 300U) << "a short record is drawn whole";
    }
    for (std::size_t i = 0; i < times.size(); ++i) {
      const auto k = static_cast<std::size_t>(std::lround((times[i].get<double>() - 3.0) / 5e-4));
      ASSERT_EQ(readings[i].get<double>(), record.reading[k]);
      ASSERT_NEAR(fitted[i].get<double>(), record.fitted[k], 0.01);
      ASSERT_NEAR(torques[i].get<double>(), record.torque[k], 1e-6);
      ASSERT_NEAR(residuals[i].get<double>(), record.reading[k] - record.fitted[k], 1e-5);
    }
    EXPECT_TRUE(figures[r]["data"][1]["rows"].empty());
    EXPECT_EQ(figures[r]["data"][2]["rows"], ordered_json::parse("[[-0.5, 0.5]]"));
    EXPECT_FALSE(figures[r]["parameters"].contains("masked"));
  }
}

// A masked reading is drawn apart, has no residual, and does not set the scale.
TEST(IdentificationPage, ShowsMaskedReadingsApart) {
  FittedRecord record = random_record(3, 400, false);
  for (std::size_t k = 100; k < 150; ++k) record.excluded[k] = true;
  record.reading[120] = 9e9;
  const Identification found = identification_of({record});
  const ordered_json figure = figures_in(page_of(found))[0];
  const auto readings = column_of(figure, 0, "reading");
  const auto masked = column_of(figure, 0, "masked");
  const auto residuals = column_of(figure, 0, "residual");
  ASSERT_EQ(readings.size(), 400U);
  for (std::size_t k = 0; k < readings.size(); ++k) {
    EXPECT_EQ(masked[k].is_null(), !record.excluded[k]) << k;
    EXPECT_EQ(readings[k].is_null(), record.excluded[k]) << k;
    EXPECT_EQ(residuals[k].is_null(), record.excluded[k]) << k;
  }
  EXPECT_EQ(masked[120].get<double>(), 9e9);
  ASSERT_EQ(figure["data"][1]["rows"].size(), 1U);
  EXPECT_NEAR(figure["data"][1]["rows"][0][0].get<double>(), record.time[100], 1e-9);
  EXPECT_NEAR(figure["data"][1]["rows"][0][1].get<double>(), record.time[150], 1e-9);
  EXPECT_LT(figure["parameters"]["readings"][1].get<double>(), 2e6);
  EXPECT_EQ(figure["parameters"]["masked"], "masked");
  EXPECT_TRUE(says(report::identification_figures(found)[0].caption, "50 masked samples"));
}

TEST(IdentificationPage, AnglesAreInMicroradians) {
  Identification found = identification_of({random_record(4, 300, false)});
  found.records[0].counted = false;
  found.records[0].unit = 1e-7;
  const report::Figure figure = report::identification_figures(found)[0];
  const double band = report::residual_band(found.records[0], found.fitted[0]);
  EXPECT_NEAR(figure.data[0].rows[0][2].get<double>(), 0.1 * found.fitted[0].reading[0], 1e-3);
  EXPECT_NEAR(figure.data[2].rows[0][1].get<double>() / (0.1 * band), 1.0, 1e-5);
  for (const std::size_t column : {2U, 5U}) EXPECT_EQ(figure.data[0].columns[column].unit, "µrad");
}

// The band is that of the noise, also where the model departs from the record by much more.
TEST(ReadingNoise, ExcludesTheErrorOfTheModel) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal(0.0, 0.3);
  fit::RecordSummary record;
  FittedRecord beside;
  for (std::size_t k = 0; k < 20000; ++k) {
    beside.time.push_back(1e-3 * static_cast<double>(k));
    beside.fitted.push_back(0.0);
    beside.reading.push_back(5.0 * std::sin(1e-3 * static_cast<double>(k)) + normal(random));
    beside.excluded.push_back(k >= 100 && k < 200);
  }
  for (std::size_t k = 100; k < 200; ++k) beside.reading[k] = 1e9;
  EXPECT_NEAR(report::reading_noise(record, beside), 0.3, 0.01);
  EXPECT_NEAR(report::residual_band(record, beside), 1.96 * 0.3, 0.02);
  record.counted = true;
  record.noise = 2.0;
  EXPECT_EQ(report::residual_band(record, beside), 0.5 + 1.96 * 2.0);
}

TEST(IdentificationPage, StatesWhetherTheModelFits) {
  Identification found = identification_of({random_record(5, 300, false)});
  EXPECT_TRUE(says(page_of(found), "the model explains the records"));
  found.checks.passed = false;
  found.checks.spread_chance = 0.002;
  found.checks.spread = 3.0;
  found.checks.expected_spread = 1.0;
  found.checks.widening = 4.5;
  const std::string html = page_of(found);
  EXPECT_TRUE(says(html, "LACK OF FIT: the residuals are 3 times as large", "factor 4.5"));
}

TEST(IdentificationPage, StaysSmall) {
  constexpr std::size_t limit = 5'000'000;  // bytes
  std::vector<FittedRecord> many;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) many.push_back(random_record(seed, 2000, false));
  EXPECT_LT(page_of(identification_of(many)).size(), limit);
  EXPECT_LT(page_of(identification_of({random_record(6, 100000, false)})).size(), limit);
}

}  // namespace
}  // namespace zerocount::testing
