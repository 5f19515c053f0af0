#include "runners/tuning/race/search.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "analysis/basis/parallel/parallel.hpp"
#include "core/random/random_numbers.hpp"
#include "experiments/designs/designs.hpp"

namespace zerocount::tuning {
namespace {

constexpr int smallest = 10;  // number of the last size
constexpr std::int64_t candidates_each = 48;
constexpr std::int64_t machines_of_world = 4;
constexpr std::int64_t climbing_part = 8;  // max_machines over the machines of a climb

/// Size of a search, `step` sizes below the largest (0: the largest). Each step has 0.75 times the candidates
/// of the step before, and every second step half the machines.
SearchSize size_at(const SearchScope& scope, int step) {
  const SearchSize largest;
  const double fewer = std::pow(0.75, step);
  const auto part = [fewer](std::int64_t of, std::int64_t least) {
    return std::max(std::llround(fewer * static_cast<double>(of)), static_cast<long long>(least));
  };
  SearchSize size;
  size.first_candidates = part(candidates_each * (1 + static_cast<std::int64_t>(scope.free)), 8);
  size.face_candidates =
      scope.faces == 0 ? 0 : part(candidates_each / 6 * (1 + static_cast<std::int64_t>(scope.free)), 2);
  size.candidates = part(largest.candidates, 6);
  size.elites = part(largest.elites, 3);
  const int halvings = step / 2;
  const std::int64_t worlds = std::max<std::int64_t>(scope.worlds, 1);
  const std::int64_t least = machines_of_world * scope.worlds;
  const std::int64_t machines = std::max(scope.max_machines >> halvings, least);
  size.max_machines = (machines + worlds - 1) / worlds * worlds;
  size.first_machines =
      std::min(std::max<std::int64_t>(largest.first_machines >> halvings, 8), size.max_machines);
  size.climbing_machines = std::max({size.max_machines / climbing_part, size.first_machines, least});
  return size;
}

constexpr double error_of_dropping = 0.01;

/// Indices of the candidates, sorted by decreasing RateEstimate::margin over the first `machines` machines of
/// each.
std::vector<std::size_t> by_margin(const Aim& aim, const std::vector<Candidate>& candidates,
                                   std::int64_t machines) {
  std::vector<std::size_t> order(candidates.size());
  std::vector<double> margins;
  for (const RateEstimate& one : estimates_of(aim, candidates, machines)) {
    order[margins.size()] = margins.size();
    margins.push_back(one.margin);
  }
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return margins[a] > margins[b]; });
  return order;
}

constexpr int tries_of_candidate = 60;      // draws for one admissible candidate
constexpr std::size_t places_at_once = 32;  // to be examined
constexpr double first_step = 0.15;         // in the unit cube
constexpr double step_ratio = 0.8;          // from generation to generation
constexpr int patience = 4;                 // generations without improvement
constexpr double part_on_faces = 0.2;       // of later generations
constexpr double min_improvement = 0.005;   // of the criterion
constexpr double min_approach = 0.2;        // of the distance left to the goal, in a third of the candidates
constexpr double final_part = 0.1;          // of the time, for the race of the finalists
constexpr double examining = 0.3;           // of the time left, at most, to find candidates of a generation

constexpr int tries_before_walking = 8;  // of a later generation, if they find less than half of it

/// Effort without the part that is kept for the last race, in which the finalists, the best start and an
/// earlier leader run all machines.
trials::Effort before_final_race(const SearchProblem& problem, const trials::Effort& whole) {
  const SearchSize& size = problem.size;
  const std::int64_t final_trials =
      (size.max_machines - size.climbing_machines) * (size.elites + 2) * problem.trials_of_replicate;
  const std::int64_t least = std::min(size.max_machines * problem.trials_of_replicate, whole.trials_left());
  const double seconds = whole.seconds_left();
  return whole.limited_to(std::max(whole.trials_left() - final_trials, least),
                          std::isinf(seconds) ? std::nullopt : std::optional((1.0 - final_part) * seconds));
}

