// The C interface beside the functions that it stands for: codes, messages, ranges, jobs and laws.
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <zerocount/zerocount.h>

#include "tests/support/test.hpp"

namespace {

using ::testing::HasSubstr;

const std::string manifest = R"(zerocount: 1
name: axis
seed: 3
trials: 50
friction: {k1: {uniform: [90, 130]}}
controller: {ki: 5.0e-5}
command: {targets: [{integers: [1, 30]}], hold: 0.3}
)";

/// A study opened through the library's C interface, and a job that runs it.
struct Session {
  Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session() {
    zerocount_free_job(job);
    zerocount_free_study(study);
  }

  std::int32_t read(const std::string& text, std::vector<const char*> overrides = {}) {
    return zerocount_read_study(text.data(), text.size(), "axis.yaml", ".", overrides.data(),
                                overrides.size(), &study);
  }

  /// The arrays in the result of the job, by name.
  std::map<std::string, std::vector<double>> result() const {
    std::map<std::string, std::vector<double>> arrays;
    std::size_t count = 0;
    const zerocount_array* all = zerocount_result(job, &count);
    for (const zerocount_array& array : std::span(all, count)) {
      std::vector<double>& values = arrays[array.name];
      const std::string type = array.type;
      for (std::int64_t i = 0; i < array.size; ++i) {
        if (type == "float64") values.push_back(static_cast<const double*>(array.values)[i]);
        if (type == "int64")
          values.push_back(static_cast<double>(static_cast<const std::int64_t*>(array.values)[i]));
      }
    }
    return arrays;
  }

  std::int32_t finish() {
    std::int32_t done = 0;
    std::int32_t code = 0;
    while (done == 0 && code == 0) code = zerocount_wait(job, 1000, &done);
    return code;
  }

  zerocount_study* study{nullptr};
  zerocount_job* job{nullptr};
};

/// A control law given to the library: a proportional law, or one that reports a failure after some samples.
struct Law {
  zerocount_law law{
      .size = sizeof(zerocount_law), .step = &Law::step, .context = this, .setup = {}, .sample = {}};
  double gain{1e-4};
  int samples_left{1 << 30};

  static double step(void* context) {
    auto& self = *static_cast<Law*>(context);
    if (self.samples_left-- == 0) return std::numeric_limits<double>::quiet_NaN();
    return self.gain * self.law.sample.error;
  }
};

TEST(CInterface, AnErrorHasAnExitCodeAndItsPlace) {
  Session s;
  EXPECT_EQ(s.read(manifest + "dac: {bits: 99}\n"), 2);
  EXPECT_THAT(zerocount_message(), HasSubstr("axis.yaml:8:"));
  EXPECT_EQ(s.read(manifest, {"no.such=1"}), 2);
  EXPECT_THAT(zerocount_message(), HasSubstr("--set no.such=1"));
  EXPECT_EQ(s.study, nullptr);
  EXPECT_EQ(zerocount_open_study("no-such.h5", &s.study), 2);
  EXPECT_THAT(zerocount_message(), HasSubstr("no-such.h5"));
}

TEST(CInterface, PointsAndTrialsOutOfRangeAreRefused) {
  Session s;
  ASSERT_EQ(s.read(manifest), 0);
  for (const std::int64_t point : {-1, 1}) {
    EXPECT_EQ(zerocount_start_trial(s.study, point, 0, nullptr, &s.job), 2);
    EXPECT_THAT(zerocount_message(), HasSubstr("is out of range; expected 0 to 0"));
    char* json = nullptr;
    EXPECT_EQ(zerocount_describe_variables(s.study, point, &json), 2);
  }
  for (const std::int64_t trial : {-1, 50}) {
    EXPECT_EQ(zerocount_start_trial(s.study, 0, trial, nullptr, &s.job), 2);
    EXPECT_THAT(zerocount_message(), HasSubstr("is out of range; expected 0 to 49"));
  }
  EXPECT_EQ(s.job, nullptr);
}

