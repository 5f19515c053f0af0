#include "tests/fuzz/theory_use.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "analysis/basis/document/answer.hpp"
#include "analysis/trials/theory/point_theory.hpp"
#include "experiments/study/study.hpp"
#include "tests/fuzz/expectation.hpp"

namespace zerocount::fuzz {

void use_theory(const study::Study& study) {
  constexpr std::int64_t max_moves = 100;
  if (study.moves > max_moves) return;
  study::Study first = study;
  first.trials = 1;
  first.machines = std::min<std::int64_t>(study.machines, 1);
  const document::AnswerDescription<theory::PointTheory> answer{{.name = "theory", .meaning = "theory"},
                                                                theory::point_theory_description()};
  for (const std::int64_t point : std::set<std::int64_t>{0, study::point_count(study) - 1}) {
    std::vector<theory::KnownRotor> none;
    const std::string text = document::text(answer.of(theory::examine(first, point, 0, none)));
    if (!text.empty()) require_text(text);
  }
}

}  // namespace zerocount::fuzz
