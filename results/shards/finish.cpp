#include "results/shards/finish.hpp"

#include "results/hdf5/hdf5.hpp"
#include "results/storage/checksum_trailer.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount {

void finish_results(const std::filesystem::path& path, const hdf5::WrittenValues& written) {
  const std::filesystem::path part = part_of(path);
  append_checksum(part);
  if (check_checksum(part) != ChecksumState::valid) fail_read_back(part, "the checksum at its end differs");
  hdf5::require_written(part, written);
  publish(path);
}

}  // namespace zerocount