TEST(CInterface, AValueOutsideItsDistributionFailsTheJob) {
  Session s;
  ASSERT_EQ(s.read(manifest), 0);
  const std::vector<double> values{100.0, 5.0, 150.0, 5.0};  // k1, target
  const std::vector<std::int64_t> numbers{0, 1};
  ASSERT_EQ(zerocount_start_outcomes(s.study, 0, 2, values.data(), numbers.data(), 1, &s.job), 0);
  EXPECT_EQ(s.finish(), 2);
  EXPECT_THAT(zerocount_message(), HasSubstr("friction.k1 = 150 cannot be drawn"));
  EXPECT_EQ(s.finish(), 2) << "it fails again where it is asked again";
}

TEST(CInterface, OutcomesEqualThoseOfTheTrialAtTheSameValues) {
  Session s;
  ASSERT_EQ(s.read(manifest, {"friction.k1=100", "command.targets.0={integers: [5, 6]}"}), 0);
  const std::vector<double> values{5.0, 6.0};
  const std::vector<std::int64_t> numbers{0, 1};
  ASSERT_EQ(zerocount_start_outcomes(s.study, 0, 2, values.data(), numbers.data(), 2, &s.job), 0);
  ASSERT_EQ(s.finish(), 0);
  const std::vector<double> peaks = s.result()["peak_torque"];
  ASSERT_EQ(peaks.size(), 2U);
  EXPECT_NE(peaks[0], peaks[1]);
  for (int i = 0; i < 2; ++i) {
    Session one;
    ASSERT_EQ(one.read(manifest, {"friction.k1=100", i == 0 ? "command.targets.0=5" : "command.targets.0=6"}),
              0);
    ASSERT_EQ(zerocount_start_trial(one.study, 0, 0, nullptr, &one.job), 0);
    ASSERT_EQ(one.finish(), 0);
    EXPECT_EQ(one.result()["outcome/peak_torque"].at(0), peaks[static_cast<std::size_t>(i)]);
  }
}

TEST(CInterface, AControllerCallbackDecidesTheTorqueUntilItFails) {
  Session s;
  ASSERT_EQ(s.read(manifest), 0);
  Law law;
  ASSERT_EQ(zerocount_start_trial(s.study, 0, 4, &law.law, &s.job), 0);
  ASSERT_EQ(s.finish(), 0);
  const std::vector<double> errors = s.result()["samples/error"];
  const std::vector<double> torques = s.result()["samples/torque"];
  ASSERT_EQ(errors.size(), 600U);
  for (std::size_t i = 0; i < errors.size(); ++i) ASSERT_NEAR(torques[i], 1e-4 * errors[i], 1e-4);
  EXPECT_EQ(law.law.sample.k, 599);
  EXPECT_EQ(law.law.setup.sample_time, 1.0 / 2000);

  zerocount_free_job(std::exchange(s.job, nullptr));
  law.samples_left = 100;
  ASSERT_EQ(zerocount_start_trial(s.study, 0, 4, &law.law, &s.job), 0);
  EXPECT_LE(s.result()["samples/error"].size(), 101U);
  EXPECT_EQ(law.samples_left, -1) << "it is not called after NaN";

  law.law.size -= 8;
  EXPECT_EQ(zerocount_start_trial(s.study, 0, 4, &law.law, &s.job), 2) << "a law of another interface";
}

TEST(CInterface, AJobThatIsFreedStops) {
  Session s;
  ASSERT_EQ(s.read(manifest, {"command.hold=10000"}), 0);  // 40 million samples
  ASSERT_EQ(zerocount_start_trial(s.study, 0, 0, nullptr, &s.job), 0);
  std::int32_t done = 1;
  EXPECT_EQ(zerocount_wait(s.job, 1, &done), 0);
  EXPECT_EQ(done, 0);
}

}  // namespace
