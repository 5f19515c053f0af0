#include <algorithm>

#include <fmt/format.h>

#include "results/layout/walk.hpp"
#include "results/reading/study_file.hpp"

namespace zerocount {

void StudyFile::verify() const {
  read_everything(file_);
  verify_numbering();
}

void StudyFile::verify_numbering() const {
  const auto require_counting = [](const hdf5::Dataset& dataset, std::int64_t count, auto expected) {
    std::vector<std::int64_t> numbers;
    for (std::int64_t first = 0; first < count; first += chunk_elements) {
      numbers.resize(static_cast<std::size_t>(std::min(chunk_elements, count - first)));
      dataset.read(first, std::ssize(numbers), numbers.data());
      for (std::int64_t i = 0; i < std::ssize(numbers); ++i) {
        if (numbers[static_cast<std::size_t>(i)] != expected(first + i)) {
          dataset.fail(fmt::format("entry {} is {}; expected {}", first + i,
                                   numbers[static_cast<std::size_t>(i)], expected(first + i)));
        }
      }
    }
  };
  const std::int64_t start = rows().first;
  const std::int64_t trials = header_.trials;
  const auto row = [start](std::int64_t i) { return start + i; };
  require_counting(trials_.row_scale(), trials_.rows(), row);
  require_counting(outcomes_.row_scale(), outcomes_.rows(), row);
  require_counting(trials_.column(0), trials_.rows(), [=](std::int64_t i) { return (start + i) / trials; });
  require_counting(trials_.column(1), trials_.rows(), [=](std::int64_t i) { return (start + i) % trials; });
  std::int64_t previous = start;
  for (std::int64_t first = 0; first < jerk_count(); first += chunk_elements) {
    for (const JerkRecord& jerk : jerks_at(first, std::min(chunk_elements, jerk_count() - first))) {
      if (jerk.trial < previous || jerk.trial >= rows().end())
        jerks_.column(0).fail("its trials are out of order");
      previous = jerk.trial;
    }
  }
}

}  // namespace zerocount
