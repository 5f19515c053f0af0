#include "results/hdf5/hdf5.hpp"
#include "results/reading/all_trials_file.hpp"
#include "results/storage/checksum_trailer.hpp"
#include "tests/results/failures.hpp"
#include "tests/results/samples.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Everything that a file can be asked for.
void read_all(const fs::path& path) {
  const reading::AllTrialsFile file(path);
  file.require_valid_values();
}

/// Files with a checksum trailer and checksums that are right, and values that cannot be.
class SoundValues : public ::testing::Test {
 protected:
  template <class Value>
  static void write_row(hdf5::Dataset column, std::int64_t row, Value value) {
    const std::vector<hdf5::Size> extent = column.extent();
    const std::vector<Value> values(extent.size() > 1 ? extent[1] : 1, value);
    column.write(row, 1, values.data());
  }

  /// A copy of the sample whose `dataset` has `value` in its `row` (all moves of it), with a new checksum
  /// trailer.
  template <class Value>
  fs::path forged(const std::string& dataset, std::int64_t row, Value value) const {
    fs::path path = directory / "forged.h5";
    fs::copy_file(original, path, fs::copy_options::overwrite_existing);
    unseal(path);
    hdf5::File file = hdf5::File::open_to_change(path);
    write_row(file.open_dataset(dataset), row, value);
    file.close();
    storage::append_checksum(path);
    return path;
  }

  template <class Value>
  void expect_refused(const std::string& dataset, std::int64_t row, Value value, const std::string& words) {
    const fs::path path = forged(dataset, row, value);
    for (const std::string& part : {path.string() + ":", "/" + dataset + ":", words})
      expect_failure(ExitCode::bad_data, part, [&] { read_all(path); });
  }

  /// The first trial at which `measure` is at least `least`.
  std::int64_t trial_with(const std::string& measure, double least) const {
    const reading::AllTrialsFile file(original);
    const std::vector<double> values = file.measure(measure, file.rows());
    std::size_t at = 0;
    while (!(values.at(at) >= least)) ++at;
    return static_cast<std::int64_t>(at) / file.moves();
  }

  TemporaryFolder directory;
  study::Study study = sample_study(2, 30, 2);
  fs::path original = write_sample_file(directory.path(), study);
};

TEST_F(SoundValues, TheSampleHasThem) {
  EXPECT_NO_THROW(read_all(original));
  EXPECT_NO_THROW(read_all(forged("outcome/jerk_agreement", 3, not_a_number)));
}

TEST_F(SoundValues, AreAskedOfEveryMeasure) {
  expect_refused("outcome/outcome", 41, std::int8_t{77}, "trial 41, move 0: it is 77; expected 0 to 5");
  expect_refused("outcome/outcome", 41, std::int8_t{-1}, "trial 41, move 0: it is -1; expected 0 to 5");
  for (const char* flag : {"arrived", "stable"})
    expect_refused(std::string("outcome/") + flag, 41, std::uint8_t{7}, "row 41: it is 7; expected 0 or 1");
  for (const double time : {infinity, -infinity, -0.5})
    expect_refused("outcome/settling_time", 7, time, "trial 7, move 0: it is ");
  expect_refused("outcome/travel_time", 7, -0.5, "trial 7, move 0: it is -0.5; expected a finite time");
  expect_refused("outcome/arrival", 7, std::int64_t{-2}, "trial 7, move 0: it is -2; expected a sample");
  for (const char* count :
       {"overshoot", "phase_changes", "encoder_disagreement", "reversal_depth", "jerk_count"})
    expect_refused(std::string("outcome/") + count, 59, std::int64_t{-3}, "trial 59, move 0: it is -3");
  for (const char* fraction : {"jerk_agreement", "zero_fraction"})
    expect_refused(std::string("outcome/") + fraction, 0, 1.5, "trial 0, move 0: it is 1.5");
  for (const char* measure : {"final_settling_time", "oscillation_amplitude", "oscillation_period"}) {
    for (const double value : {infinity, -0.5})
      expect_refused(std::string("outcome/") + measure, 9, value, "trial 9, move 0: it is ");
  }
}

