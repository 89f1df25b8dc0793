#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "core/result.h"

namespace canyon::lidar::velodyne {

/// One UDP datagram of a capture.
struct Datagram {
  std::int64_t unix_us = 0;  ///< capture time, microseconds since 1970 (UTC)
  std::uint16_t port = 0;    ///< it was sent to
  std::string payload;
};

/// UDP datagrams over IPv4 and Ethernet of a capture file in the classic pcap format, either byte order, microseconds
/// or nanoseconds. Other packets are skipped; fragments too. A file that ends inside a packet gives what came before,
/// and says so in `warning`.
struct Capture {
  std::vector<Datagram> datagrams;
  std::size_t skipped = 0;
  std::string warning;  ///< empty: none
};
Result<Capture> read_pcap(const std::string& path);

/// Writes a capture datagram by datagram. It becomes visible under its name when it is complete; until then it is
/// beside it, with ".part" at the end, and goes away if it is not committed.
class PcapWriter {
 public:
  /// Fails (exit 2) if the file exists and `force` is false, or if it cannot be written.
  static Result<PcapWriter> create(const std::string& path, bool force);
  PcapWriter(PcapWriter&& other) noexcept = default;
  PcapWriter& operator=(PcapWriter&&) = delete;
  ~PcapWriter();

  Status add(const Datagram& datagram);
  Status commit();

 private:
  PcapWriter(std::string path, std::ofstream file) : path_(std::move(path)), file_(std::move(file)) {}
  std::string path_;
  std::ofstream file_;
};

/// The datagrams as a capture file: microseconds, little-endian, from 192.168.1.201 to 255.255.255.255, as the sensors
/// send them when they leave the factory.
std::string pcap_text(const std::vector<Datagram>& datagrams);

}  // namespace canyon::lidar::velodyne
