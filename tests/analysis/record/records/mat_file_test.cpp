// MAT files as MATLAB wrote them before version 7.3: their arrays, and damage.
#include <cstdlib>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "analysis/record/records/dataset_file.hpp"
#include "core/failure/failure.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {
namespace {

using records::DatasetFile;

/// Files of scipy.io.savemat, plain and compressed.
class MatFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string script =
        folder_
            .write("write.py",
                   "import sys, numpy, scipy.io\n"
                   "t = numpy.arange(5.0)\n"
                   "data = {'t': t, 'machine': {'i': t.astype('i2'), 'deep': {'x': t.astype('f4')}},\n"
                   "  'all': numpy.arange(15.0).reshape(5, 3), 'rows': numpy.arange(15).reshape(3, 5),\n"
                   "  'word': 'a machine', 'wave': 1j * t, 'cells': numpy.array([t, 'x'], dtype=object)}\n"
                   "for name in 'plain', 'packed':\n"
                   "  scipy.io.savemat(f'{sys.argv[1]}/{name}.mat', data, do_compression=name == 'packed')\n")
            .string();
    ASSERT_EQ(std::system((ZEROCOUNT_PYTHON " '" + script + "' '" + folder_.path().string() + "'").c_str()),
              0);
  }

  /// The message that says why a file with these bytes cannot be read; empty if it can.
  std::string damage_of(const std::string& bytes) {
    const auto path = folder_.write("damaged.mat", bytes);
    try {
      const DatasetFile file(path);
      return "";
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::bad_data);
      EXPECT_EQ(std::string(failure.what()).find(path.string() + ": damaged: "), 0u) << failure.what();
      return failure.what();
    }
  }

  TemporaryFolder folder_;
};

TEST_F(MatFiles, Version5ReadsLikeVersion73) {
  const std::vector<double> numbers{0, 1, 2, 3, 4};
  for (const char* name : {"plain.mat", "packed.mat"}) {
    const DatasetFile file(folder_ / name);
    for (const char* column : {"/t", "t", "/machine/i", "machine/deep/x", "/rows#1"})
      EXPECT_EQ(file.numbers(column), numbers) << name << column;
    EXPECT_EQ(file.numbers("/all#2"), (std::vector<double>{1, 4, 7, 10, 13})) << name;
    EXPECT_EQ(file.numbers("/rows#2"), (std::vector<double>{5, 6, 7, 8, 9})) << name;
    for (const char* column : {"/none", "/machine", "/word", "/wave", "/cells", "/all", "/all#4"})
      EXPECT_FALSE(file.has(column)) << name << column;
    // The last dimension comes first, as in HDF5.
    EXPECT_EQ(file.columns_text(),
              "/all (3×5), /machine/deep/x (5×1), /machine/i (5×1), /rows (5×3), /t (5×1)");
  }
}

// Variables that libmatio cannot read, and missing ends, are refused. It may not notice other changed
// numbers.
TEST_F(MatFiles, DamageIsReportedWithItsPlace) {
  const std::string packed = folder_.read("packed.mat");
  const std::string plain = folder_.read("plain.mat");
  std::mt19937_64 random(1);
  EXPECT_EQ(damage_of(packed), "");
  int seen = 0;
  for (int i = 0; i < 50; ++i) {
    std::string changed = packed;
    const std::size_t place = 128 + random() % (packed.size() - 128);
    changed[place] = static_cast<char>(changed[place] ^ 1 << random() % 8);
    seen += damage_of(changed).empty() ? 0 : 1;
  }
  EXPECT_GE(seen, 35);  // of 50
  EXPECT_NE(damage_of(plain.substr(0, plain.size() - 1)).find("ends at byte"), std::string::npos);
  EXPECT_NE(damage_of(plain.substr(0, 60)).find("ends at byte 60, expected 128"), std::string::npos);
  std::string changed = packed;
  changed[150] = static_cast<char>(~changed[150]);
  EXPECT_NE(damage_of(changed).find("the variable at byte 128 cannot be read"), std::string::npos);
}

}  // namespace
}  // namespace zerocount::testing
