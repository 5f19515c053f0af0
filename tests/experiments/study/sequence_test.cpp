// What a sequence of moves promises, for random sequences.
#include "experiments/study/sequence.hpp"

#include "tests/support/test.hpp"

namespace zerocount::study {
namespace {

struct RandomSequence {
  SequenceCycle cycle;
  std::vector<double> targets;  // ascending
  double overrun;
};

RandomSequence random_sequence(std::mt19937_64& draws) {
  const auto whole = [&](std::int64_t low, std::int64_t high) {
    return std::uniform_int_distribution<std::int64_t>(low, high)(draws);
  };
  RandomSequence sequence;
  sequence.cycle.cycles = whole(1, 7);
  sequence.cycle.approach = static_cast<SequenceApproach>(whole(0, 2));
  double last = static_cast<double>(whole(-5000, 5000));
  for (std::int64_t i = whole(1, 12); i > 0; --i) {
    sequence.targets.push_back(last);
    last += static_cast<double>(whole(1, 2000));
  }
  sequence.overrun = static_cast<double>(whole(1, 500));
  return sequence;
}

class SequenceProperties : public ::testing::Test {
 protected:
  template <class Check>
  void for_random_sequences(Check check) {
    std::mt19937_64 draws(20020721);
    for (int i = 0; i < 2000; ++i) {
      const RandomSequence s = random_sequence(draws);
      check(s, sequence_moves(s.cycle, std::ssize(s.targets)));
      if (HasFatalFailure()) return;
    }
  }

  static double position(const RandomSequence& s, const SequenceMove& move) {
    return sequence_position(move, s.targets, s.overrun);
  }
};

TEST_F(SequenceProperties, EachTargetIsReachedOnceInEachCycleFromEachSide) {
  for_random_sequences([](const RandomSequence& s, const std::vector<SequenceMove>& moves) {
    std::map<std::tuple<std::int64_t, int, std::int64_t>, int> times;  // target, direction, cycle
    for (const SequenceMove& move : moves) {
      if (move.target >= 0) ++times[{move.target, move.direction, move.cycle}];
    }
    const std::size_t sides = s.cycle.approach == SequenceApproach::bidirectional ? 2 : 1;
    ASSERT_EQ(times.size(), s.targets.size() * sides * static_cast<std::size_t>(s.cycle.cycles));
    for (const auto& [what, count] : times) {
      ASSERT_EQ(count, 1);
      ASSERT_NE(std::get<1>(what), s.cycle.approach == SequenceApproach::negative   ? 1
                                   : s.cycle.approach == SequenceApproach::positive ? -1
                                                                                    : 0);
    }
  });
}

TEST_F(SequenceProperties, ATargetIsApproachedFromTheSideThatItsMoveSays) {
  for_random_sequences([](const RandomSequence& s, const std::vector<SequenceMove>& moves) {
    ASSERT_LT(moves.front().target, 0) << "the first target is approached from somewhere, too";
    for (std::size_t i = 1; i < moves.size(); ++i) {
      if (moves[i].target < 0) continue;
      const double travel = position(s, moves[i]) - position(s, moves[i - 1]);
      ASSERT_GT(travel * moves[i].direction, 0);
    }
  });
}

TEST_F(SequenceProperties, TheOverrunIsBeyondAllTargets) {
  for_random_sequences([](const RandomSequence& s, const std::vector<SequenceMove>& moves) {
    for (const SequenceMove& move : moves) {
      if (move.target >= 0) continue;
      ASSERT_EQ(position(s, move),
                move.direction < 0 ? s.targets.front() - s.overrun : s.targets.back() + s.overrun);
    }
  });
}

TEST_F(SequenceProperties, CyclesFollowOnEachOtherAndAreAlike) {
  for_random_sequences([](const RandomSequence& s, const std::vector<SequenceMove>& moves) {
    ASSERT_EQ(std::ssize(moves), sequence_move_count(s.cycle, std::ssize(s.targets)));
    const std::size_t length = moves.size() / static_cast<std::size_t>(s.cycle.cycles);
    for (std::size_t i = 0; i < moves.size(); ++i) {
      ASSERT_EQ(moves[i].cycle, static_cast<std::int64_t>(i / length));
      ASSERT_EQ(moves[i].target, moves[i % length].target);
      ASSERT_EQ(moves[i].direction, moves[i % length].direction);
    }
  });
}

}  // namespace
}  // namespace zerocount::study
