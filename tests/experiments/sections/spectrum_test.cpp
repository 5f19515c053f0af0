// Spectra of vibration in manifests: as lists, and as files of points.
#include "core/failure/failure.hpp"
#include "experiments/manifest/load_study.hpp"
#include "experiments/study/study.hpp"
#include "tests/support/says.hpp"
#include "tests/support/test.hpp"

namespace zerocount::sections {
namespace {

std::string with_spectrum(const std::string& spectrum) {
  return "zerocount: 1\nname: floor\nseed: 1\ntrials: 2\ncommand: {targets: [3], hold: 0.1}\n"
         "disturbance:\n  vibration:\n    - {amplitude: 1.0e-4, frequency: 50, phase: 0}\n    - {spectrum: " +
         spectrum + ", lines: 7}\n";
}

study::Study study_with(const std::string& spectrum, const std::map<std::string, std::string>& files = {}) {
  Companions companions;
  companions.samples = [&files](const std::string& path, std::string_view) { return files.at(path); };
  return manifest::parse_study(with_spectrum(spectrum), "floor.yaml", {}, companions);
}

std::string error_with(const std::string& spectrum, const std::map<std::string, std::string>& files = {}) {
  try {
    study_with(spectrum, files);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "";
}

const trial::SpectrumParameters& spectrum_of(const study::Study& study, trial::TrialParameters& parameters) {
  parameters = study::study_trial(study, 0, 0).parameters;
  return *parameters.disturbance.spectra.at(0);
}

TEST(Spectrum, OfAFileIsThatOfTheListWithItsPoints) {
  const std::map<std::string, std::string> files{
      {"floor.csv", "frequency,density\n# a comment\n1, 1e-10\n\n10;2.5e-9\n 100\t1e-12 \r\n"}};
  trial::TrialParameters parameters;
  const study::Study study = study_with("floor.csv", files);
  const trial::SpectrumParameters& spectrum = spectrum_of(study, parameters);
  ASSERT_EQ(spectrum.density.size(), 3u);
  EXPECT_EQ(spectrum.density[1].frequency, 10.0);
  EXPECT_EQ(spectrum.density[1].density, 2.5e-9);
  EXPECT_EQ(spectrum.density[2].density, 1e-12);
  EXPECT_EQ(spectrum.lines, 7);
  // The study is whole without the file: its overrides hold the points.
  const study::Study again =
      manifest::parse_study(study.manifest.text, "floor.yaml", study.manifest.overrides, {});
  EXPECT_EQ(again.study_sha256, study.study_sha256);
  // Another table makes another study.
  const study::Study other = study_with("floor.csv", {{"floor.csv", "1, 1e-10\n100, 1e-12\n"}});
  EXPECT_NE(other.study_sha256, study.study_sha256);
}

TEST(Spectrum, OfABadFileIsAnErrorWithItsLine) {
  EXPECT_TRUE(says(error_with("floor.csv", {{"floor.csv", "f, S\n1, 1e-10\n2; x\n"}}), "floor.csv:3:1"));
  EXPECT_TRUE(says(error_with("floor.csv", {{"floor.csv", "# nothing\n"}}), "floor.csv:1:1"));
  EXPECT_TRUE(
      says(error_with("floor.csv", {{"floor.csv", "10, 1\n1, 1\n"}}), "disturbance.vibration.1.spectrum"));
}

TEST(Spectrum, OfAbsurdSizeIsAnError) {
  EXPECT_TRUE(says(error_with("[[1, 1.0e+300], [2, 1]]"), "floor.yaml:9"));
  EXPECT_TRUE(says(error_with("[[1, 1], [1.0e+300, 1]]"), "floor.yaml:9"));
  EXPECT_TRUE(says(error_with("[[2, 1], [1, 1]]"), "greater than 2"));
}

}  // namespace
}  // namespace zerocount::sections
