#include "tests/fuzz/theory_use.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "runners/study_commands/point_theory_text.hpp"
#include "tests/fuzz/expectation.hpp"

namespace zerocount::fuzz {

void use_theory(const study::Study& study) {
  constexpr std::int64_t max_moves = 100;
  if (study.moves > max_moves) return;
  study::Study first = study;
  first.trials = 1;
  first.rigs = std::min<std::int64_t>(study.rigs, 1);
  for (const std::int64_t point : std::set<std::int64_t>{0, study::point_count(study) - 1}) {
    const std::vector<study_commands::TheoryItem> items =
        study_commands::theory_items(theory::examine(first, point));
    const std::string text = study_commands::theory_text({}, {{items}}, 1);
    if (!text.empty()) require_text(text);
  }
}

}  // namespace zerocount::fuzz