class Search {
 public:
  Search(const SearchProblem& problem, const SearchSettings& settings)
      : problem_(problem),
        settings_(settings),
        numbers_{designs::random_key(settings.seed, "tuning"), 0},
        step_(first_step),
        effort_(before_final_race(problem, settings.effort)),
        most_machines_(problem.size.climbing_machines) {}

  SearchResult run() {
    race_starts();
    if (!population_.empty()) best_start_ = population_.front();
    fill_ranges();
    int without = 0;
    while (!population_.empty()) {
      ++result_.generations;
      remember_leader();
      tell();
      result_.converged = without >= patience;
      if (!goes_on() || (result_.converged && !settings_.begins_anew)) break;
      const RateEstimate before = best_estimate();
      const std::int64_t spent = result_.trials;
      const bool has_direction = before.rate > 0.0;
      const bool fills = !has_direction || without % (patience + 1) == patience;
      if (fills) {
        step_ = first_step;
        fill_ranges();
      } else {
        next_generation();
      }
      const bool all_is_tried = fills && result_.trials == spent;
      if (population_.empty() || all_is_tried) break;
      without = improves(before, best_estimate()) ? 0 : without + 1;
    }
    return finish();
  }

 private:
  /// The best candidate after a generation, remembered to see whether the search still makes progress.
  struct Leader {
    std::int64_t points;  ///< Number of points (sets of values) tried up to this generation.
    Candidate candidate;
  };

  std::size_t index_below(std::size_t size) { return tuning::index_below(size, numbers_); }

  /// Appends to `to` the places that have admissible values and were not tried before, until it has `wanted`
  /// entries.
  void add_admissible(const std::vector<UnitCubePoint>& places, std::size_t wanted,
                      std::vector<Candidate>& to) {
    std::vector<Candidate> drawn;
    for (const UnitCubePoint& place : places) {
      Values at = values_at(problem_.free, place);
      if (!tried_.insert(at).second) continue;
      drawn.push_back({place_of(problem_.free, at), at, {}});
    }
    keep_admissible(drawn);
    for (Candidate& one : drawn) {
      if (to.size() == wanted) return;
      to.push_back(std::move(one));
    }
  }

