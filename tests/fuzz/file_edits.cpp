#include "tests/fuzz/file_edits.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <string_view>

#include <sys/types.h>

#include "core/hash/sha256.hpp"
#include "results/storage/file_contents.hpp"
#include "tests/fuzz/hdf5_edits.hpp"
#include "tests/fuzz/sample_files.hpp"

// In place of the system's: every child process has ended well without having run, so that the target itself
// reads its files, and what happens then is seen (see hdf5::open_foreign).
extern "C" pid_t fork() noexcept {
  return 1;
}
extern "C" pid_t waitpid(pid_t child, int* status, int) {
  *status = 0;
  return child;
}

namespace zerocount::fuzz {
namespace {

constexpr std::string_view trailer_start = "zerocount-seal sha256 ";

enum Kind : std::uint8_t {
  integer_attribute,
  text_attribute,
  remove_attribute,
  number_element,
  text_element,
  resize,
  remove_object,
  rename_object,
  to_group,
  to_dataset,
  overwrite,  // bytes of the file, not through the library
  edit_kinds
};

std::uint64_t bits_of(double value) {
  return std::bit_cast<std::uint64_t>(value);
}

/// The number that an edit stores: its value itself, a small whole number as integer or as real, or a special
/// value.
std::uint64_t number_of(const Edit& edit) {
  using Limits = std::numeric_limits<double>;
  static const std::array special{bits_of(Limits::quiet_NaN()),
                                  bits_of(Limits::infinity()),
                                  bits_of(-Limits::infinity()),
                                  bits_of(Limits::max()),
                                  bits_of(-0.0),
                                  std::uint64_t{1} << 31U,
                                  std::uint64_t{1} << 40U,
                                  std::uint64_t{1} << 53U,
                                  std::uint64_t{1} << 63U,
                                  (std::uint64_t{1} << 63U) - 1};
  const auto small = static_cast<std::int8_t>(edit.value & 0xffU);
  switch (edit.choice % 4) {
    case 0:
      return edit.value;
    case 1:
      return static_cast<std::uint64_t>(std::int64_t{small});
    case 2:
      return bits_of(small);
    default:
      return special[edit.value % special.size()];
  }
}

/// The text that an edit stores: one of some texts that occur in files, or the bytes of the edit's value.
std::string text_of(const Edit& edit) {
  static const std::array<std::string_view, 39> texts{"",
                                                      "rad",
                                                      "m",
                                                      "1",
                                                      "s",
                                                      "axis",
                                                      "statistic",
                                                      "zerocount-study",
                                                      "batch",
                                                      "reference",
                                                      "/trial",
                                                      "long_name",
                                                      "\xff\xfe",
                                                      "a\nb\x1b[31m",
                                                      "n\xc3\xa4me",
                                                      "trials=1",
                                                      "trials=3",
                                                      "machines=2",
                                                      "machines=0",
                                                      "command.hold=0.3",
                                                      "command.targets=[1, 2, 3]",
                                                      "command.targets=[5]",
                                                      "command={torque: [1, 2], hold: 0.1}",
                                                      "command.sequence={positions: 3}",
                                                      "axis=linear",
                                                      "axis=rotary",
                                                      "friction.model=dahl",
                                                      "friction.model=none",
                                                      "sweep={grid: {controller.kp: [0, 1.0e-4, 2.0e-4]}}",
                                                      "sweep={}",
                                                      "design=sobol",
                                                      "design=saltelli",
                                                      "seed=1",
                                                      "encoder.coarse=1000",
                                                      "stop={success_rate_halfwidth: 0.1}",
                                                      "retain={trials: [0]}",
                                                      "plant.load={inertia: 1.0e-3}",
                                                      "[]",
                                                      "{}"};
  if (edit.choice % 2 == 1) return std::string(texts[edit.value % texts.size()]);
  std::array<char, sizeof edit.value> bytes{};
  std::memcpy(bytes.data(), &edit.value, sizeof edit.value);
  return {bytes.data(), strnlen(bytes.data(), bytes.size())};
}

void edit_attribute(const EditedHdf5& file, const AttributePlace& attribute, const Edit& edit) {
  if (edit.kind == integer_attribute) file.set_integer(attribute, static_cast<std::int64_t>(number_of(edit)));
  if (edit.kind == text_attribute) file.set_text(attribute, text_of(edit));
  if (edit.kind == remove_attribute) file.remove(attribute);
}

void edit_object(const EditedHdf5& file, const std::string& path, const Edit& edit) {
  constexpr unsigned ranks = 4;
  if (edit.kind == number_element) file.set_element(path, edit.place, number_of(edit));
  if (edit.kind == text_element) file.set_element(path, edit.place, text_of(edit));
  if (edit.kind == resize) file.resize(path, number_of(edit));
  if (edit.kind == remove_object) file.remove(path);
  if (edit.kind == rename_object) file.rename(path, path + text_of(edit));
  if (edit.kind == to_group) file.replace_by_group(path);
  if (edit.kind == to_dataset)
    file.replace_by_dataset(path, edit.choice, edit.place % ranks, edit.value % 100);
}

void edit_with_library(const SampleFile& sample, std::span<const Edit> edits, const MemoryFile& memory) {
  if (std::all_of(edits.begin(), edits.end(), [](const Edit& edit) { return edit.kind == overwrite; }))
    return;
  const EditedHdf5 file(memory.path());
  for (const Edit& edit : edits) {
    edit_attribute(file, sample.attributes[edit.object % sample.attributes.size()], edit);
    edit_object(file, sample.objects[edit.object % sample.objects.size()], edit);
  }
}

/// Overwrites up to 8 bytes of the file, starting at a byte that is not 0 in the sample.
void overwrite_bytes(const SampleFile& sample, std::span<const Edit> edits, std::string& bytes) {
  for (const Edit& edit : edits) {
    if (edit.kind != overwrite) continue;
    const std::size_t first = sample.used[edit.place % sample.used.size()];
    if (first >= bytes.size()) continue;
    const std::size_t size = std::min<std::size_t>(1U + edit.choice % 8U, bytes.size() - first);
    std::memcpy(bytes.data() + first, &edit.value, size);
  }
}

std::string without_trailer(std::string bytes) {
  if (bytes.size() < storage::checksum_trailer_length) return bytes;
  const std::size_t place = bytes.size() - storage::checksum_trailer_length;
  if (std::string_view(bytes).substr(place).starts_with(trailer_start)) bytes.resize(place);
  return bytes;
}

}  // namespace

std::vector<SampleFile> editable_files(const std::string& target) {
  std::vector<SampleFile> samples;
  MemoryFile file;
  for (std::string& bytes : sample_files(target)) {
    SampleFile sample{without_trailer(std::move(bytes)), {}, {}, {}};
    file.replace(sample.bytes);
    EditedHdf5(file.path()).list(sample);
    for (std::size_t i = 0; i < sample.bytes.size(); ++i) {
      if (sample.bytes[i] != '\0') sample.used.push_back(i);
    }
    samples.push_back(std::move(sample));
  }
  return samples;
}

std::vector<Edit> edits_of(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t max_edits = 32;
  static_assert(sizeof(Edit) == 16);
  std::vector<Edit> edits(std::min(max_edits, bytes.size() / sizeof(Edit)));
  if (!edits.empty()) std::memcpy(edits.data(), bytes.data(), edits.size() * sizeof(Edit));
  for (Edit& edit : edits) edit.kind %= edit_kinds;
  return edits;
}

void write_edited(const SampleFile& sample, std::span<const Edit> edits, MemoryFile& file) {
  file.replace(sample.bytes);
  edit_with_library(sample, edits, file);
  std::string bytes = file.bytes();
  overwrite_bytes(sample, edits, bytes);
  const std::string digest = hash::sha256_hex(bytes);
  file.replace(bytes.append(trailer_start).append(digest).append("\n"));
}

void write_input(const std::vector<SampleFile>& samples, std::span<const std::uint8_t> input,
                 MemoryFile& file) {
  write_edited(samples[input[0] % samples.size()], edits_of(input.subspan(1)), file);
}

}  // namespace zerocount::fuzz
