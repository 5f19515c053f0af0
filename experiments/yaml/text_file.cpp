#include "experiments/yaml/text_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "core/failure/failure.hpp"

namespace zerocount::yaml {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_read(const fs::path& path, int error) {
  throw Failure(ExitCode::machine_failed,
                fmt::format("{}: cannot be read: {}", name_of_text(path), std::strerror(error)));
}

void require_file(const fs::path& path, std::string_view expected) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: no such file; expected {}", path.string(), expected));
  }
  if (fs::is_directory(status)) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("{}: this is a directory; expected {}", path.string(), expected));
  }
  if (!fs::is_regular_file(status) && !fs::is_fifo(status)) {
    throw Failure(ExitCode::bad_input, fmt::format("{}: this is not a regular file or pipe; expected {}",
                                                   path.string(), expected));
  }
}

std::string read_stream(const fs::path& path, std::FILE* stream, std::size_t max_size) {
  std::string text;
  std::array<char, 65536> block{};
  while (text.size() <= max_size) {
    const std::size_t size = std::fread(block.data(), 1, block.size(), stream);
    text.append(block.data(), size);
    if (size == block.size()) continue;
    if (std::ferror(stream) != 0) fail_to_read(path, errno);
    break;
  }
  if (text.size() > max_size) text.resize(max_size + 1);
  return text;
}

std::string read_bytes(const fs::path& path, std::size_t max_size, std::string_view expected) {
  if (is_standard_stream(path)) return read_stream(path, stdin, max_size);
  require_file(path, expected);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rbe"), std::fclose);
  if (!file) fail_to_read(path, errno);
  return read_stream(path, file.get(), max_size);
}

/// Characteristic bytes at an offset of a file by which its format is recognised.
struct Signature {
  std::string_view bytes;
  OtherFormat format;
  std::size_t place{0};
};

using namespace std::string_view_literals;  // signatures have zero bytes

constexpr std::string_view to_utf16 = "which 'iconv -f UTF-16 -t UTF-8' converts";
constexpr std::string_view as_csv = "which a spreadsheet program saves as CSV";
constexpr std::string_view as_table = "which the program that wrote it, or Python, saves as CSV";
constexpr OtherFormat hdf5_file{"an HDF5 file, such as a results file", ""};
constexpr OtherFormat zip_archive{"a zip archive, such as a workbook (.xlsx, .ods)",
                                  "which a spreadsheet program saves as CSV, or 'unzip' unpacks"};

/// The mark of UTF-32 begins with that of UTF-16, and comes before it.
constexpr std::array signatures{
    Signature{"\x1F\x8B"sv, {"a file compressed by gzip", "which 'gunzip' unpacks"}},
    Signature{"BZh"sv, {"a file compressed by bzip2", "which 'bunzip2' unpacks"}},
    Signature{"\xFD\x37zXZ\0"sv, {"a file compressed by xz", "which 'unxz' unpacks"}},
    Signature{"\x28\xB5\x2F\xFD"sv, {"a file compressed by zstd", "which 'unzstd' unpacks"}},
    Signature{"\x04\x22\x4D\x18"sv, {"a file compressed by lz4", "which 'unlz4' unpacks"}},
    Signature{"7z\xBC\xAF\x27\x1C"sv, {"a 7z archive", "which '7z x' unpacks"}},
    Signature{"PK\x03\x04"sv, zip_archive},
    Signature{"PK\x05\x06"sv, zip_archive},
    Signature{"ustar"sv, {"a tar archive", "which 'tar -xf' unpacks"}, 257},
    Signature{"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"sv, {"a workbook (.xls)", as_csv}},
    Signature{"\x89HDF\r\n\x1A\n"sv, hdf5_file},
    Signature{
        "\x89HDF\r\n\x1A\n"sv, {"a MATLAB file of version 7.3", "which 'writetable' saves as CSV"}, 512},
    Signature{"MATLAB 5.0 MAT-file"sv, {"a MATLAB file", "which 'writetable' saves as CSV"}},
    Signature{"PAR1"sv, {"a Parquet file", as_table}},
    Signature{"ARROW1"sv, {"an Arrow file", as_table}},
    Signature{"\x93NUMPY"sv, {"a NumPy file", "which 'numpy.savetxt' saves as text"}},
    Signature{"SQLite format 3\0"sv, {"an SQLite database", "which 'sqlite3 -csv' reads"}},
    Signature{"TDSm"sv, {"a TDMS file", as_table}},
    Signature{"MDF     "sv, {"an MDF file", as_table}},
    Signature{"%PDF-"sv, {"a PDF document", ""}},
    Signature{"\xFF\xFE\0\0"sv, {"text in UTF-32", "which 'iconv -f UTF-32 -t UTF-8' converts"}},
    Signature{"\0\0\xFE\xFF"sv, {"text in UTF-32", "which 'iconv -f UTF-32 -t UTF-8' converts"}},
    Signature{"\xFF\xFE"sv, {"text in UTF-16", to_utf16}},
    Signature{"\xFE\xFF"sv, {"text in UTF-16", to_utf16}}};

