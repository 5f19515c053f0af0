#pragma once

#include <string>
#include <vector>

#include "experiments/study.hpp"
#include "results/checksum.hpp"

namespace zerocount {

/// Checksum of the texts in /point: labels, then the axes that are texts.
inline std::string point_texts_checksum(std::vector<std::string> labels, const std::vector<SweepAxis>& axes) {
  for (const SweepAxis& axis : axes) {
    if (axis.kind == SweepAxis::Kind::text) labels.insert(labels.end(), axis.texts.begin(), axis.texts.end());
  }
  return sha256_of_texts(labels);
}

}  // namespace zerocount
