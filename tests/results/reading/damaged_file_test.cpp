#include "results/reading/all_trials_file.hpp"
#include "results/storage/checksum_trailer.hpp"
#include "tests/results/failures.hpp"
#include "tests/results/samples.hpp"
#include "tests/results/walk.hpp"
#include "tests/support/raw_hdf5.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

class DamagedFile : public ::testing::Test {
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

TEST_F(DamagedFile, ThatDoesNotExistIsBadInput) {
  expect_bad(directory / "nothing.h5", "no such file", ExitCode::bad_input);
  expect_bad(directory.path(), "a directory", ExitCode::bad_input);
}

TEST_F(DamagedFile, OfAnotherFormatIsSaidToBe) {
  write_bytes(directory / "text.h5", "zerocount: 1\n");
  expect_bad(directory / "text.h5", "not in the HDF5 format");
  write_bytes(directory / "empty.h5", "");
  expect_bad(directory / "empty.h5", "not in the HDF5 format");
  write_empty_hdf5(directory / "foreign.h5");
  expect_bad(directory / "foreign.h5", "the checksum at its end is missing");
  storage::append_checksum(directory / "foreign.h5");
  expect_bad(directory / "foreign.h5", "foreign.h5: not a results file of zerocount");
  replace_attribute(copy("format.h5"), "format", std::string("else"));
  expect_bad(directory / "format.h5", "format.h5: its format is 'else'; expected 'zerocount-study'");
}

TEST_F(DamagedFile, OfAnotherVersionIsSaidToBe) {
  replace_attribute(copy("newer.h5"), "format_version", layout::format_version + 1);
  expect_bad(directory / "newer.h5", "newer.h5: its format version is 5, newer than the 4");
  replace_attribute(copy("older.h5"), "format_version", 3);
  expect_bad(directory / "older.h5",
             "its format version is 3, and this program reads version 4; run its manifest again");
}

TEST_F(DamagedFile, ThatWasNeverFinishedIsSaidToBe) {
  remove_attribute(copy("unfinished.h5"), "finished");
  expect_bad(directory / "unfinished.h5", "never finished");
}

TEST_F(DamagedFile, ThatIsAShardIsIncomplete) {
  const shards::ShardInfo shard = write_sample_shard(directory.path(), study, layout::all_rows(study));
  expect_failure(ExitCode::bad_data, "incomplete", [&] { reading::AllTrialsFile{shard.path}; });
}

TEST_F(DamagedFile, WhoseAttributesContradictTheContentsIsFound) {
  replace_attribute(copy("sha.h5"), "manifest_sha256", std::string("changed"));
  expect_bad(directory / "sha.h5", "the checksum of the manifest is wrong");
  replace_attribute(copy("rows.h5"), "trial_count", 59);
  expect_bad(directory / "rows.h5", "complete");
  replace_attribute(copy("trials.h5"), "trials", -3);
  expect_bad(directory / "trials.h5", "cannot be of");
  remove_attribute(copy("missing.h5"), "seed");
  expect_bad(directory / "missing.h5", "the attribute 'seed' is missing");
}

TEST_F(DamagedFile, WithNumbersOfTrialsWhoseProductOverflowsIsFound) {
  replace_attribute(copy("trials.h5"), "trials", std::int64_t{1} << 62);
  expect_bad(directory / "trials.h5", "cannot be of 2 design points with 4611686018427387904 trials each");
  replace_attribute(copy("first.h5"), "first_trial", std::numeric_limits<std::int64_t>::max());
  expect_bad(directory / "first.h5", "cannot be of");
}

TEST_F(DamagedFile, IsToldWithoutItsControlCharacters) {
  replace_attribute(copy("engine.h5"), "engine", std::string("\x1b[31m"));
  expect_bad(directory / "engine.h5", "its engine is '\uFFFD[31m'");
  replace_attribute(copy("format.h5"), "format", std::string("\xff"));
  expect_bad(directory / "format.h5", "its format is '\uFFFD'");
}

// Without this check the summary read beyond the end of the list of labels.
TEST_F(DamagedFile, WithoutALabelOfEachPointIsFound) {
  replace_by_texts(copy("few.h5"), "/point/label", 1);
  expect_failure(ExitCode::bad_data, "/point/label: it should have one value for each of the 2 design points",
                 [&] { reading::AllTrialsFile(directory / "few.h5").point_labels(); });
}

TEST_F(DamagedFile, WithADatasetThatNoFileCouldHoldIsFound) {
  for (const int bits : {40, 62}) {
    replace_by_texts(copy(fmt::format("{}.h5", bits)), "/overrides", std::uint64_t{1} << bits);
    expect_bad(directory / fmt::format("{}.h5", bits), "/overrides: its size is more than the file can hold");
  }
}

TEST_F(DamagedFile, ThatAnotherProgramChangedIsRefused) {
  const fs::path path = copy("changed.h5");
  replace_attribute(path, "name", std::string("changed"));
  read_everything(path);  // with a new checksum trailer
  std::string bytes = read_bytes(path);
  bytes[bytes.size() - 5] ^= 1;
  write_bytes(path, bytes);
  expect_bad(path, "changed since it was written, or damaged");
}

TEST_F(DamagedFile, WithOneFlippedBitOfAColumnFailsItsChecksums) {
  const std::string bytes = read_bytes(original);
  for (const char* column :
       {"/outcome/settling_time", "/trial/input/friction.k1", "/jerk/onset", "/point/controller.ki",
        "/level/torque_max", "/profile/friction.k1/value", "/trace/theta"}) {
    const fs::path path = directory / "flipped.h5";
    std::string damaged = bytes;
    damaged[chunk_address(original, column) + 5] ^= 4;
    write_bytes(path, damaged);
    expect_bad(path, "changed since it was written, or damaged");
    unseal(path);
    storage::append_checksum(path);
    expect_bad(path, column);
    expect_bad(path, "their checksum is wrong");
  }
}

TEST_F(DamagedFile, WithOneChangedLetterOfALabelIsFound) {
  std::string bytes = read_bytes(original);
  bytes[bytes.find("point 1")] = 'P';
  write_bytes(directory / "label.h5", bytes);
  expect_bad(directory / "label.h5", "changed since it was written, or damaged");
}

TEST_F(DamagedFile, CutAnywhereIsBadData) {
  const std::string bytes = read_bytes(original);
  std::mt19937 random(3);
  std::vector<std::size_t> lengths{1, 8, 48, bytes.size() - 1};
  for (int i = 0; i < 40; ++i) lengths.push_back(random() % bytes.size());
  for (const std::size_t length : lengths) {
    write_bytes(directory / "short.h5", bytes.substr(0, length));
    expect_bad(directory / "short.h5", "short.h5");
  }
}

TEST_F(DamagedFile, WithRandomBytesAnywhereIsBadData) {
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