/// Number of zero bytes at every second place from `first` on.
std::size_t zeros_in_every_second(std::string_view bytes, std::size_t first) {
  std::size_t zeros = 0;
  for (std::size_t i = first; i < bytes.size(); i += 2) zeros += bytes[i] == '\0' ? 1 : 0;
  return zeros;
}

/// Text in UTF-16 without a mark, as far as its letters are Latin: one byte of nearly each pair is zero, and
/// the other one is not.
std::optional<OtherFormat> utf16_without_mark(std::string_view bytes) {
  const std::size_t pairs = bytes.size() / 2;
  const std::size_t first = zeros_in_every_second(bytes, 0);
  const std::size_t second = zeros_in_every_second(bytes, 1);
  if (pairs < 2 || 5 * std::max(first, second) < 4 * pairs || 5 * std::min(first, second) > pairs)
    return std::nullopt;
  return first > second ? OtherFormat{"text in UTF-16", "which 'iconv -f UTF-16BE -t UTF-8' converts"}
                        : OtherFormat{"text in UTF-16", "which 'iconv -f UTF-16LE -t UTF-8' converts"};
}

/// Whether texts do not have the character. Some have tabs, ends of lines, pages or files, and escapes.
bool is_control(char c) {
  constexpr std::string_view usual = "\t\n\v\f\r\x1A\x1B";
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && usual.find(c) == std::string_view::npos) || byte == 0x7F;
}

bool is_binary(std::string_view bytes) {
  constexpr std::size_t fewest = 4;   // fewer are faults in a text, which its reader places
  constexpr std::size_t rarest = 20;  // one of so many bytes
  const auto controls = static_cast<std::size_t>(std::ranges::count_if(bytes, is_control));
  return controls >= fewest && controls * rarest >= bytes.size();
}

}  // namespace

std::optional<OtherFormat> other_format(std::string_view contents) {
  for (const Signature& signature : signatures)
    if (contents.substr(std::min(signature.place, contents.size())).starts_with(signature.bytes))
      return signature.format;
  constexpr std::size_t bytes_read = 4096;
  const std::string_view beginning = contents.substr(0, bytes_read);
  if (const std::optional<OtherFormat> utf16 = utf16_without_mark(beginning)) return utf16;
  if (is_binary(beginning)) return OtherFormat{"a binary file", ""};
  return std::nullopt;
}

void require_text(std::string_view name, std::string_view contents, std::string_view expected) {
  const std::optional<OtherFormat> other = other_format(contents);
  if (!other) return;
  throw Failure(ExitCode::bad_input, fmt::format("{}: this is {}{}{}; expected {}", name, other->what,
                                                 other->remedy.empty() ? "" : ", ", other->remedy, expected));
}

bool is_standard_stream(const fs::path& path) {
  return path == "-";
}

bool is_stream(const fs::path& path) {
  std::error_code error;
  return is_standard_stream(path) || fs::is_fifo(path, error);
}

std::string name_of_text(const fs::path& path) {
  return is_standard_stream(path) ? "<stdin>" : path.string();
}

std::string read_text(const fs::path& path, std::size_t max_size, std::string_view expected) {
  std::string text = read_bytes(path, max_size, expected);
  require_text(name_of_text(path), text, expected);
  return text;
}

}  // namespace zerocount::yaml
