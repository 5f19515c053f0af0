#include "analysis/goal/goal_description.hpp"

namespace zerocount::goal {

std::vector<std::string> status_words() {
  std::vector<std::string> words;
  for (const Status status : {Status::met, Status::missed, Status::undecided})
    words.emplace_back(text_of(status));
  return words;
}

document::Description<Needs> needs_description() {
  return document::Description<Needs>()
      .value({.key = "rigs", .meaning = "machines; 0 without rigs"}, &Needs::rigs)
      .value({.key = "trials", .meaning = "trials of a design point"}, &Needs::trials);
}

const Needs* practicable(const std::optional<Needs>& needs) {
  return needs && needs->trials > 0 ? &*needs : nullptr;
}

}  // namespace zerocount::goal
