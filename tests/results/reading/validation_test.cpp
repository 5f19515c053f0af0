#include "results/hdf5/hdf5.hpp"
#include "results/reading/all_trials_file.hpp"
#include "tests/results/failures.hpp"
#include "tests/results/samples.hpp"
#include "tests/results/walk.hpp"
#include "tests/support/checksum.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Reads everything that the program can read from a results file.
void read_all(const fs::path& path) {
  const reading::AllTrialsFile file(path);
  file.require_valid_values();
}

/// Tests of files whose checksums are right although some stored values are impossible.
class StoredValues : public ::testing::Test {
 protected:
  template <class Value>
  static void write_row(hdf5::Dataset column, std::int64_t row, Value value) {
    const std::vector<hdf5::Size> extent = column.extent();
    const std::vector<Value> values(extent.size() > 1 ? extent[1] : 1, value);
    column.write(row, 1, values.data());
  }

  /// A copy of the sample file in which `dataset` has `value` in row `row` (for all its moves), with a new
  /// checksum trailer.
  template <class Value>
  fs::path forged(const std::string& dataset, std::int64_t row, Value value) const {
    fs::path path = directory / "forged.h5";
    fs::copy_file(original, path, fs::copy_options::overwrite_existing);
    remove_checksum(path);
    hdf5::File file = hdf5::File::open_to_change(path);
    write_row(file.open_dataset(dataset), row, value);
    file.close();
    append_checksum(path);
    return path;
  }

  template <class Value>
  void expect_refused(const std::string& dataset, std::int64_t row, Value value, const std::string& words) {
    const fs::path path = forged(dataset, row, value);
    for (const std::string& part : {path.string() + ":", "/" + dataset + ":", words})
      expect_failure(ExitCode::bad_data, part, [&] { read_all(path); });
  }

