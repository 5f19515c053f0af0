// Files that the user names as texts and that are none.
#include "experiments/yaml/text_file.hpp"

#include "core/failure/failure.hpp"
#include "tests/support/refusal.hpp"

namespace zerocount::yaml {
namespace {

using namespace std::string_literals;

const std::string table = "arrival_time [ms],overshoot\n41.5,0\n43.5,1\n40.25,0\n";

/// The text encoded with `bytes` bytes per character, as in UTF-16 (2) and UTF-32 (4). Its letters must be
/// ASCII.
std::string widened(const std::string& text, std::size_t bytes, bool big_endian) {
  std::string wide;
  for (const char c : text) {
    const std::string zeros(bytes - 1, '\0');
    wide += big_endian ? zeros + c : c + zeros;
  }
  return wide;
}

std::string format_of(std::string_view contents) {
  const std::optional<OtherFormat> other = other_format(contents);
  return other ? fmt::format("{}: {}", other->what, other->remedy) : "text";
}

TEST(TextFile, FormatIsKnownByItsFirstBytes) {
  const std::string rest = "\x01\x02 and more";
  for (const auto& [signature, words] : std::vector<std::pair<std::string, std::string>>{
           {"\x1F\x8B\x08\x00"s, "gzip: which 'gunzip' unpacks"},
           {"BZh9"s, "bzip2"},
           {"\xFD\x37zXZ\0"s, "xz"},
           {"\x28\xB5\x2F\xFD"s, "zstd"},
           {"PK\x03\x04"s, "workbook (.xlsx"},
           {"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"s, "workbook (.xls)"},
           {"\x89HDF\r\n\x1A\n"s, "HDF5"},
           {"MATLAB 5.0 MAT-file, Platform: GLNXA64"s, "MATLAB"},
           {"PAR1"s, "Parquet"},
           {"SQLite format 3\0"s, "SQLite"}})
    EXPECT_NE(format_of(signature + rest).find(words), std::string::npos)
        << words << ", " << format_of(signature + rest);
  EXPECT_EQ(format_of(std::string(512, '\0') + "\x89HDF\r\n\x1A\n"),
            "a MATLAB file of version 7.3: which 'writetable' saves as CSV");
}

TEST(TextFile, WideTextIsNamedWithAndWithoutItsMark) {
  for (const auto& [contents, converter] : {std::pair{"\xFF\xFE"s + widened(table, 2, false), "UTF-16 -t"},
                                            {"\xFE\xFF"s + widened(table, 2, true), "UTF-16 -t"},
                                            {widened(table, 2, false), "UTF-16LE -t"},
                                            {widened(table, 2, true), "UTF-16BE -t"},
                                            {"\xFF\xFE\0\0"s + widened(table, 4, false), "UTF-32 -t"},
                                            {"\0\0\xFE\xFF"s + widened(table, 4, true), "UTF-32 -t"}})
    EXPECT_NE(format_of(contents).find(converter), std::string::npos) << format_of(contents);
}

TEST(TextFile, TextsAreNotTakenForBinaryFiles) {
  for (const std::string& text :
       {""s, "\n"s, table, "\xEF\xBB\xBF" + table,
        "# 25 \xB0"
        "C\n" +
            table,
        "# 25 °C, µm\r\n" + table, table + "\x1A", "\f" + table, "P,K\n1,2\n"s, table + '\0', "a\0b\n"s})
    EXPECT_EQ(format_of(text), "text") << text;
}

TEST(TextFile, RandomBytesAreBinary) {
  std::mt19937 generator(7);
  std::uniform_int_distribution<int> bytes(0, 255);
  for (int file = 0; file < 200; ++file) {
    std::string contents;
    for (int i = 0; i < 400; ++i) contents += static_cast<char>(bytes(generator));
    EXPECT_NE(format_of(contents), "text");
  }
}

TEST(TextFile, BinaryFilesAreRefusedWithFormatAndRemedy) {
  EXPECT_EQ(refusal_by([] { require_text("log.csv.gz", "\x1F\x8B\x08", "a log of moves"); }),
            "log.csv.gz: this is a file compressed by gzip, which 'gunzip' unpacks; expected a log of moves");
  EXPECT_EQ(refusal_by([] { require_text("log.csv", table, "a log of moves"); }), "");
}

}  // namespace
}  // namespace zerocount::yaml
