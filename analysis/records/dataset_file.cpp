#include "analysis/records/dataset_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/text/text.hpp"
#include "core/failure/failure.hpp"

namespace zerocount::records {

std::string DatasetFile::columns_text() const {
  constexpr std::size_t max_listed = 20;
  std::vector<std::string> texts;
  for (const std::string& path : file_.arrays()) {
    const std::vector<hdf5::Size> lengths = *file_.lengths(path);
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
  const std::optional<std::vector<hdf5::Size>> lengths = file_.lengths(vector.path);
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
  const std::vector<double> all = file_.values(vector.path);
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
