#include "analysis/trials/goal/question_text.hpp"

#include <fmt/format.h>

namespace zerocount::goal {

std::string meeting_predicate(const Question& question) {
  return question.goal() ? "meet the goal" : fmt::format("end at zero counts{}", question.of_mass);
}

std::string meeting_noun(const Question& question) {
  return fmt::format("{} that {}", question.goal() ? "moves" : "trials", meeting_predicate(question));
}

std::string_view name_of_rate(const Question& question) {
  return question.goal() ? "rate of moves in goal" : "success rate";
}

std::string success_predicate(const Question& question) {
  return question.of_mass.empty() ? "succeed" : fmt::format("end at zero counts{}", question.of_mass);
}

std::string_view head_of_judged_rate(const Question& question) {
  if (!question.goal()) return "zero-count";
  return is_of_machines(question) ? "machines in goal" : "moves in goal";
}

std::string noun_of_judged_rate(const Question& question) {
  return is_of_machines(question) ? "machines that meet the goal" : meeting_noun(question);
}

}  // namespace zerocount::goal