  void keep_admissible(std::vector<Candidate>& candidates) const {
    const std::vector<bool> admissible = problem_.admissible(candidates);
    std::vector<Candidate> kept;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (admissible[i]) kept.push_back(std::move(candidates[i]));
    }
    candidates = std::move(kept);
  }

  /// Calls `add`, which appends to `candidates`, until it returns false. Stops earlier if there is a
  /// candidate and a fraction `examining` of the remaining time has passed.
  void find(std::vector<Candidate>& candidates, const std::function<bool()>& add) {
    const double end = (1.0 - examining) * effort_.seconds_left();
    const bool ended = trials::within(effort_, [&] {
      while (add() && (candidates.empty() || !(effort_.seconds_left() < end))) {
      }
    });
    result_.cut = result_.cut || !ended;
  }

  /// Draws a generation that is evenly spread over the ranges of the free parameters and over their faces
  /// (SearchProblem::faces), and races it.
  void fill_ranges() {
    const auto wanted = static_cast<std::size_t>(problem_.size.first_candidates);
    std::vector<double> start;
    for (std::size_t i = 0; i < problem_.free.size(); ++i) start.push_back(numbers_.uniform());
    const SpreadPlaces places(std::move(start));
    std::vector<Candidate> candidates;
    for (const std::vector<std::size_t>& face : problem_.faces)
      spread(candidates, places, face,
             candidates.size() + static_cast<std::size_t>(problem_.size.face_candidates));
    const std::size_t on_faces =
        problem_.faces.size() * static_cast<std::size_t>(problem_.size.face_candidates);
    spread(candidates, places, {}, wanted + std::min(candidates.size(), on_faces));
    race(std::move(candidates));
  }

  /// Races the given starting values (SearchProblem::starts) before any other candidate, so that chance does
  /// not drop them.
  void race_starts() {
    std::vector<Candidate> candidates;
    std::vector<UnitCubePoint> places;
    for (const Values& values : problem_.starts) places.push_back(place_of(problem_.free, values));
    find(candidates, [&] {
      add_admissible(places, places.size(), candidates);
      return false;
    });
    race(std::move(candidates));
  }

  /// Appends admissible candidates that are evenly spread over a face, until there are `wanted`.
  /// @param face free parameters that stay at their low ends; empty: the whole ranges
  void spread(std::vector<Candidate>& candidates, const SpreadPlaces& sequence,
              const std::vector<std::size_t>& face, std::size_t wanted) {
    if (wanted <= candidates.size()) return;
    std::int64_t drawn = 0;
    const auto most = static_cast<std::int64_t>(wanted - candidates.size()) * tries_of_candidate;
    find(candidates, [&] {
      std::vector<UnitCubePoint> places;
      for (std::size_t i = 0; i < places_at_once; ++i) {
        places.push_back(sequence.at(drawn++));
        for (const std::size_t parameter : face) places.back()[parameter] = 0.0;
      }
      add_admissible(places, wanted, candidates);
      return candidates.size() < wanted && drawn < most;
    });
    if (!problem_.shortfall) return;
    approach(candidates, wanted, face, [&](std::int64_t i) { return sequence.at(i); });
  }

  std::vector<double> shortfalls_at(const std::vector<UnitCubePoint>& places) const {
    std::vector<Values> values;
    values.reserve(places.size());
    for (const UnitCubePoint& place : places) values.push_back(values_at(problem_.free, place));
    return problem_.shortfall(values);
  }

  /// Appends candidates that differential evolution finds where the shortfall from the margins is 0, until
  /// there are `wanted`.
  /// @param face parameters that stay at their low ends
  /// @param first returns the places 0, 1, … at which the evolution may begin
  void approach(std::vector<Candidate>& candidates, std::size_t wanted, const std::vector<std::size_t>& face,
                const std::function<UnitCubePoint(std::int64_t)>& first) {
    if (candidates.size() >= wanted) return;
    Walk walk([this](const std::vector<UnitCubePoint>& places) { return shortfalls_at(places); }, face,
              numbers_);
    find(candidates, [&] {
      add_admissible(walk.next(first), wanted, candidates);
      return candidates.size() < wanted && walk.goes_on();
    });
  }

  /// Random place near one of the best candidates (elites), sometimes moved along the difference of two other
  /// elites. The spread of the elites follows the direction of a narrow valley.
  /// @param step standard deviation of the random step, as a fraction of each range
  UnitCubePoint place_near_elites(double step) {
    const std::size_t elites = population_.size();
    const double u = numbers_.uniform();
    const UnitCubePoint& centre =
        population_[static_cast<std::size_t>(u * u * static_cast<double>(elites))].place;
    const UnitCubePoint& from = population_[index_below(elites)].place;
    const UnitCubePoint& to = population_[index_below(elites)].place;
    const double along = numbers_.uniform() < 0.7 ? 0.8 * numbers_.uniform() : 0.0;
    UnitCubePoint place;
    for (std::size_t i = 0; i < centre.size(); ++i) {
      const double moved = centre[i] + along * (to[i] - from[i]) + step * numbers_.normal();
      place.push_back(std::clamp(moved, 0.0, 1.0));
    }
    if (!problem_.faces.empty() && numbers_.uniform() < part_on_faces) {
      for (const std::size_t parameter : problem_.faces[index_below(problem_.faces.size())])
        place[parameter] = 0.0;
    }
    return place;
  }

  /// Draws a generation near the best candidates (elites) and races it. Each further try takes shorter steps,
  /// because few places are admissible then, and these lie close to the elites. If still too few are found,
  /// differential evolution that starts around the elites goes farther along a thin admissible region.
  void next_generation() {
    std::vector<Candidate> candidates;
    const auto wanted =
        static_cast<std::size_t>(problem_.size.candidates * problem_.size.max_machines / most_machines_);
    int tries = 0;
    find(candidates, [&] {
      std::vector<UnitCubePoint> places;
      for (std::size_t i = candidates.size(); i < wanted; ++i)
        places.push_back(place_near_elites(step_ / (1.0 + 0.2 * tries)));
      add_admissible(places, wanted, candidates);
      const bool is_thin = 2 * candidates.size() < wanted && problem_.shortfall;
      return ++tries < (is_thin ? tries_before_walking : tries_of_candidate) && candidates.size() < wanted;
    });
    if (problem_.shortfall)
      approach(candidates, wanted, {}, [&](std::int64_t) { return place_near_elites(step_); });
    race(std::move(candidates));
    step_ *= step_ratio;
  }

  /// Runs the candidates together with the population on more and more machines, and drops the worse ones.
  /// The best of both become the new population.
  void race(std::vector<Candidate> candidates) {
    result_.points += std::ssize(candidates);
    for (Candidate& one : population_) candidates.push_back(std::move(one));
    population_.clear();
    std::int64_t machines = std::min(problem_.size.first_machines, most_machines_);
    const bool ended = trials::within(effort_, [&] {
      while (!candidates.empty()) {
        run_machines(candidates, machines);
        keep_admissible(candidates);
        sort_by_merit(candidates, machines);
        verify_leaders(candidates);
        if (candidates.empty()) return;
        candidates = dropped(problem_.aim, problem_.size, std::move(candidates), machines);
        const bool tells_them_apart =
            estimate_of(problem_.aim, candidates.front().machines, machines).rate > 0.0;
        if (!tells_them_apart || (machines == most_machines_ && !takes_more_machines(candidates.front())))
          return;
        machines = std::min(2 * machines, most_machines_);
      }
    });
    if (!ended) {
      result_.cut = true;
      keep_those_with_most_machines(candidates);
    }
    keep_elites(candidates);
    population_ = std::move(candidates);
  }

  /// Keeps the best candidates (elites) and, in the last place, the most reliable one. If a goal is hard to
  /// reach, the best by the criterion meet it by luck, and all of them may miss it.
  void keep_elites(std::vector<Candidate>& candidates) const {
    const auto elites = static_cast<std::size_t>(problem_.size.elites);
    if (candidates.size() <= elites) return;
    std::vector<double> margins;
    margins.reserve(candidates.size());
    for (const RateEstimate& one : estimates_of(problem_.aim, candidates, most_machines_))
      margins.push_back(one.margin);
    const std::ptrdiff_t reliable = std::ranges::max_element(margins) - margins.begin();
    if (reliable >= problem_.size.elites)
      std::swap(candidates[elites - 1], candidates[static_cast<std::size_t>(reliable)]);
    candidates.resize(elites);
  }

  /// Doubles most_machines_ if the best candidate seems to meet the goal; returns false if it does not. While
  /// it seems to miss, many candidates on few machines find the way sooner than few candidates on many.
  /// Telling apart candidates that meet the goal needs more machines.
  bool takes_more_machines(const Candidate& best) {
    const std::int64_t max_machines = problem_.size.max_machines;
    if (most_machines_ == max_machines ||
        !seems_to_meet(estimate_of(problem_.aim, best.machines, most_machines_)))
      return false;
    most_machines_ = std::min(2 * most_machines_, max_machines);
    if (most_machines_ == max_machines) effort_ = settings_.effort;
    return true;
  }

  /// Simulates the candidates that have fewer than `machines` machines, in order, until each has as many.
  /// Drops those for which no trials are left.
  /// @throws trials::Spent if no trials are left for the first of them
  void run_machines(std::vector<Candidate>& candidates, std::int64_t machines) {
    std::vector<Candidate*> behind;
    std::int64_t trials = 0;
    for (Candidate& one : candidates) {
      const std::int64_t missing = (machines - std::ssize(one.machines)) * problem_.trials_of_replicate;
      if (missing <= 0) continue;
      if (trials + missing > effort_.trials_left()) {
        if (behind.empty()) throw trials::Spent{};
        break;
      }
      behind.push_back(&one);
      trials += missing;
    }
    effort_.spend(trials);
    result_.trials += trials;
    problem_.evaluate(behind, machines);
    std::erase_if(candidates,
                  [machines](const Candidate& one) { return std::ssize(one.machines) < machines; });
  }

  /// Drops candidates that ran fewer machines than others, after the effort ended within a race. Few machines
  /// make candidates look better than they are.
  void keep_those_with_most_machines(std::vector<Candidate>& candidates) {
    std::int64_t most = 1;
    for (const Candidate& one : candidates) most = std::max(most, std::ssize(one.machines));
    std::erase_if(candidates, [most](const Candidate& one) { return std::ssize(one.machines) < most; });
    sort_by_merit(candidates, most);
  }

  void sort_by_merit(std::vector<Candidate>& candidates, std::int64_t machines) {
    std::vector<std::pair<RateEstimate, std::size_t>> order;
    order.reserve(candidates.size());
    std::vector<RateEstimate> estimates = estimates_of(problem_.aim, candidates, machines);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      order.emplace_back(std::move(estimates[i]), i);
      RateEstimate& latest = estimates_[candidates[i].values];
      if (order.back().first.machines >= latest.machines) latest = order.back().first;
    }
    std::ranges::stable_sort(
        order, [this](const auto& a, const auto& b) { return is_better(problem_.aim, a.first, b.first); });
    std::vector<Candidate> sorted;
    sorted.reserve(candidates.size());
    for (const auto& [estimate, i] : order) sorted.push_back(std::move(candidates[i]));
    candidates = std::move(sorted);
  }

  /// Removes leading candidates that fail SearchProblem::verified, until all leaders that may become the
  /// population pass. The leaders must be verified because other candidates are dropped in their favour.
  void verify_leaders(std::vector<Candidate>& candidates) {
    const auto wanted = static_cast<std::size_t>(problem_.size.elites);
    for (std::size_t i = 0; i < std::min(wanted, candidates.size());) {
      if (problem_.verified(candidates[i])) {
        ++i;
        continue;
      }
      candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(i));
      keep_admissible(candidates);
    }
  }

  RateEstimate best_estimate() const {
    return estimate_of(problem_.aim, population_.front().machines, most_machines_);
  }

  bool improves(const RateEstimate& before, const RateEstimate& now) const {
    if (before.missing != now.missing) return now.missing < before.missing;
    if (seems_to_meet(before)) return now.criterion < before.criterion * (1.0 - min_improvement);
    if (before.worst != now.worst) return now.margin > before.margin;
    return now.rate > before.rate + 0.001;
  }

  void remember_leader() {
    leaders_.push_back({result_.points, population_.front()});
    while (leaders_.size() > 1 && 3 * leaders_[1].points <= 2 * result_.points) leaders_.pop_front();
  }

  /// Whether the goal is still missed, but the last third of the points reduced the distance to it (in
  /// logits) by more than min_approach times the remaining distance. At this pace, some times as many points
  /// would reach the goal. The earlier leader runs as many machines as the finalists, because it may have led
  /// by luck.
  bool approaches_goal() {
    if (population_.empty() || reaches(problem_.aim, best_estimate())) return false;
    std::vector<Candidate> before{leaders_.front().candidate};
    trials::within(effort_, [&] { run_machines(before, most_machines_); });
    if (before.empty()) return false;
    const std::int64_t machines =
        std::min(std::ssize(before.front().machines), std::ssize(population_.front().machines));
    const double now = estimate_of(problem_.aim, population_.front().machines, machines).margin;
    return now - estimate_of(problem_.aim, before.front().machines, machines).margin >
           min_approach * std::abs(now);
  }

  void tell() const {
    if (!settings_.tell) return;
    settings_.tell(
        {result_.generations, result_.points, result_.trials, &population_.front(), best_estimate()});
  }

  /// Whether another generation is allowed, and enough trials are left for at least one candidate to end its
  /// race.
  bool goes_on() const {
    return (result_.generations < settings_.generations || settings_.begins_anew) && !effort_.is_spent() &&
           effort_.trials_left() >= most_machines_ * problem_.trials_of_replicate;
  }

  void race_finalists() {
    if (most_machines_ == problem_.size.max_machines) return;
    effort_ = settings_.effort;
    most_machines_ = problem_.size.max_machines;
    std::vector<Candidate> left_behind;
    const auto is_best_start = [this](const Candidate& one) { return one.values == best_start_->values; };
    if (best_start_ && std::ranges::none_of(population_, is_best_start)) left_behind.push_back(*best_start_);
    race(std::move(left_behind));
  }

  SearchResult finish() {
    race_finalists();
    result_.approaching = approaches_goal();
    // Every finalist is to be fit for the proof.
    for (Candidate& one : population_) {
      if (problem_.verified(one)) result_.finalists.push_back(std::move(one));
    }
    for (const Candidate& one : result_.finalists)
      result_.estimates.push_back(estimate_of(problem_.aim, one.machines, most_machines_));
    result_.tried.reserve(estimates_.size());
    for (const auto& [values, estimate] : estimates_) result_.tried.push_back({values, estimate});
    return std::move(result_);
  }

  const SearchProblem& problem_;
  const SearchSettings& settings_;
  random::NumberSource numbers_;
  double step_;
  trials::Effort effort_;       ///< Effort that the current race may spend.
  std::int64_t most_machines_;  ///< Maximum number of machines per candidate in the current race.
  std::set<Values> tried_;
  std::map<Values, RateEstimate> estimates_;  ///< Latest estimate of each simulated set of values.
  std::vector<Candidate> population_;         ///< Candidates that survived the last race, the best first.
  /// Best of the given starting values, kept so that few machines do not drop it by chance.
  std::optional<Candidate> best_start_;
  /// Best candidates after each generation since two thirds of the points were tried, beginning with the one
  /// at that time.
  std::deque<Leader> leaders_;
  SearchResult result_;
};

}  // namespace

