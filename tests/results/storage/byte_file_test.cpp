#include "results/storage/byte_file.hpp"

#include <cerrno>

#include <sys/stat.h>

#include "core/hash/sha256.hpp"
#include "results/storage/durable_file.hpp"
#include "results/storage/file_contents.hpp"
#include "results/storage/output_file.hpp"
#include "results/timeline/timeline.hpp"
#include "tests/results/failures.hpp"
#include "tests/results/samples.hpp"
#include "tests/support/checksum.hpp"
#include "tests/support/test.hpp"

namespace zerocount::testing {
namespace {

std::string random_text(std::mt19937& random, std::size_t size) {
  std::string text(size, ' ');
  std::generate(text.begin(), text.end(), [&] { return static_cast<char>('a' + random() % 26); });
  return text;
}

std::string read_text(storage::ByteFile& file, std::size_t offset, std::size_t size) {
  std::string text(size, '?');
  EXPECT_TRUE(file.read(offset, std::as_writable_bytes(std::span(text))));
  return text;
}

/// Writes at random offsets of the file, and expects to read at each offset what was written there last, and
/// zeros elsewhere.
void expect_reads_what_was_written(storage::ByteFile& file, std::mt19937& random) {
  std::string expected(2000, '\0');
  for (int i = 0; i < 200; ++i) {
    const std::size_t offset = random() % 1900;
    const std::string text = random_text(random, random() % 100);
    file.write(offset, std::as_bytes(std::span(text)));
    expected.replace(offset, text.size(), text);
    const std::size_t first = random() % 1500;
    const std::size_t size = random() % 500;
    EXPECT_EQ(read_text(file, first, size), expected.substr(first, size));
  }
  EXPECT_EQ(read_text(file, 0, expected.size()), expected);
}

TEST(ByteFile, ReadsBackWrittenBytes) {
  const TemporaryFolder folder;
  std::mt19937 random(7);
  storage::ByteFile file(folder / "file", storage::ByteFile::Mode::create);
  expect_reads_what_was_written(file, random);
  const std::uint64_t size = file.size();
  file.resize(1000);
  EXPECT_EQ(file.size(), 1000U);
  EXPECT_LT(file.size(), size);
  file.close();
  EXPECT_FALSE(file.failure());
  EXPECT_EQ(std::filesystem::file_size(folder / "file"), 1000U);
}

TEST(ByteFile, ReadsBackPendingBytesAfterAFailedWrite) {
  std::mt19937 random(8);
  storage::ByteFile file("/dev/full", storage::ByteFile::Mode::change);
  expect_reads_what_was_written(file, random);
  ASSERT_TRUE(file.failure());
  EXPECT_EQ(file.failure()->action, "write");
  EXPECT_EQ(file.failure()->error, ENOSPC);
}

TEST(ByteFile, KeepsTheFirstFailure) {
  storage::ByteFile file("/dev/full", storage::ByteFile::Mode::change);
  file.note({"close", EIO});
  file.write(0, std::as_bytes(std::span("text")));
  file.note({"write", EBADF});
  EXPECT_EQ(file.failure()->action, "close");
  EXPECT_EQ(file.failure()->error, EIO);
}

TEST(ByteFile, GivesTheReasonIfItCannotBeOpened) {
  const TemporaryFolder folder;
  expect_failure(ExitCode::machine_failed, "nowhere: cannot read: No such file",
                 [&] { storage::ByteFile(folder / "nowhere", storage::ByteFile::Mode::read); });
  expect_failure(ExitCode::machine_failed, "cannot open for writing: Is a directory",
                 [&] { storage::ByteFile(folder.path(), storage::ByteFile::Mode::change); });
  expect_failure(ExitCode::bad_input, "this is not a regular file",
                 [&] { storage::ByteFile("/dev/full", storage::ByteFile::Mode::read); });
}

TEST(ChecksumTrailer, IsTheChecksumOfEverythingBeforeIt) {
  const TemporaryFolder folder;
  std::mt19937 random(19);
  for (const std::size_t size : {0U, 1U, 100U, (1U << 18) - 1, 1U << 18, (1U << 19) + 5}) {
    std::string bytes(size, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    const std::filesystem::path path = folder.write("file", bytes);
    append_checksum(path);
    const std::string text = "zerocount-seal sha256 " + hash::sha256_hex(bytes) + "\n";
    EXPECT_EQ(text.size(), storage::checksum_trailer_length);
    EXPECT_TRUE(folder.read("file") == bytes + text) << size;
    if (size > 0) storage::require_valid_checksum(path);
  }
}

TEST(ChecksumTrailer, APublishedFileHasTheChecksumOfItsBytes) {
  const TemporaryFolder folder;
  std::mt19937 random(23);
  for (const std::size_t size : {1U, 100U, (1U << 18) - 1, 1U << 18, (5U << 18) + 7}) {
    std::string bytes(size, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    folder.write("file.part", bytes);
    storage::WrittenBytes written;
    written.add(0, std::as_bytes(std::span(bytes)).first(size / 3), storage::Rewritten::as_a_whole);
    written.add(size / 2, std::as_bytes(std::span(bytes)).subspan(size / 2), storage::Rewritten::in_part);
    timeline::Timeline timeline;
    storage::publish_compared(folder / "file", written.require_in(folder / "file.part", &timeline));
    EXPECT_TRUE(folder.read("file") == bytes + "zerocount-seal sha256 " + hash::sha256_hex(bytes) + "\n")
        << size;
    EXPECT_FALSE(std::filesystem::exists(folder / "file.part"));
    EXPECT_TRUE(says(timeline.trace_events(), "\"read\""));
    storage::require_valid_checksum(folder / "file");
  }
}

// What is rewritten in part is known beside the new bytes.
TEST(WrittenBytes, AreAllKnownAfterALaterWrite) {
  const TemporaryFolder folder;
  std::string bytes = "0123456789";
  storage::WrittenBytes written;
  const auto write = [&](std::size_t offset, const std::string& text) {
    bytes.replace(offset, text.size(), text);
    written.add(offset, std::as_bytes(std::span(text)), storage::Rewritten::in_part);
  };
  write(0, bytes);
  write(3, "abc");
  write(5, "de");
  EXPECT_EQ(hash::hexadecimal(written.require_in(folder.write("file", bytes))), hash::sha256_hex(bytes));
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string changed = bytes;
    changed[at] = '-';
    expect_failure(ExitCode::machine_failed, "what was written is not what is read back",
                   [&] { written.require_in(folder.write("file", changed)); });
  }
}

TEST(ChecksumTrailer, AMissingOrWrongTrailerMeansChangedOrDamaged) {
  const TemporaryFolder folder;
  const std::filesystem::path path =
      folder.write("file", "some contents, longer than a trailer" + std::string(200, '.'));
  const std::string words = "changed since it was written, or damaged";
  expect_failure(ExitCode::bad_data, words, [&] { storage::require_valid_checksum(path); });
  append_checksum(path);
  std::string bytes = folder.read("file");
  bytes[3] = 'E';
  folder.write("file", bytes);
  expect_failure(ExitCode::bad_data, words, [&] { storage::require_valid_checksum(path); });
}

namespace fs = std::filesystem;

TEST(CreateFile, ReplacesARegularFileButNotItsOtherNames) {
  const TemporaryFolder folder;
  folder.write("notes", "my notes");
  fs::create_hard_link(folder / "notes", folder / "all.h5.part");
  EXPECT_TRUE(storage::create_file(folder / "all.h5.part").valid());
  EXPECT_EQ(fs::file_size(folder / "all.h5.part"), 0U);
  EXPECT_EQ(fs::file_size(folder / "notes"), 8U);
}

TEST(CreateFile, LeavesDirectoriesLinksAndPipesUnchanged) {
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

TEST(OutputFile, NeverReplacesAWriteProtectedFile) {
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

TEST(OutputFile, NeverReplacesALinkOrAPipe) {
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

TEST(OutputFile, TwoWritersNeverPublishAnUnfinishedFile) {
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
