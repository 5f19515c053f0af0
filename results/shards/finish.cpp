#include "results/shards/finish.hpp"

#include "results/hdf5/hdf5.hpp"
#include "results/storage/checksum_trailer.hpp"
#include "results/storage/durable_file.hpp"

namespace zerocount::shards {

void finish_results(const std::filesystem::path& path, const hdf5::WrittenValues& written) {
  const std::filesystem::path part = storage::part_of(path);
  storage::append_checksum(part);
  if (storage::check_checksum(part) != storage::ChecksumState::valid)
    storage::fail_read_back(part, "the checksum at its end differs");
  hdf5::require_written(part, written);
  storage::publish(path);
}

}  // namespace zerocount::shards
