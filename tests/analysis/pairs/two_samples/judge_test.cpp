// SciPy judges every test statistic, p-value and bound of a comparison.
#include <nlohmann/json.hpp>

#include "analysis/pairs/two_samples/exact_tests.hpp"
#include "analysis/pairs/two_samples/sample.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using Json = nlohmann::json;

class JudgedCases {
 public:
  explicit JudgedCases(const std::filesystem::path& path) : file_(path) {}
  void add(const char* kind, const Json& arguments, const Json& value) {
    file_ << Json{{"kind", kind}, {"arguments", arguments}, {"value", value}}.dump() << "\n";
  }
  void close() { file_.close(); }

 private:
  std::ofstream file_;
};

Json both(const statistics::ConfidenceInterval& bounds) {
  return {bounds.low, bounds.high};
}

class Draws {
 public:
  explicit Draws(unsigned seed) : random_(seed) {}
  std::int64_t whole(std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(random_);
  }
  std::vector<double> normals(std::int64_t count, double mean) {
    std::normal_distribution<double> law(mean, 1.0);
    std::vector<double> values;
    for (std::int64_t i = 0; i < count; ++i) values.push_back(law(random_));
    return values;
  }
  /// Random normal numbers rounded to multiples of 0.5, with many ties and zeros.
  std::vector<double> halves(std::int64_t count, double mean) {
    std::vector<double> values = normals(count, mean);
    for (double& value : values) value = 0.5 * std::round(2.0 * value);
    return values;
  }

 private:
  std::mt19937_64 random_;
};

void add_proportions(JudgedCases& cases, Draws& draws) {
  for (int i = 0; i < 150; ++i) {
    const std::int64_t pairs = draws.whole(1, 400);
    const std::int64_t worse = draws.whole(0, pairs);
    const std::int64_t better = draws.whole(0, pairs - worse);
    cases.add("mcnemar", {pairs, worse, better}, two_samples::mcnemar({pairs, worse, better}));
    cases.add("tango", {pairs, worse, better, 0.95}, both(two_samples::tango({pairs, worse, better}, 0.95)));

    const std::int64_t n1 = draws.whole(1, 3000);
    const std::int64_t n2 = draws.whole(1, 3000);
    const std::int64_t k1 = draws.whole(0, n1);
    const std::int64_t k2 = std::min(n2, draws.whole(0, 2 * k1));
    cases.add("fisher", {k1, n1, k2, n2}, two_samples::fisher({k1, n1, k2, n2}));
    cases.add("newcombe", {k1, n1, k2, n2, 0.9}, both(two_samples::newcombe({k1, n1, k2, n2}, 0.9)));
  }
}

void add_numbers(JudgedCases& cases, Draws& draws) {
  for (int i = 0; i < 40; ++i) {
    const double shift = 0.1 * static_cast<double>(draws.whole(-5, 8));
    const std::vector<double> small = draws.halves(draws.whole(1, 11), shift);
    const std::vector<double> plain = draws.normals(draws.whole(5, 150), shift);
    const std::vector<double> many = draws.halves(draws.whole(400, 600), 0.2 * shift);
    for (const auto& differences : {small, plain, many})
      cases.add("signed_rank", differences, two_samples::signed_rank(differences));
    const std::vector<double> one = draws.normals(draws.whole(3, 90), 0.0);
    const std::vector<double> two = draws.normals(draws.whole(3, 90), shift);
    cases.add("smirnov", {one, two}, two_samples::smirnov(one, two));
    const std::vector<double> few = draws.halves(draws.whole(2, 5), 0.0);
    const std::vector<double> others = draws.halves(draws.whole(2, 5), 3.0 * shift);
    cases.add("smirnov", {few, others}, two_samples::smirnov(few, others));
    cases.add("paired_t", plain, two_samples::p_of(two_samples::mean_difference(plain)));
    cases.add("welch", {one, two}, two_samples::p_of(two_samples::mean_difference(one, two)));
    cases.add("paired_bounds", {plain, 2.0, 0.95}, both(two_samples::cautious_bounds(plain, 2.0, 0.95)));
    cases.add("two_sample_bounds", {one, two, 2.0, 0.95},
              both(two_samples::cautious_bounds(one, two, 2.0, 0.95)));
  }
}

TEST(ComparisonStatistics, MatchSciPy) {
  const TemporaryFolder folder;
  JudgedCases cases(folder / "cases");
  Draws draws(20);
  add_proportions(cases, draws);
  add_numbers(cases, draws);
  cases.close();
  const std::string command = fmt::format("{} {} {} > {} 2>&1", ZEROCOUNT_PYTHON, ZEROCOUNT_COMPARISON_JUDGE,
                                          (folder / "cases").string(), (folder / "out").string());
  EXPECT_EQ(std::system(command.c_str()), 0) << folder.read("out");
  EXPECT_EQ(
      folder.read("out"),
      "fisher:150 mcnemar:150 newcombe:150 paired_bounds:40 paired_t:40 signed_rank:120 smirnov:80 tango:150 "
      "two_sample_bounds:40 welch:40\n");
}

}  // namespace
}  // namespace zerocount::testing
