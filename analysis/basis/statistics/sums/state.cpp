#include "analysis/basis/statistics/sums/state.hpp"

#include <algorithm>

#include "core/failure/failure.hpp"

namespace zerocount::statistics {

bool are_counts(std::span<const std::int64_t> counts, std::int64_t most) {
  return std::ranges::all_of(counts, [most](std::int64_t count) { return count >= 0 && count <= most; });
}

void StateReader::fail() {
  throw Failure(ExitCode::bad_data, "the sums of a design point are not those of this study");
}

std::int64_t StateReader::next_whole() {
  if (whole_.empty()) fail();
  const std::int64_t number = whole_.front();
  whole_ = whole_.subspan(1);
  return number;
}

double StateReader::next_real() {
  if (real_.empty()) fail();
  const double number = real_.front();
  real_ = real_.subspan(1);
  return number;
}

std::size_t StateReader::next_size() {
  const std::int64_t size = next_whole();
  if (size < 0 || static_cast<std::size_t>(size) > whole_.size() + real_.size()) fail();
  return static_cast<std::size_t>(size);
}

void StateReader::require_end() const {
  if (!whole_.empty() || !real_.empty()) fail();
}

}  // namespace zerocount::statistics
