#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace zerocount::testing {

/// Stored contents of every dataset of a file, by path: extent, type, filters, and the raw bytes of every
/// chunk. For texts, which the HDF5 library stores elsewhere, the texts themselves. Reads with the HDF5
/// library alone.
std::map<std::string, std::string> stored_datasets(const std::filesystem::path& path);

/// Expects the same stored datasets in both files.
void expect_same_datasets(const std::filesystem::path& one, const std::filesystem::path& other);

/// The elements of a dataset of numbers, read with the HDF5 library alone; empty if the library refuses.
std::optional<std::string> elements_of(const std::filesystem::path& path, const std::string& dataset);

/// The number of elements of every dataset of numbers, by path.
std::map<std::string, std::size_t> sizes_of_numbers(const std::filesystem::path& path);

/// Changes one element of a dataset of numbers in its last bit (a NaN to 0.5), and writes the checksum
/// trailer anew.
void change_element(const std::filesystem::path& path, const std::string& dataset, std::size_t index);

/// Sets one element of a dataset of doubles, and writes the checksum trailer anew.
void set_element(const std::filesystem::path& path, const std::string& dataset, std::size_t index,
                 double value);

/// Names of the attributes of the root group.
std::set<std::string> attribute_names(const std::filesystem::path& path);

/// Changes an attribute of the root group, and writes its checksum trailer anew.
void replace_attribute(const std::filesystem::path& path, const std::string& name, std::int64_t value);
void replace_attribute(const std::filesystem::path& path, const std::string& name, const std::string& value);
void remove_attribute(const std::filesystem::path& path, const std::string& name);

/// Replaces a dataset by one of `rows` texts, without writing any text, and writes the checksum trailer anew.
void replace_by_texts(const std::filesystem::path& path, const std::string& dataset, std::uint64_t rows);

/// Writes an empty HDF5 file.
void write_empty_hdf5(const std::filesystem::path& path);

/// Removes the checksum trailer from the end of a file, so that the file can be changed.
void remove_checksum(const std::filesystem::path& path);

/// Offset in the file of the first chunk of a dataset.
std::uint64_t chunk_address(const std::filesystem::path& path, const std::string& dataset);

}  // namespace zerocount::testing
