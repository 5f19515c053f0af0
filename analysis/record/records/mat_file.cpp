#include "analysis/record/records/mat_file.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <numeric>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <matio.h>

#include "core/failure/failure.hpp"
#include "results/storage/file_contents.hpp"

namespace zerocount::records {
namespace {

constexpr std::string_view beginning = "MATLAB 5.0 MAT-file";
constexpr std::size_t header_size = 128;
constexpr std::size_t tag_size = 8;

/// Set to true when libmatio reports an error. Its functions return null both for an error and at the end of
/// a file; this flag tells the two apart.
thread_local bool complains = false;

void note_complaint(int, char*) {
  complains = true;
}

std::uint32_t word_at(std::string_view bytes, std::size_t place, bool big_endian) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < sizeof word; ++i)
    word = word << 8U | static_cast<unsigned char>(bytes[place + (big_endian ? i : 3 - i)]);
  return word;
}

/// Byte offsets of the variables in a MAT file of version 5. Each variable begins with a tag that holds its
/// type and its size.
/// @throws Failure (bad_data) if the last variable is cut off.
std::vector<std::size_t> variables_of(const std::filesystem::path& path) {
  const std::size_t size = std::filesystem::file_size(path);
  const bool big_endian = storage::bytes_at(path, header_size - 2, 2) == "MI";
  std::vector<std::size_t> places;
  std::size_t end = header_size;
  while (end < size) {
    const std::string tag = storage::bytes_at(path, end, tag_size);
    if (tag.size() == tag_size) places.push_back(end);
    end += tag_size + (tag.size() == tag_size ? word_at(tag, 4, big_endian) : 0);
  }
  if (end == size) return places;
  throw Failure(ExitCode::bad_data,
                fmt::format("{}: damaged: ends at byte {}, expected {}", path.string(), size, end));
}

template <class Number>
std::vector<double> values_as(const matvar_t& variable) {
  const auto* const first = static_cast<const Number*>(variable.data);
  return {first, first + variable.nbytes / sizeof(Number)};
}

/// All elements of a variable as numbers; empty if it does not hold numbers.
std::vector<double> values_of(const matvar_t& variable) {
  switch (variable.class_type) {
    case MAT_C_DOUBLE:
      return values_as<double>(variable);
    case MAT_C_SINGLE:
      return values_as<float>(variable);
    case MAT_C_INT8:
      return values_as<std::int8_t>(variable);
    case MAT_C_UINT8:
      return values_as<std::uint8_t>(variable);
    case MAT_C_INT16:
      return values_as<std::int16_t>(variable);
    case MAT_C_UINT16:
      return values_as<std::uint16_t>(variable);
    case MAT_C_INT32:
      return values_as<std::int32_t>(variable);
    case MAT_C_UINT32:
      return values_as<std::uint32_t>(variable);
    case MAT_C_INT64:
      return values_as<std::int64_t>(variable);
    case MAT_C_UINT64:
      return values_as<std::uint64_t>(variable);
    default:
      return {};
  }
}

std::string rooted(const std::string& path) {
  return path.starts_with('/') ? path : "/" + path;
}

}  // namespace

bool is_mat_file(const std::filesystem::path& path) {
  return storage::bytes_at(path, 0, beginning.size()) == beginning;
}

MatFile::MatFile(const std::filesystem::path& path) {
  const std::vector<std::size_t> variables = variables_of(path);
  Mat_LogInitFunc("", note_complaint);
  complains = false;
  const std::unique_ptr<mat_t, decltype(&Mat_Close)> file(Mat_Open(path.c_str(), MAT_ACC_RDONLY), Mat_Close);
  for (const std::size_t place : variables) {
    const std::unique_ptr<matvar_t, decltype(&Mat_VarFree)> variable(
        file ? Mat_VarReadNext(file.get()) : nullptr, Mat_VarFree);
    if (!variable || complains)
      throw Failure(ExitCode::bad_data,
                    fmt::format("{}: damaged: the variable at byte {} cannot be read", path.string(), place));
    add(*variable, "");
  }
}

void MatFile::add(const matvar_t& variable, const std::string& folder) {
  if (variable.name == nullptr || *variable.name == '\0') return;
  const std::string path = folder + "/" + variable.name;
  std::vector<hdf5::Size> lengths(variable.dims, variable.dims + variable.rank);
  const auto count = std::accumulate(lengths.begin(), lengths.end(), hdf5::Size{1}, std::multiplies());
  if (variable.data == nullptr || variable.isComplex != 0) return;
  if (variable.class_type == MAT_C_STRUCT && count == 1) {
    auto* const structure = const_cast<matvar_t*>(&variable);
    for (unsigned i = 0; i < Mat_VarGetNumberOfFields(structure); ++i)
      if (const matvar_t* const field = Mat_VarGetStructFieldByIndex(structure, i, 0)) add(*field, path);
    return;
  }
  std::vector<double> values = values_of(variable);
  std::ranges::reverse(lengths);
  if (values.size() == count && count > 0) arrays_[path] = {std::move(lengths), std::move(values)};
}

std::vector<std::string> MatFile::arrays() const {
  std::vector<std::string> paths;
  for (const auto& [path, array] : arrays_) paths.push_back(path);
  return paths;
}

std::optional<std::vector<hdf5::Size>> MatFile::lengths(const std::string& path) const {
  const auto found = arrays_.find(rooted(path));
  return found == arrays_.end() ? std::nullopt : std::optional(found->second.lengths);
}

std::vector<double> MatFile::values(const std::string& path) const {
  return arrays_.at(rooted(path)).values;
}

}  // namespace zerocount::records