std::int64_t max_after(const SearchSize& size, std::int64_t machines) {
  return std::max(size.elites, 4 * size.candidates * size.first_machines / machines);
}

std::int64_t first_race_machines(const SearchSize& size, std::size_t faces) {
  std::int64_t candidates = size.first_candidates + static_cast<std::int64_t>(faces) * size.face_candidates;
  std::int64_t total = candidates * size.first_machines;
  for (std::int64_t machines = size.first_machines; machines < size.max_machines;) {
    candidates = std::min(candidates, max_after(size, machines));
    const std::int64_t next = std::min(2 * machines, size.max_machines);
    total += candidates * (next - machines);
    machines = next;
  }
  return total;
}

SearchSize search_size(const SearchScope& scope, std::int64_t machines) {
  for (int step = 0; step < smallest; ++step) {
    const SearchSize size = size_at(scope, step);
    if (first_race_machines(size, scope.faces) <= machines / 2) return size;
  }
  return size_at(scope, smallest);
}

SearchSize smallest_search(const SearchScope& scope) {
  return size_at(scope, smallest);
}

std::vector<Candidate> dropped(const Aim& aim, const SearchSize& size, std::vector<Candidate> candidates,
                               std::int64_t machines) {
  const std::vector<std::size_t> reliable = by_margin(aim, candidates, machines);
  const Candidate& most_reliable = candidates[reliable.front()];
  const auto sure = std::ranges::find_if(
      candidates, [&](const Candidate& one) { return surely_meets(aim, one, error_of_dropping); });
  std::vector<char> stays(candidates.size());
  parallel::for_each_index(
      candidates.size(),
      [&](std::size_t i) {
        const Candidate& one = candidates[i];
        const bool stays_in = !surely_misses(aim, one, most_reliable, error_of_dropping) &&
                              (sure == candidates.end() || &one == &*sure ||
                               !is_significantly_later(aim, one, *sure, error_of_dropping));
        stays[i] = stays_in ? 1 : 0;
      },
      "compare");
  const auto most = static_cast<std::size_t>(max_after(size, machines));
  std::vector<char> chosen;
  chosen.reserve(candidates.size());
  for (const Candidate& one : candidates) chosen.push_back(std::ssize(one.machines) > machines ? 1 : 0);
  std::size_t count = 0;
  const auto choose = [&](std::size_t i) {
    if (count == most || chosen[i] != 0 || stays[i] == 0) return;
    chosen[i] = 1;
    ++count;
  };
  for (std::size_t place = 0; place < candidates.size(); ++place) {
    choose(place);
    choose(reliable[place]);
  }
  std::vector<Candidate> left;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (chosen[i] != 0) left.push_back(std::move(candidates[i]));
  }
  return left;
}

SearchResult search(const SearchProblem& problem, const SearchSettings& settings) {
  return Search(problem, settings).run();
}

}  // namespace zerocount::tuning
