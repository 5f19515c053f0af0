// The trials of a study are the same on every processor.
#include "tests/runners/program.hpp"
#include "tests/support/raw_hdf5.hpp"

namespace zerocount::testing {
namespace {

/// glibc then takes the functions that a processor without these instructions has (the names of glibc 2.36
/// and, with _Usable, those before 2.33).
constexpr const char* plain_processor =
    "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX,-AVX2,-FMA,-FMA4,-AVX512F,-AVX2_Usable,-FMA_Usable,-AVX512F_Usable";

bool processor_has_fma() {
  std::ifstream file("/proc/cpuinfo");
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  return text.find(" fma ") != std::string::npos;
}

/// Exit code of a command line that the shell runs.
int shell(const std::string& line) {
  return std::system(line.c_str());
}

// The Python interpreter takes its exponentials from the C library.
TEST(ProcessorsWithoutFma, HaveOtherExponentialsInTheCLibrary) {
  if (!processor_has_fma()) GTEST_SKIP() << "this processor has no fused operations";
  const TemporaryFolder folder;
  const std::string python = fmt::format(
      ZEROCOUNT_PYTHON " -c 'import math; print([math.exp(0.001 * i) for i in range(5000)])' > {}/",
      folder.path().string());
  ASSERT_EQ(shell(python + "this"), 0);
  ASSERT_EQ(shell(fmt::format("{} {}plain", plain_processor, python)), 0);
  EXPECT_NE(folder.read("this"), folder.read("plain"));
}

struct ShortStudy {
  const char* name;
  const char* trials;
  const char* also{"keep=trials"};  ///< another key to set; this one changes nothing
};

class EveryProcessor : public ::testing::TestWithParam<ShortStudy> {};

TEST_P(EveryProcessor, GivesTheSameTrials) {
  const TemporaryFolder folder;
  const ShortStudy& study = GetParam();
  const std::string manifest = fmt::format("{}/{}.yaml", ZEROCOUNT_MANIFESTS, study.name);
  const auto run = [&](const char* output, const std::vector<std::string>& environment) {
    const ProgramResult result =
        zerocount_program({"run", manifest, "--set", fmt::format("trials={}", study.trials), "--set",
                           study.also, "-q", "-o", output},
                          folder.path(), environment);
    EXPECT_EQ(result.code, 0) << result.err;
  };
  run("this.h5", {});
  run("plain.h5", {plain_processor});
  expect_same_datasets(folder / "this.h5", folder / "plain.h5");
}

INSTANTIATE_TEST_SUITE_P(ShippedStudies, EveryProcessor,
                         ::testing::Values(ShortStudy{"paper-gains", "60", "machines=30"},
                                           ShortStudy{"contact-variation", "50"},
                                           ShortStudy{"linear-stage", "40"},
                                           ShortStudy{"friction-models", "20"},
                                           ShortStudy{"coarse-to-fine", "20"}, ShortStudy{"notch", "50"}),
                         [](const auto& named) {
                           std::string name = named.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace zerocount::testing
