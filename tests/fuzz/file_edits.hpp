#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/fuzz/memory_file.hpp"

namespace zerocount::fuzz {

/// Place of an attribute in a results file: its group or dataset, and its name.
struct AttributePlace {
  std::string object;  ///< path of the group or dataset that has the attribute
  std::string name;
};

/// A valid results file without its checksum trailer, with lists of its parts that can be changed.
struct SampleFile {
  std::string bytes;
  std::vector<std::string> objects;  ///< paths of all groups and datasets in the file
  std::vector<AttributePlace> attributes;
  std::vector<std::size_t> used;  ///< offsets in the file of the bytes that are not 0
};

/// One change of a file. The fuzzer finds useful changes faster in this form than by changing bytes of a
/// file, because most bytes are padding or protected by checksums of HDF5.
struct Edit {
  std::uint8_t kind{0};     ///< kind of the edit, modulo edit_kinds; see file_edits.cpp
  std::uint8_t choice{0};   ///< choice of a value or type
  std::uint16_t object{0};  ///< index of an object or attribute, modulo their number
  std::uint32_t place{0};   ///< index of the element or byte to be changed, modulo their number
  std::uint64_t value{0};
};

/// The sample files of the fuzz target `target`, prepared for edits.
std::vector<SampleFile> editable_files(const std::string& target);

/// The edits that these bytes encode, 16 bytes each; at most 32.
std::vector<Edit> edits_of(std::span<const std::uint8_t> bytes);

/// Writes the sample with the edits, and a valid checksum trailer, to `file`. An edit that HDF5 refuses is
/// left out.
void write_edited(const SampleFile& sample, std::span<const Edit> edits, MemoryFile& file);

/// Chooses a sample by the first byte of a fuzzer input, and writes it with the edits that the other bytes
/// encode.
void write_input(const std::vector<SampleFile>& samples, std::span<const std::uint8_t> input,
                 MemoryFile& file);

}  // namespace zerocount::fuzz
