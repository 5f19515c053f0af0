#pragma once

#include <cstdint>
#include <string>

#include "tests/fuzz/file_edits.hpp"

namespace zerocount::fuzz {

/// An HDF5 file that is changed with the HDF5 library alone. Every function ignores changes that the library
/// refuses.
class EditedHdf5 {
 public:
  explicit EditedHdf5(const std::filesystem::path& path);
  EditedHdf5(const EditedHdf5&) = delete;
  EditedHdf5& operator=(const EditedHdf5&) = delete;
  ~EditedHdf5();

  void set_integer(const AttributePlace& attribute, std::int64_t value) const;
  void set_text(const AttributePlace& attribute, const std::string& value) const;
  void remove(const AttributePlace& attribute) const;

  /// Changes one element of a dataset of numbers or of texts: the element with the index `place` modulo the
  /// number of elements.
  void set_element(const std::string& dataset, std::uint64_t place, std::uint64_t bits) const;
  void set_element(const std::string& dataset, std::uint64_t place, const std::string& text) const;
  void resize(const std::string& dataset, std::uint64_t rows) const;

  void remove(const std::string& path) const;
  void rename(const std::string& path, const std::string& other) const;
  void replace_by_group(const std::string& path) const;
  /// Replaces a dataset by one of another type and rank. The attributes are kept.
  void replace_by_dataset(const std::string& path, std::uint8_t type, unsigned rank,
                          std::uint64_t size) const;

  /// Adds the paths of all objects of the file and of their attributes to `sample`.
  void list(SampleFile& sample) const;

 private:
  std::int64_t file_;
};

}  // namespace zerocount::fuzz