  /// Index of the first trial whose `measure` is at least `least`.
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

TEST_F(StoredValues, TheSampleFilePasses) {
  EXPECT_NO_THROW(read_all(original));
  EXPECT_NO_THROW(read_all(forged("outcome/jerk_agreement", 3, not_a_number)));
}

TEST_F(StoredValues, EveryMeasureIsChecked) {
  expect_refused("outcome/outcome", 41, std::int8_t{77}, "trial 41, move 0: it is 77; expected 0 to 5");
  expect_refused("outcome/outcome", 41, std::int8_t{-1}, "trial 41, move 0: it is -1; expected 0 to 5");
  for (const char* flag : {"arrived", "stable"})
    expect_refused(std::string("outcome/") + flag, 41, std::uint8_t{7}, "row 41: it is 7; expected 0 or 1");
  for (const double time : {infinity, -infinity, -0.5})
    expect_refused("outcome/arrival_time", 7, time, "trial 7, move 0: it is ");
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

TEST_F(StoredValues, AMoveThatArrivedMustHaveAnArrivalTime) {
  const std::int64_t arrived = trial_with("arrived", 1.0);
  const fs::path path = forged("outcome/arrival_time", arrived, not_a_number);
  expect_failure(ExitCode::bad_data, "/outcome/arrived", [&] { read_all(path); });
}

TEST_F(StoredValues, ASingleMeasureIsChecked) {
  const reading::AllTrialsFile file(forged("outcome/outcome", 41, std::int8_t{77}));
  expect_failure(ExitCode::bad_data, "/outcome/outcome: trial 41, move 0", [&] {
    file.measure("outcome", {40, 2});
  });
  EXPECT_NO_THROW(file.measure("outcome", {42, 2}));
  EXPECT_NO_THROW(file.measure("arrival_time", file.rows()));
}

TEST_F(StoredValues, RowsMustHaveTheNumbersOfTheirPlaces) {
  expect_refused("trial/point", 31, std::int64_t{99}, "row 31: it is 99; expected 1");
  expect_refused("trial/index", 31, std::int64_t{0}, "row 31: it is 0; expected 1");
}

TEST_F(StoredValues, JerksAreChecked) {
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

TEST_F(StoredValues, CountsOfMachinesAreChecked) {
  fs::remove(original);
  original = write_sample_file(directory.path(), sample_study_with_machines(2, 40, 2));  // 8 machines
  const auto expect_counts_refused = [&](const std::string& dataset, std::int64_t row, std::int64_t value,
                                         const std::string& words) {
    const fs::path path = forged(dataset, row, value);
    expect_failure(ExitCode::bad_data, words, [&] { reading::AllTrialsFile(path).groups("machine"); });
  };
  expect_counts_refused(
      "machine/trials", 0, 4,
      "/machine/trials: row 0: impossible counts of machine 0; expected 5 trials, or 0 of all");
  expect_counts_refused("machine/trials", 1, 0,
                        "row 1: impossible counts of machine 0; expected 5 trials, or 0 of all");
  expect_counts_refused("machine/success", 1, 6,
                        "/machine/success: row 1: impossible counts of machine 0; expected 5 trials");
  expect_counts_refused("machine/success", 1, -1, "row 1: impossible counts of machine 0; expected 5 trials");
}

TEST_F(StoredValues, JerksOfATrialMustBeInOrder) {
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

class UnusableFile : public ::testing::Test {
 protected:
  fs::path copy(const std::string& name) const {
    fs::copy_file(original, directory / name);
    return directory / name;
  }

  void expect_bad(const fs::path& path, const std::string& words, ExitCode code = ExitCode::bad_data) const {
    expect_failure(code, words, [&] { read_everything(path); });
    expect_failure(code, path.filename(), [&] { read_everything(path); });
  }

  TemporaryFolder directory;
  study::Study study = sample_study(2, 30, 2);
  fs::path original = write_sample_file(directory.path(), study);
};

TEST_F(UnusableFile, AMissingFileIsBadInput) {
  expect_bad(directory / "nothing.h5", "no such file", ExitCode::bad_input);
  expect_bad(directory.path(), "a directory", ExitCode::bad_input);
}

TEST_F(UnusableFile, AnotherFormatIsReported) {
  write_bytes(directory / "text.h5", "zerocount: 1\n");
  expect_bad(directory / "text.h5", "not in the HDF5 format");
  write_bytes(directory / "empty.h5", "");
  expect_bad(directory / "empty.h5", "not in the HDF5 format");
  write_empty_hdf5(directory / "foreign.h5");
  expect_bad(directory / "foreign.h5", "the checksum at its end is missing");
  append_checksum(directory / "foreign.h5");
  expect_bad(directory / "foreign.h5", "foreign.h5: not a results file of zerocount");
  replace_attribute(copy("format.h5"), "format", std::string("else"));
  expect_bad(directory / "format.h5", "format.h5: its format is 'else'; expected 'zerocount-study'");
}

TEST_F(UnusableFile, AnotherVersionIsReported) {
  replace_attribute(copy("newer.h5"), "format_version", layout::format_version + 1);
  expect_bad(directory / "newer.h5", "wrote it in format version 6, newer than the 5");
  replace_attribute(copy("older.h5"), "format_version", 3);
  expect_bad(directory / "older.h5",
             "wrote it in format version 3, and this program reads version 5; run its manifest again");
}

TEST_F(UnusableFile, AnUnfinishedFileIsReported) {
  remove_attribute(copy("unfinished.h5"), "finished");
  expect_bad(directory / "unfinished.h5", "never finished");
}

TEST_F(UnusableFile, AShardIsIncomplete) {
  const shards::ShardInfo shard = write_sample_shard(directory.path(), study, layout::all_rows(study));
  expect_failure(ExitCode::bad_data, "incomplete", [&] { reading::AllTrialsFile{shard.path}; });
}

TEST_F(UnusableFile, ContradictoryAttributesAreReported) {
  replace_attribute(copy("sha.h5"), "manifest_sha256", std::string("changed"));
  expect_bad(directory / "sha.h5", "the checksum of the manifest is wrong");
  replace_attribute(copy("rows.h5"), "trial_count", 59);
  expect_bad(directory / "rows.h5", "complete");
  replace_attribute(copy("trials.h5"), "trials", -3);
  expect_bad(directory / "trials.h5", "cannot belong to");
  remove_attribute(copy("missing.h5"), "seed");
  expect_bad(directory / "missing.h5", "the attribute 'seed' is missing");
}

TEST_F(UnusableFile, AnOverflowingNumberOfTrialsIsReported) {
  replace_attribute(copy("trials.h5"), "trials", std::int64_t{1} << 62);
  expect_bad(directory / "trials.h5",
             "cannot belong to 2 design points with 4611686018427387904 trials each");
  replace_attribute(copy("first.h5"), "first_trial", std::numeric_limits<std::int64_t>::max());
  expect_bad(directory / "first.h5", "cannot belong to");
}

TEST_F(UnusableFile, MessagesContainNoControlCharacters) {
  replace_attribute(copy("engine.h5"), "engine", std::string("\x1b[31m"));
  expect_bad(directory / "engine.h5", "its engine is '\uFFFD[31m'");
  replace_attribute(copy("format.h5"), "format", std::string("\xff"));
  expect_bad(directory / "format.h5", "its format is '\uFFFD'");
}

// Without this check the summary read beyond the end of the list of labels.
TEST_F(UnusableFile, AMissingPointLabelIsReported) {
  replace_by_texts(copy("few.h5"), "/point/label", 1);
  expect_failure(ExitCode::bad_data, "/point/label: it should have one value for each of the 2 design points",
                 [&] { reading::AllTrialsFile(directory / "few.h5").point_labels(); });
}

TEST_F(UnusableFile, AnImpossiblyLargeDatasetIsReported) {
  for (const int bits : {40, 62}) {
    replace_by_texts(copy(fmt::format("{}.h5", bits)), "/overrides", std::uint64_t{1} << bits);
    expect_bad(directory / fmt::format("{}.h5", bits), "/overrides: its size is more than the file can hold");
  }
}

TEST_F(UnusableFile, AFileChangedByAnotherProgramIsRefused) {
  const fs::path path = copy("changed.h5");
  replace_attribute(path, "name", std::string("changed"));
  read_everything(path);  // with a new checksum trailer
  std::string bytes = read_bytes(path);
  bytes[bytes.size() - 5] ^= 1;
  write_bytes(path, bytes);
  expect_bad(path, "changed since it was written, or damaged");
}

TEST_F(UnusableFile, AFlippedBitFailsTheChecksum) {
  const std::string bytes = read_bytes(original);
  for (const char* column :
       {"/outcome/arrival_time", "/trial/input/friction.k1", "/jerk/onset", "/point/controller.ki",
        "/level/torque_max", "/profile/friction.k1/value", "/trace/theta"}) {
    const fs::path path = directory / "flipped.h5";
    std::string damaged = bytes;
    damaged[chunk_address(original, column) + 5] ^= 4;
    write_bytes(path, damaged);
    expect_bad(path, "changed since it was written, or damaged");
    remove_checksum(path);
    append_checksum(path);
    expect_bad(path, column);
    expect_bad(path, "their checksum is wrong");
  }
}

TEST_F(UnusableFile, AChangedLetterOfALabelIsReported) {
  std::string bytes = read_bytes(original);
  bytes[bytes.find("point 1")] = 'P';
  write_bytes(directory / "label.h5", bytes);
  expect_bad(directory / "label.h5", "changed since it was written, or damaged");
}

TEST_F(UnusableFile, ATruncatedFileIsBadData) {
  const std::string bytes = read_bytes(original);
  std::mt19937 random(3);
  std::vector<std::size_t> lengths{1, 8, 48, bytes.size() - 1};
  for (int i = 0; i < 40; ++i) lengths.push_back(random() % bytes.size());
  for (const std::size_t length : lengths) {
    write_bytes(directory / "short.h5", bytes.substr(0, length));
    expect_bad(directory / "short.h5", "short.h5");
  }
}

TEST_F(UnusableFile, RandomBytesAreBadData) {
  const std::string bytes = read_bytes(original);
  std::mt19937 random(5);
  for (int repetition = 0; repetition < 400; ++repetition) {
    std::string damaged = bytes;
    const std::size_t at = random() % bytes.size();
    for (std::size_t i = at; i < std::min(at + 16, bytes.size()); ++i)
      damaged[i] = static_cast<char>(random());
    write_bytes(directory / "random.h5", damaged);
    expect_bad(directory / "random.h5", "random.h5");
  }
}

}  // namespace
}  // namespace zerocount::testing