TEST_F(SoundValues, AMoveThatArrivedHasASettlingTime) {
  const std::int64_t arrived = trial_with("arrived", 1.0);
  const fs::path path = forged("outcome/settling_time", arrived, not_a_number);
  expect_failure(ExitCode::bad_data, "/outcome/arrived", [&] { read_all(path); });
}

TEST_F(SoundValues, AreAskedOfOneMeasureAlone) {
  const reading::AllTrialsFile file(forged("outcome/outcome", 41, std::int8_t{77}));
  expect_failure(ExitCode::bad_data, "/outcome/outcome: trial 41, move 0", [&] {
    file.measure("outcome", {40, 2});
  });
  EXPECT_NO_THROW(file.measure("outcome", {42, 2}));
  EXPECT_NO_THROW(file.measure("settling_time", file.rows()));
}

TEST_F(SoundValues, RowsHaveTheNumbersOfTheirPlaces) {
  expect_refused("trial/point", 31, std::int64_t{99}, "row 31: it is 99; expected 1");
  expect_refused("trial/index", 31, std::int64_t{0}, "row 31: it is 0; expected 1");
}

TEST_F(SoundValues, AreAskedOfJerks) {
  expect_refused("jerk/trial", 0, std::int64_t{-1}, "row 0: it is -1; expected 0 to 59, rising");
  expect_refused("jerk/trial", 5, std::int64_t{60}, "row 5: it is 60");
  expect_refused("jerk/trial", 0, std::int64_t{59}, "row 1: it is ");
  expect_refused("jerk/move", 3, std::int64_t{2}, "row 3: it is 2; expected 0 to 1");
  expect_refused("jerk/onset", 3, not_a_number, "row 3: it is nan; expected a finite time");
  expect_refused("jerk/duration", 3, infinity, "row 3: it is inf; expected a finite time");
  expect_refused("jerk/duration", 3, -1e-3, "row 3: it is -0.001");
  expect_refused("jerk/magnitude", 3, std::int64_t{-1}, "row 3: it is -1");
  expect_refused("jerk/direction", 3, std::int32_t{2}, "row 3: it is 2; expected -1, 0 or 1");
}

TEST_F(SoundValues, AreAskedOfTheCountsOfRigs) {
  fs::remove(original);
  original = write_sample_file(directory.path(), sample_study_with_rigs(2, 40, 2));  // 8 rigs
  const auto expect_counts_refused = [&](const std::string& dataset, std::int64_t row, std::int64_t value,
                                         const std::string& words) {
    const fs::path path = forged(dataset, row, value);
    expect_failure(ExitCode::bad_data, words, [&] { reading::AllTrialsFile(path).rigs(); });
  };
  expect_counts_refused("rig/trials", 0, 4, "row 0: 4 trials of a rig; expected 5, or 0 of all");
  expect_counts_refused("rig/trials", 1, 0, "row 1: 0 trials of a rig; expected 5, or 0 of all");
  expect_counts_refused("rig/success", 1, 6, "row 1: 6 successes; expected 0 to 5");
  expect_counts_refused("rig/success", 1, -1, "row 1: -1 successes; expected 0 to 5");
}

TEST_F(SoundValues, JerksOfATrialAreInTheirOrder) {
  const std::int64_t trial = trial_with("jerk_count", 2.0);
  std::int64_t first = 0;
  {
    const reading::AllTrialsFile file(original);
    while (file.jerks_at(first, 1).front().trial < trial) ++first;
  }
  const fs::path path = forged("jerk/onset", first, 1e9);
  expect_failure(ExitCode::bad_data, "it is before the jerk above it, of the same trial",
                 [&] { read_all(path); });
}

}  // namespace
}  // namespace zerocount::testing
