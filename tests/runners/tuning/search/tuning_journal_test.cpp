// What a journal keeps of an evaluation is read back to the bit.
#include "runners/tuning/search/tuning_journal.hpp"

#include "tests/support/temporary_folder.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

using tuning::ClaimResult;
using tuning::MachineResult;

MachineResult random_unit(std::mt19937_64& random) {
  MachineResult machine{.claims = {}, .slid = random() % 2 == 0};
  for (std::uint64_t claims = random() % 3 + 1; claims > 0; --claims) {
    ClaimResult& claim = machine.claims.emplace_back();
    for (std::uint64_t moves = random() % 4; moves > 0; --moves) {
      ++claim.moves;
      claim.met += random() % 2 == 0 ? 1 : 0;
      claim.values.push_back(random() % 3 == 0
                                 ? std::numeric_limits<double>::infinity()
                                 : std::exp(std::uniform_real_distribution<double>(-30.0, 30.0)(random)));
    }
  }
  return machine;
}

TEST(TuningJournal, ReadsBackWrittenEntries) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "journal";
  std::mt19937_64 random(12);
  std::vector<tuning::Values> values;
  std::vector<std::vector<MachineResult>> results;
  std::vector<std::string> lines;
  for (int candidate = 0; candidate < 20; ++candidate) {
    values.push_back({static_cast<double>(candidate), std::exp(-1.0 * candidate)});
    results.emplace_back();
    for (int machine = 0; machine < candidate; ++machine) results.back().push_back(random_unit(random));
    lines.push_back(tuning::evaluation_line("search", values.back(), 0, results.back(), 1.5));
  }
  tuning::TuningJournal(path, "tuning", false).add(lines);
  tuning::TuningJournal journal(path, "tuning", false);
  EXPECT_TRUE(journal.resumed());
  EXPECT_EQ(journal.seconds(), 1.5);
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::vector<MachineResult> found;
    journal.take("search", values[i], 0, std::ssize(results[i]), found);
    ASSERT_EQ(found.size(), results[i].size());
    for (std::size_t machine = 0; machine < found.size(); ++machine) {
      const MachineResult& written = results[i][machine];
      EXPECT_EQ(found[machine].slid, written.slid);
      ASSERT_EQ(found[machine].claims.size(), written.claims.size());
      for (std::size_t c = 0; c < written.claims.size(); ++c) {
        EXPECT_EQ(found[machine].claims[c].moves, written.claims[c].moves);
        EXPECT_EQ(found[machine].claims[c].met, written.claims[c].met);
        EXPECT_EQ(found[machine].claims[c].values, written.claims[c].values);
      }
    }
  }
}

// It named a file that was not there.
TEST(TuningJournal, IsNamedByAnInterruptionOnlyIfItExists) {
  const TemporaryFolder folder;
  const std::filesystem::path output = folder / "tuned.h5";
  EXPECT_FALSE(says(tuning::interruption_text(output), output.string()));
  const std::string line = tuning::evaluation_line("search", {1.0}, 0, {}, 1.0);
  tuning::TuningJournal(tuning::journal_path(output), "tuning", false).add({&line, 1});
  EXPECT_TRUE(says(tuning::interruption_text(output), tuning::journal_path(output).string()));
}

}  // namespace
}  // namespace zerocount::testing
