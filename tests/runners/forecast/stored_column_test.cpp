// What a column will take in the file, from few of its elements.
#include "runners/forecast/stored_column.hpp"

#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using forecast::ColumnSample;
using forecast::sampled_places;
using forecast::stored_bytes;

constexpr std::size_t count = 60'000;

template <class Value>
constexpr hdf5::Element element_of = std::is_same_v<Value, double>
                                         ? hdf5::Element::float64
                                         : (sizeof(Value) == 8 ? hdf5::Element::int64 : hdf5::Element::int8);

/// Estimate of the stored bytes of the column, from 512 elements, beside what it takes.
template <class Value>
void expect_estimate(const std::string& name, const std::vector<Value>& column, double period = 0.0,
                     const std::function<std::int64_t(std::int64_t)>& twin_of = {}) {
  std::vector<Value> sample;
  for (std::size_t place = 0; place < sampled_places; ++place) {
    const auto first = column.begin() + static_cast<std::ptrdiff_t>(column.size() / sampled_places * place);
    sample.insert(sample.end(), first, first + 64);
  }
  constexpr hdf5::Element element = element_of<Value>;
  const double stored = stored_bytes(element, std::as_bytes(std::span(column)));
  const double estimate = stored_bytes(ColumnSample{element, std::as_bytes(std::span(sample)), period},
                                       static_cast<double>(column.size()), twin_of);
  // The smallest columns weigh nothing in a file.
  EXPECT_NEAR(estimate, stored, 0.1 * stored + 2000.0) << name;
}

template <class Value>
std::vector<Value> column_of(const std::function<Value(std::size_t)>& value) {
  std::vector<Value> column;
  for (std::size_t i = 0; i < count; ++i) column.push_back(value(i));
  return column;
}

TEST(StoredColumn, OfRandomNumbersIsEstimatedWithinATenth) {
  std::mt19937_64 random(10);
  const auto uniform = [&] { return std::uniform_real_distribution<double>(0.0, 1.0)(random); };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_estimate("uniform", column_of<double>([&](std::size_t) { return uniform(); }));
  expect_estimate("lognormal", column_of<double>([&](std::size_t) {
                    return 110.0 * std::exp(std::normal_distribution<double>(0.0, 0.3)(random));
                  }));
  expect_estimate("times of samples",
                  column_of<double>([&](std::size_t) { return 0.00025 * std::floor(600.0 * uniform()); }));
  expect_estimate("counts", column_of<double>([&](std::size_t) { return std::floor(40.0 * uniform()); }));
  expect_estimate("mostly none",
                  column_of<double>([&](std::size_t) { return uniform() < 0.8 ? nan : uniform(); }));
  expect_estimate("of points", column_of<double>([&](std::size_t i) {
                    return static_cast<double>(i / (count / sampled_places)) + 0.1 * uniform();
                  }));
  expect_estimate("whole", column_of<std::int64_t>([&](std::size_t) {
                    return static_cast<std::int64_t>(1e6 * uniform()) - 500'000;
                  }));
  expect_estimate("label", column_of<std::int8_t>(
                               [&](std::size_t) { return static_cast<std::int8_t>(3.0 * uniform()); }));
  expect_estimate("one value", column_of<double>([](std::size_t) { return 4.0; }));
}

// Inputs of machines, and outcomes of the same trial at the next point.
TEST(StoredColumn, ThatRepeatsItselfIsEstimatedWithinATenth) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> of_rigs(500);
  for (double& value : of_rigs) value = uniform(random);
  expect_estimate<double>("rigs", column_of<double>([&](std::size_t i) { return of_rigs[i % 500]; }), 0.0,
                          [](std::int64_t i) { return i % 500; });
  std::vector<double> of_points;
  for (std::size_t i = 0; i < count; ++i)
    of_points.push_back(i >= 20 && uniform(random) < 0.5 ? of_points[i - 20] : uniform(random));
  expect_estimate("points", of_points, 20.0);
}

TEST(StoredColumn, OfAllItsElementsIsExact) {
  std::mt19937_64 random(12);
  std::vector<double> column(300);
  for (double& value : column) value = std::uniform_real_distribution<double>(0.0, 1.0)(random);
  const std::span<const std::byte> bytes = std::as_bytes(std::span(column));
  EXPECT_EQ(stored_bytes(ColumnSample{hdf5::Element::float64, bytes}, 300.0),
            stored_bytes(hdf5::Element::float64, bytes));
  EXPECT_EQ(stored_bytes(ColumnSample{hdf5::Element::float64, {}}, 300.0), 0.0);
}

}  // namespace
}  // namespace zerocount::testing
