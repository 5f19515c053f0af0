#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <type_traits>
#include <vector>

/// The state of accumulators as numbers, for files. An accumulator lists its fields once, for both
/// directions:
///
///     template <class Self, class Archive>
///     static void transfer(Self& self, Archive& archive) { archive(self.trials, self.sums); }
///
/// A vector or map is preceded by the number of its elements.
namespace zerocount::statistics {

/// Whether all numbers are possible counts: none is negative or above `most`.
bool are_counts(std::span<const std::int64_t> counts, std::int64_t most);

struct State {
  std::vector<std::int64_t> whole;
  std::vector<double> real;
};

class StateWriter {
 public:
  explicit StateWriter(State& state) : state_(state) {}

  template <class... Fields>
  void operator()(const Fields&... fields) {
    (write(fields), ...);
  }

 private:
  void write(std::int64_t number) { state_.whole.push_back(number); }
  void write(double number) { state_.real.push_back(number); }
  void write(bool flag) { state_.whole.push_back(flag ? 1 : 0); }
  template <class Element>
  void write(const std::vector<Element>& elements) {
    write(std::ssize(elements));
    for (const Element& element : elements) write(element);
  }
  template <class Key, class Value>
  void write(const std::map<Key, Value>& elements) {
    write(std::ssize(elements));
    for (const auto& [key, value] : elements) (*this)(key, value);
  }
  template <class Part>
  void write(const Part& part) {
    Part::transfer(part, *this);
  }

  State& state_;
};

/// Reads the fields of an accumulator from numbers. It does not check the values of fields: the accumulator
/// calls require() with its own conditions.
/// @throws Failure (bad_data) if numbers are missing, a length exceeds the number of those left, or the keys
/// of a map do not rise; from require_end() if numbers are left
class StateReader {
 public:
  /// @param whole integer numbers and flags
  /// @param real floating-point numbers; both must outlive the reader
  StateReader(std::span<const std::int64_t> whole, std::span<const double> real)
      : whole_(whole), real_(real) {}

  template <class... Fields>
  void operator()(Fields&... fields) {
    (read(fields), ...);
  }

  static void require(bool possible) {
    if (!possible) fail();
  }
  void require_end() const;

  /// The integer numbers (and, in the next function, the floating-point numbers) that were not read yet.
  std::span<const std::int64_t> whole() const { return whole_; }
  std::span<const double> real() const { return real_; }

 private:
  [[noreturn]] static void fail();
  std::int64_t next_whole();
  double next_real();
  /// Reads the number of elements of the next vector. It is at most the number of remaining numbers.
  std::size_t next_size();

  void read(std::int64_t& number) { number = next_whole(); }
  void read(double& number) { number = next_real(); }
  void read(bool& flag) { flag = next_whole() != 0; }
  template <class Element>
  void read(std::vector<Element>& elements) {
    elements.resize(next_size());
    for (Element& element : elements) read(element);
  }
  template <class Key, class Value>
  void read(std::map<Key, Value>& elements) {
    elements.clear();
    for (std::size_t remaining = next_size(); remaining > 0; --remaining) {
      Key key{};
      read(key);
      require(key == key && (elements.empty() || elements.rbegin()->first < key));  // neither NaN nor twice
      read(elements[key]);
    }
  }
  template <class Part>
  void read(Part& part) {
    Part::transfer(part, *this);
  }

  std::span<const std::int64_t> whole_;
  std::span<const double> real_;
};

}  // namespace zerocount::statistics
