#include "runners/cluster/array_job.hpp"

#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace zerocount::testing {
namespace {

TEST(ArrayJob, HasAnElementForEachPartUpToTheLimit) {
  EXPECT_EQ(cluster::array_job(8, 1001).elements, 8);
  EXPECT_EQ(cluster::array_job(1001, 1001).elements, 1001);
  EXPECT_EQ(cluster::array_job(5000, 1001).elements, 1001);
}

/// The numbers of "0-3,7".
std::vector<std::int64_t> read_list(const std::string& list) {
  std::vector<std::int64_t> numbers;
  for (std::size_t at = 0; at < list.size();) {
    std::size_t used = 0;
    const std::int64_t first = std::stoll(list.substr(at), &used);
    at += used;
    std::int64_t last = first;
    if (at < list.size() && list[at] == '-') {
      last = std::stoll(list.substr(at + 1), &used);
      at += used + 1;
    }
    for (std::int64_t i = first; i <= last; ++i) numbers.push_back(i);
    ++at;  // the comma
  }
  return numbers;
}

// Element e runs the parts e + 1, e + 1 + elements, …
TEST(ArrayJob, TheElementsOfMissingPartsRunThemAll) {
  std::mt19937 random(3);
  for (int repetition = 0; repetition < 200; ++repetition) {
    const cluster::ArrayJob job = cluster::array_job(1 + random() % 60, 1 + random() % 20);
    std::vector<std::int64_t> missing;
    for (std::int64_t part = 1; part <= job.parts; ++part)
      if (random() % 3 == 0) missing.push_back(part);
    const std::vector<std::int64_t> elements = cluster::elements_of(job, missing);
    EXPECT_EQ(read_list(cluster::index_list(elements)), elements);
    std::set<std::int64_t> run;
    for (const std::int64_t element : elements) {
      EXPECT_LT(element, job.elements);
      bool any = false;
      for (std::int64_t part = element + 1; part <= job.parts; part += job.elements) {
        run.insert(part);
        any = any || std::find(missing.begin(), missing.end(), part) != missing.end();
      }
      EXPECT_TRUE(any) << "element " << element << " has nothing to do";
    }
    for (const std::int64_t part : missing) EXPECT_TRUE(run.contains(part)) << part;
  }
}

TEST(ArrayJob, ListsRunsOfIndices) {
  const std::vector<std::int64_t> some{0, 1, 2, 5, 7, 8};
  EXPECT_EQ(cluster::index_list(some), "0-2,5,7-8");
}

}  // namespace
}  // namespace zerocount::testing
