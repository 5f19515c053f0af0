// What a run is expected to take of the disk and of memory, beside what it takes.
#include <sys/resource.h>

#include "core/trial/trial.hpp"
#include "experiments/manifest/load_study.hpp"
#include "results/layout/header.hpp"
#include "results/shards/shard.hpp"
#include "runners/forecast/forecast.hpp"
#include "runners/trials/study_runner.hpp"
#include "tests/runners/program.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

double bytes_in(const fs::path& directory) {
  double bytes = 0.0;
  for (const auto& entry : fs::directory_iterator(directory)) bytes += static_cast<double>(entry.file_size());
  return bytes;
}

/// Expects that estimate and measurement differ by at most a factor of 2.
void expect_about(double estimate, double measured, const char* of) {
  EXPECT_GT(estimate, measured / 2.0) << of;
  EXPECT_LT(estimate, measured * 2.0) << of;
}

/// Expects that the estimated size of the file is right to a tenth, or to 1 MB.
void expect_file(double estimate, const fs::path& file) {
  const auto measured = static_cast<double>(fs::file_size(file));
  EXPECT_NEAR(estimate, measured, std::max(0.1 * measured, 1e6));
}

std::vector<std::string> manifests() {
  std::vector<std::string> all{small_manifest(50), small_manifest(5000)};
  std::string records = "retain: {trials: [0";
  for (int trial = 1; trial < 60; ++trial) records += ", " + std::to_string(trial);
  all.push_back(small_manifest(500, records + "]}\n"));
  all.push_back(small_manifest(800, "machines: 50\n"));
  return all;
}

TEST(StudySize, PredictsTheSizeOfTheFiles) {
  for (const std::string& manifest : manifests()) {
    const TemporaryFolder folder;
    folder.write("study.yaml", manifest);
    const study::Study study = manifest::load_study(folder / "study.yaml", {});
    SCOPED_TRACE(manifest);
    const forecast::StudySize size = forecast::measure_size(study);
    fs::create_directory(folder / "shards");
    const std::vector<layout::RowRange> all{layout::all_rows(study)};
    trials::run_trials(study, all, folder / "shards", {}, {});
    expect_about(size.shard_bytes, bytes_in(folder / "shards"), "shards");
    const ProgramResult run = zerocount_program({"run", "study.yaml", "-o", "out.h5"}, folder.path());
    ASSERT_EQ(run.code, 0) << run.err;
    expect_file(size.file_bytes, folder / "out.h5");
  }
}

// Many more machines than trials are tried beforehand. Shards are written by the clock, and not judged.
TEST(StudySize, PredictsTheSizeOfKeptStatistics) {
  for (const std::string& manifest :
       {small_manifest(1500, "keep: statistics\n"), small_manifest(800, "machines: 50\nkeep: failures\n"),
        small_manifest(6000, "machines: 3000\nkeep: statistics\n"), small_manifest(5000, "keep: failures\n"),
        small_manifest(6000,
                       "machines: 60\nworlds: 6\nkeep: statistics\nconditions: {light: {}, heavy: "
                       "{plant.inertia: 1.0e-3}}\n")}) {
    const TemporaryFolder folder;
    folder.write("study.yaml", manifest);
    SCOPED_TRACE(manifest);
    const forecast::StudySize size = forecast::measure_size(manifest::load_study(folder / "study.yaml", {}));
    ASSERT_EQ(zerocount_program({"run", "study.yaml", "-o", "out.h5"}, folder.path()).code, 0);
    expect_file(size.file_bytes, folder / "out.h5");
  }
}

/// Peak memory (bytes) of the largest program that the test has run.
double peak_of_programs() {
  rusage children{};
  EXPECT_EQ(getrusage(RUSAGE_CHILDREN, &children), 0);
  return 1024.0 * static_cast<double>(children.ru_maxrss);
}

