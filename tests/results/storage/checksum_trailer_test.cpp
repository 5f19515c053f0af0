#include "results/storage/checksum_trailer.hpp"

#include <random>

#include <gtest/gtest.h>

#include "core/hash/sha256.hpp"
#include "results/timeline/timeline.hpp"
#include "tests/results/failures.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zerocount::testing {
namespace {

TEST(ChecksumTrailer, IsTheChecksumOfEverythingBeforeIt) {
  const TemporaryFolder folder;
  std::mt19937 random(19);
  for (const std::size_t size : {0U, 1U, 100U, (1U << 18) - 1, 1U << 18, (1U << 19) + 5}) {
    std::string bytes(size, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    const std::filesystem::path path = folder.write("file", bytes);
    storage::append_checksum(path);
    const std::string text = "zerocount-seal sha256 " + hash::sha256_hex(bytes) + "\n";
    EXPECT_EQ(text.size(), storage::checksum_trailer_length);
    EXPECT_TRUE(folder.read("file") == bytes + text) << size;
    if (size > 0) storage::require_valid_checksum(path);
  }
}

TEST(ChecksumTrailer, OfAPublishedFileIsThatOfItsBytes) {
  const TemporaryFolder folder;
  std::mt19937 random(23);
  for (const std::size_t size : {1U, 100U, (1U << 18) - 1, 1U << 18, (5U << 18) + 7}) {
    std::string bytes(size, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    folder.write("file.part", bytes);
    timeline::Timeline timeline;
    storage::publish_compared(folder / "file",
                              storage::checksum_of_contents(folder / "file.part", &timeline));
    EXPECT_TRUE(folder.read("file") == bytes + "zerocount-seal sha256 " + hash::sha256_hex(bytes) + "\n")
        << size;
    EXPECT_FALSE(std::filesystem::exists(folder / "file.part"));
    EXPECT_NE(timeline.trace_events().find("\"read\""), std::string::npos);
    storage::require_valid_checksum(folder / "file");
  }
}

TEST(ChecksumTrailer, ThatIsMissingOrWrongMeansChangedOrDamaged) {
  const TemporaryFolder folder;
  const std::filesystem::path path =
      folder.write("file", "some contents, longer than a trailer" + std::string(200, '.'));
  const std::string words = "changed since it was written, or damaged";
  expect_failure(ExitCode::bad_data, words, [&] { storage::require_valid_checksum(path); });
  storage::append_checksum(path);
  std::string bytes = folder.read("file");
  bytes[3] = 'E';
  folder.write("file", bytes);
  expect_failure(ExitCode::bad_data, words, [&] { storage::require_valid_checksum(path); });
}

}  // namespace
}  // namespace zerocount::testing
