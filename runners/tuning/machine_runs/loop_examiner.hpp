#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/trial/parameters.hpp"
#include "experiments/study/goal.hpp"
#include "experiments/study/study.hpp"

/// Stability margins of the linear control loops of many machines. Besides the random draws of the study,
/// machines differ by a spread of inertia, damping and torque constant (study::LoopSpread).
namespace zerocount::tuning {

/// The linear loop that has the smallest value of a stability margin among all examined loops.
struct CriticalLoop {
  /// Kind of the loop, by TrialLoop::name: "before sliding", "while sliding, the load stands", ….
  std::string name;
  /// Stiffness of the friction contact before it slides, N m/rad; nothing if the loop's contact has no
  /// spring.
  std::optional<double> stiffness{};
  /// Index of the random draw that made the machine; nothing if the stiffness describes the machine
  /// completely.
  std::optional<std::int64_t> machine{};
  std::int64_t setting{0};
};

/// Worst value of a stability margin over all examined loops, and the loop that has it. No loop if none
/// limits the margin.
struct Smallest {
  double value{std::numeric_limits<double>::infinity()};
  std::optional<CriticalLoop> loop{};
};

/// Smallest stability margins over the control loops of all examined machines. A margin that no loop limits
/// is infinite.
struct SmallestMargins {
  /// Whether no loop grows (is unstable) over the time for which a move holds its target.
  bool stable{true};
  Smallest gain{};   ///< Smallest gain margin, dB.
  Smallest phase{};  ///< Smallest phase margin, degrees.
  /// Delay margin, samples: additional delay of the controller until a loop is unstable, at most max_delay.
  Smallest delay{max_delay};
  /// Largest peak |S| of the sensitivity function S = 1/(1 + L), L being the open loop; smaller is better.
  Smallest sensitivity{0.0};
  /// Highest crossover frequency, at which |L| = 1 for the open loop L, Hz; 0 if no loop has one.
  double crossover{0.0};
  std::int64_t machines{0};    ///< Number of examined machines in each setting (condition at an age).
  bool before_sliding{false};  ///< Whether loops before sliding (friction as a spring) were examined.
  bool sliding{false};         ///< Whether loops of sliding machines were examined.
  /// Spread of inertia, damping and torque constant by which machines differ in addition to the study's
  /// draws.
  study::LoopSpread spread{};
  /// [setting] Smallest margins in each setting (condition at an age); empty without settings.
  std::vector<SmallestMargins> settings{};

  static constexpr double max_delay = 10.0;
};

/// Whether all loops are stable and all wanted stability margins are kept.
bool keeps(const SmallestMargins& margins, const study::LoopMargins& wanted);

/// A machine in a setting (condition at an age), and the range of its contact stiffness. It may represent all
/// machines that differ only in stiffness.
struct ExaminedMachine {
  std::int64_t trial;
  std::int64_t setting;
  /// Index of the random draw that gives the machine's trial; nothing if the machine represents all that
  /// differ only in stiffness.
  std::optional<std::int64_t> draw;
  study::LoopSpread spread;
  /// Smallest stiffness of the friction contact before it slides, N m/rad. Only for friction with a spring of
  /// k1 and k2.
  double softest;
  double stiffest;  ///< Largest stiffness of the friction contact before it slides, N m/rad.
};

/// Subject of an examination of stability margins: parameters of a machine's trial, with the gains of a
/// candidate.
struct Examination {
  trial::TrialParameters p;
  const ExaminedMachine& machine;
  bool slides;
};

/// Examines whether the linear control loops of the machines keep stability margins in every setting
/// (condition at an age).
///
/// The contact before sliding is examined over its range of stiffness: from k1 to k1 + k2 over the friction
/// profile of the machine, or at the stiffness of its bristles. The sliding contact is examined if machines
/// slide or if friction has no stiffness. Each contact is examined in every state of a load
/// (theory::load_states). Each machine also represents the machines that differ from it by the spread of the
/// margins.
class LoopExaminer {
 public:
  /// Draws the machines. Machines that differ only in the stiffness of their spring are examined as one
  /// machine with the range of all. Of machines that differ otherwise, the first 100 are examined.
  /// @param study its first draws are the machines; its friction must not depend on free parameters
  /// @param machines number of these draws
  LoopExaminer(const study::Study& study, std::int64_t machines);

  /// Whether nothing can be examined, because the controller is a plugin, whose loops have no transfer
  /// function. All margins then count as kept.
  bool is_blind() const { return machines_.empty(); }

  /// Whether the machines that violated margins of an earlier candidate (critical machines) keep the margins
  /// with this candidate. A quick test before keeps().
  /// @param slides whether machines of the candidate slide
  bool may_keep(const study::Study& candidate, const study::LoopMargins& margins, bool slides) const;
  /// How far the critical machines, which violated margins of an earlier candidate, are from keeping the
  /// margins. 0: they keep the margins. Below 1: largest missing fraction of a margin. From 1 on: a loop is
  /// unstable, and the value rises with its growth rate.
  /// @param slides whether machines of the candidate slide
  double shortfall(const study::Study& candidate, const study::LoopMargins& margins, bool slides) const;
  /// Whether all machines keep the margins with this candidate. A machine that does not counts as critical
  /// from then on.
  /// @param slides whether machines of the candidate slide
  /// @throws trial::Interrupted if `stop` is requested
  bool keeps(const study::Study& candidate, const study::LoopMargins& margins, bool slides,
             const std::stop_token& stop = {});

  /// Smallest margins of all examined machines with this candidate.
  /// @param slides whether machines of the candidate slide
  /// @throws trial::Interrupted if `stop` is requested
  SmallestMargins margins_of(const study::Study& candidate, bool slides,
                             const std::stop_token& stop = {}) const;

  /// Lowest natural frequency of a load mode (a second mass behind a spring, theory::with_load_mode) that the
  /// critical machines bear, Hz. It is found in steps of 5 % from half the sample rate downwards: a mode at
  /// this frequency, or at any step above it, makes no loop unstable. The search ends at the first step below
  /// 1 Hz. Nothing if the study has a load behind a coupling, if the loops are not examined (is_blind()), or
  /// if a mode at half the sample rate makes a loop unstable.
  /// @param slides whether machines of the candidate slide
  /// @throws trial::Interrupted if `stop` is requested
  std::optional<double> lowest_mode(const study::Study& candidate, bool slides,
                                    const std::stop_token& stop = {}) const;

 private:
  /// A machine at one of the extreme combinations of its spread in inertia, damping and torque constant.
  /// `corner` is an index in corners_of().
  struct Corner {
    std::size_t machine;
    std::size_t corner;
    bool operator==(const Corner&) const = default;
  };

  /// Corners (extreme combinations of inertia, damping and torque constant) to examine: all corners of a
  /// machine that represents many, but only the likely worst corners of machines that differ in more than
  /// stiffness.
  std::vector<Corner> examined_corners() const;
  Examination at(const Corner& corner, const study::Study& candidate, bool slides) const;

  /// Adds the likely worst corners of the machine to the critical corners, which are examined first, unless
  /// they are there already.
  /// @param machine index in machines_
  void add_critical(std::size_t machine);

  std::vector<ExaminedMachine> machines_;
  /// Number of machines that the entries of machines_ represent together, in each setting.
  std::int64_t examined_{0};
  std::int64_t settings_{0};  ///< Number of settings (conditions at ages); 0: the study has none.
  std::vector<Corner> critical_;
};

}  // namespace zerocount::tuning