void expect_memory_of_run(const std::string& manifest) {
#ifdef ZEROCOUNT_SANITIZED
  GTEST_SKIP() << "sanitizers take memory of their own";
#endif
  const TemporaryFolder folder;
  folder.write("study.yaml", manifest);
  const ProgramResult run = zerocount_program({"run", "study.yaml", "-o", "out.h5"}, folder.path());
  ASSERT_EQ(run.code, 0) << run.err;
  expect_about(forecast::measure_size(manifest::load_study(folder / "study.yaml", {})).memory_bytes,
               peak_of_programs(), "memory");
}

TEST(StudySize, PredictsTheMemoryOfARun) {
  expect_memory_of_run(small_manifest(12000));
}

// The sums of as many machines as trials take more than anything else.
TEST(StudySize, PredictsTheMemoryOfMachines) {
  expect_memory_of_run(small_manifest(20000, "machines: 20000\nkeep: statistics\n"));
}

/// Traces of 8000 trials of 1000 samples.
TEST(StudySize, DISABLED_TheMemoryOfTracesIsBounded) {
  constexpr int trials = 8000;
  std::string numbers = "0";
  for (int trial = 1; trial < trials; ++trial) numbers += ", " + std::to_string(trial);
  expect_memory_of_run(
      fmt::format("zerocount: 1\nname: traces\nseed: 1\ntrials: {}\ncommand: {{targets: [100], hold: 0.5}}\n"
                  "retain: {{trials: [{}]}}\n",
                  trials, numbers));
  EXPECT_LT(peak_of_programs(), 0.6 * trials * 1000 * sizeof(trial::SampleRecord));
}

TEST(StudySize, ARunThatTheDiskCannotHoldIsRefusedBeforeItBegins) {
  const TemporaryFolder folder;
  folder.write("study.yaml", small_manifest(1000000000));
  const ProgramResult run = zerocount_program({"run", "study.yaml", "-o", "out.h5", "-q"}, folder.path());
  EXPECT_EQ(run.code, 5) << run.err;
  EXPECT_TRUE(says(run.err, "free, and the run needs about"));
  EXPECT_FALSE(fs::exists(folder.path() / "out.h5.shards"));
  EXPECT_TRUE(says(run.err, "--force"));
  EXPECT_FALSE(fs::exists(folder / "out.h5"));
  const ProgramResult check = zerocount_program({"check", "study.yaml"}, folder.path());
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_TRUE(says(check.out, "GB"));
}

TEST(StudySize, IsPrintedWithTwoDigits) {
  EXPECT_EQ(forecast::bytes_text(0.0), "0 B");
  EXPECT_EQ(forecast::bytes_text(999.0), "999 B");
  EXPECT_EQ(forecast::bytes_text(999.6), "1.0 kB");
  EXPECT_EQ(forecast::bytes_text(4.44e6), "4.4 MB");
  EXPECT_EQ(forecast::bytes_text(44.4e9), "44 GB");
  EXPECT_EQ(forecast::bytes_text(1.5e15), "1500 TB");
}

// What a column will take in the file, from few of its elements.

using forecast::ColumnSample;
using forecast::sampled_places;
using forecast::stored_bytes;

constexpr std::size_t count = 60'000;

template <class Value>
constexpr hdf5::Element element_of = std::is_same_v<Value, double>
                                         ? hdf5::Element::float64
                                         : (sizeof(Value) == 8 ? hdf5::Element::int64 : hdf5::Element::int8);

/// Expects that the stored size of a column, estimated from 512 elements, agrees with the bytes that it
/// takes.
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

TEST(StoredColumn, RandomNumbersAreEstimatedWithinTenPercent) {
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
TEST(StoredColumn, RepeatedValuesAreEstimatedWithinTenPercent) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> of_machines(500);
  for (double& value : of_machines) value = uniform(random);
  expect_estimate<double>("machines", column_of<double>([&](std::size_t i) { return of_machines[i % 500]; }),
                          0.0, [](std::int64_t i) { return i % 500; });
  std::vector<double> of_points;
  for (std::size_t i = 0; i < count; ++i)
    of_points.push_back(i >= 20 && uniform(random) < 0.5 ? of_points[i - 20] : uniform(random));
  expect_estimate("points", of_points, 20.0);
}

TEST(StoredColumn, AFullSampleIsExact) {
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
