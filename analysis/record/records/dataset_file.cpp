#include "analysis/record/records/dataset_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/basis/text/text.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::records {

DatasetFile::DatasetFile(const std::filesystem::path& path)
    : name_(path.string()),
      file_(is_mat_file(path) && !hdf5::is_hdf5_with_user_block(path)
                ? decltype(file_)(std::in_place_type<MatFile>, path)
                : decltype(file_)(std::in_place_type<hdf5::ArrayFile>, path)) {}

std::optional<std::vector<hdf5::Size>> DatasetFile::lengths_of(const std::string& path) const {
  return std::visit([&](const auto& file) { return file.lengths(path); }, file_);
}

std::string DatasetFile::columns_text() const {
  constexpr std::size_t max_listed = 20;
  std::vector<std::string> texts;
  for (const std::string& path : std::visit([](const auto& file) { return file.arrays(); }, file_)) {
    const std::vector<hdf5::Size> lengths = *lengths_of(path);
    texts.push_back(fmt::format("{} ({})", text::printable(path),
                                lengths.empty() ? "1" : fmt::format("{}", fmt::join(lengths, "×"))));
  }
  if (texts.empty()) return "none of numbers";
  const std::size_t shown = std::min(texts.size(), max_listed);
  std::string text =
      fmt::format("{}", fmt::join(texts.begin(), texts.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (texts.size() > shown) text += fmt::format(" and {} more", texts.size() - shown);
  return text;
}

DatasetFile::Vector DatasetFile::find(std::string_view column) const {
  std::size_t number = 0;  // 0: a vector
  const std::size_t hash = column.rfind('#');
  if (hash != std::string_view::npos) {
    const char* const end = column.data() + column.size();
    const auto [stop, error] = std::from_chars(column.data() + hash + 1, end, number);
    if (error != std::errc{} || stop != end || number == 0) return {};
  }
  Vector vector{std::string(column.substr(0, hash))};
  const std::optional<std::vector<hdf5::Size>> lengths = lengths_of(vector.path);
  if (!lengths || lengths->empty() || lengths->size() > 2) return {};
  const std::size_t rows = lengths->front();
  const std::size_t columns = lengths->size() == 2 ? lengths->back() : 1;
  const std::size_t length = std::max(rows, columns);
  const std::size_t vectors = std::min(rows, columns);
  if (number == 0 && vectors != 1) return {};
  if (number > vectors) return {};
  const std::size_t index = number == 0 ? 0 : number - 1;
  vector.count = length;
  vector.first = rows >= columns ? index : index * columns;
  vector.stride = rows >= columns ? columns : 1;
  return vector;
}

std::vector<double> DatasetFile::numbers(std::string_view column) const {
  const Vector vector = find(column);
  const std::vector<double> all =
      std::visit([&](const auto& file) { return file.values(vector.path); }, file_);
  std::vector<double> values;
  values.reserve(vector.count);
  for (std::size_t k = 0; k < vector.count; ++k) {
    values.push_back(all[vector.first + k * vector.stride]);
    if (std::isfinite(values.back())) continue;
    throw Failure(ExitCode::bad_data, fmt::format("{}: {}: element {} is not a finite number", name_,
                                                  text::printable(column), k));
  }
  return values;
}

}  // namespace zerocount::records
