#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "canyon/core/output/staged.h"
#include "canyon/core/result.h"

namespace canyon::lidar::velodyne {

/// One UDP datagram of a capture.
struct Datagram {
  std::int64_t unix_us = 0;  ///< capture time, microseconds since 1970 (UTC)
  std::uint16_t port = 0;    ///< it was sent to
  std::string payload;
};

/// UDP datagrams over IPv4 and Ethernet of a capture file in the classic pcap format, either byte order, microseconds
/// or nanoseconds. Other packets are skipped; fragments too. A file that ends inside a packet gives what came before,
/// and says so in `warning`, without its name.
struct Capture {
  std::vector<Datagram> datagrams;
  std::size_t skipped = 0;
  std::string warning;  ///< empty: none
};
Result<Capture> read_pcap(const std::string& path);

/// Writes a capture datagram by datagram into a file that the caller commits when it is complete.
class PcapWriter {
 public:
  /// Writes the file's header. `file` must outlive the writer. Fails (exit 1) on a full disk.
  static Result<PcapWriter> begin(StagedFile& file);
  /// Fails (exit 1) on a full disk.
  Status add(const Datagram& datagram);

 private:
  explicit PcapWriter(StagedFile& file) : file_(&file) {}
  StagedFile* file_;
};

/// The datagrams as a capture file: microseconds, little-endian, from 192.168.1.201 to 255.255.255.255, as the sensors
/// send them when they leave the factory.
std::string pcap_text(const std::vector<Datagram>& datagrams);

}  // namespace canyon::lidar::velodyne
