#include <sys/stat.h>

#include "results/storage/durable_file.hpp"
#include "results/storage/output_file.hpp"
#include "tests/results/failures.hpp"
#include "tests/results/samples.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

namespace fs = std::filesystem;

TEST(CreateFile, ReplacesARegularFileButNotItsOtherNames) {
  const TemporaryFolder folder;
  folder.write("notes", "my notes");
  fs::create_hard_link(folder / "notes", folder / "all.h5.part");
  EXPECT_TRUE(storage::create_file(folder / "all.h5.part").valid());
  EXPECT_EQ(fs::file_size(folder / "all.h5.part"), 0U);
  EXPECT_EQ(fs::file_size(folder / "notes"), 8U);
}

TEST(CreateFile, LeavesEverythingElseAsItIs) {
  const TemporaryFolder folder;
  folder.write("notes", "my notes");
  fs::create_symlink(folder / "notes", folder / "link.part");
  fs::create_symlink(folder / "nowhere", folder / "broken.part");
  fs::create_directory(folder / "folder.part");
  ASSERT_EQ(::mkfifo((folder / "pipe.part").c_str(), 0666), 0);
  for (const char* name : {"link", "broken", "folder", "pipe"}) {
    const fs::path part = folder / (std::string(name) + ".part");
    const fs::file_type before = fs::symlink_status(part).type();
    const auto refuses = [&](const auto& action) {
      expect_failure(ExitCode::machine_failed, "it exists and is not a regular file", action);
    };
    refuses([&] { storage::create_file(part); });
    refuses([&] { storage::UnfinishedFile{folder / name}; });
    refuses([&] { storage::replace_file(folder / name, "text"); });
    EXPECT_EQ(fs::symlink_status(part).type(), before) << name;
  }
  EXPECT_EQ(fs::file_size(folder / "notes"), 8U);
  EXPECT_FALSE(fs::exists(folder / "nowhere"));
}

TEST(OutputFile, KeepsThePermissionsOfTheFileThatItReplaces) {
  const TemporaryFolder folder;
  const fs::path path = folder / "all.csv";
  for (const auto mode : {0600, 0640, 0666, 0755}) {
    folder.write("all.csv", "earlier");
    fs::permissions(path, fs::perms(mode));
    storage::replace_file(path, "text");
    EXPECT_EQ(fs::status(path).permissions(), fs::perms(mode));
    EXPECT_EQ(folder.read("all.csv"), "text");
  }
}

TEST(OutputFile, ReplacesNoFileThatIsWriteProtected) {
  const TemporaryFolder folder;
  folder.write("all.csv", "earlier");
  fs::permissions(folder / "all.csv", fs::perms(0444));
  const auto refuses = [&](const auto& action) {
    expect_failure(ExitCode::machine_failed, "all.csv: cannot be replaced: it is write-protected", action);
  };
  refuses([&] { storage::require_replaceable(folder / "all.csv"); });
  refuses([&] { storage::replace_file(folder / "all.csv", "text"); });
  refuses([&] { storage::UnfinishedFile{folder / "all.csv"}; });
  refuses([&] { storage::publish(folder / "all.csv"); });
  EXPECT_EQ(folder.read("all.csv"), "earlier");
  EXPECT_FALSE(fs::exists(folder / "all.csv.part"));
}

TEST(OutputFile, ReplacesNoLinkAndNoPipe) {
  const TemporaryFolder folder;
  folder.write("notes", "my notes");
  fs::create_symlink(folder / "notes", folder / "link");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0666), 0);
  for (const char* name : {"link", "pipe"}) {
    expect_failure(ExitCode::machine_failed, "it exists and is not a regular file",
                   [&] { storage::replace_file(folder / name, "text"); });
  }
  EXPECT_EQ(folder.read("notes"), "my notes");
}

TEST(OutputFile, OfTwoAtOnceTheUnfinishedOneIsNotPublished) {
  const TemporaryFolder folder;
  std::optional<storage::OutputFile> first(folder / "all.csv");
  first->write("all of the first");
  first->finish();
  storage::OutputFile second(folder / "all.csv");
  second.write("half of");
  expect_failure(ExitCode::machine_failed, "all.csv: another command is writing this output",
                 [&] { first->publish(); });
  EXPECT_FALSE(fs::exists(folder / "all.csv"));
  first.reset();  // leaves the file of the second
  second.write(" the second");
  second.finish();
  second.publish();
  EXPECT_EQ(folder.read("all.csv"), "half of the second");
}

}  // namespace
}  // namespace zerocount::testing
