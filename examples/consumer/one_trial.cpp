// One trial of the paper's axis: a move of 5 counts, held for one second.
#include <cstdio>

#include "core/trial/trial.hpp"

int main() {
  zerocount::trial::TrialParameters axis;  // the defaults are the paper's machine
  axis.command.targets = {5};              // counts
  axis.command.hold = 1.0;                 // s

  const zerocount::trial::TrialOutcome outcome = zerocount::trial::run_trial(axis);
  const zerocount::trial::MoveOutcome& move = outcome.moves.front();
  const bool zero = move.outcome == zerocount::trial::Outcome::zero_count;
  std::printf("%s, settled after %.4f s\n", zero ? "zero counts of error" : "not at zero", move.arrival_time);
  return zero ? 0 : 1;
}
